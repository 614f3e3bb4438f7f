#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "core/error.hpp"
#include "model_vectors.hpp"
#include "supple/models.hpp"
#include "supple/trigonometry.hpp"

namespace supple {
namespace {

/// Vertex ids fit 32 bits, and so does three times the number of triangles.
constexpr std::uint64_t max_triangles = 1'000'000'000;

void check_count(const char* shape, const char* what, std::uint64_t value, std::uint64_t least) {
  if (value < least)
    fail(std::string(shape) + ": " + what + " is " + std::to_string(value) + "; give at least " +
         std::to_string(least));
}

void check_size(const char* shape, const char* what, double value) {
  if (!(value > 0) || !std::isfinite(value))
    fail(std::string(shape) + ": " + what + " is " + std::to_string(value) +
         "; give a finite number above 0");
}

/// `triangles` is a double because the number may exceed any integer type.
void check_triangles(const char* shape, double triangles) {
  if (triangles > static_cast<double>(max_triangles))
    fail(std::string(shape) + ": the mesh would have more than " + std::to_string(max_triangles) +
         " triangles; give smaller counts");
}

/// Ids of the vertices on one edge of a coarse triangle, both ends included, from the lower end to the
/// higher.
using EdgeVertices = std::vector<std::uint32_t>;

class Icosphere {
 public:
  explicit Icosphere(std::uint32_t frequency) : frequency_(frequency) {}

  TriangleMesh make() {
    add_corners();
    for (const Triangle& face : faces_) subdivide(face);
    for (Vec3d& p : mesh_.positions) p = models::unit(p);
    mesh_.name = "icosphere";
    return std::move(mesh_);
  }

 private:
  void add_corners() {
    const double golden = (1 + std::sqrt(5.0)) / 2;
    for (int axis = 0; axis < 3; ++axis) {
      for (const double a : {-1.0, 1.0}) {
        for (const double b : {-golden, golden}) {
          Vec3d p;
          p[axis] = a;
          p[(axis + 1) % 3] = b;
          mesh_.positions.push_back(p);
        }
      }
    }
    // Neighbouring corners have the distance 2; the next nearest have 2 · golden.
    const auto near = [&](std::uint32_t a, std::uint32_t b) {
      const Vec3d d = mesh_.positions[b] - mesh_.positions[a];
      return dot(d, d) < 5;
    };
    for (std::uint32_t a = 0; a < 12; ++a) {
      for (std::uint32_t b = a + 1; b < 12; ++b) {
        for (std::uint32_t c = b + 1; c < 12; ++c) {
          if (!near(a, b) || !near(b, c) || !near(a, c)) continue;
          const auto& p = mesh_.positions;
          const bool outward = dot(cross(p[b] - p[a], p[c] - p[a]), p[a]) > 0;
          faces_.push_back(outward ? Triangle{a, b, c} : Triangle{a, c, b});
        }
      }
    }
  }

  /// The vertices from corner a to corner b. The first of the two faces creates them.
  EdgeVertices edge(std::uint32_t a, std::uint32_t b) {
    EdgeVertices& ids = edges_[std::min(a, b)][std::max(a, b)];
    if (ids.empty()) {
      ids.push_back(std::min(a, b));
      for (std::uint32_t i = 1; i < frequency_; ++i)
        ids.push_back(
            add_vertex(models::lerp(mesh_.positions[std::min(a, b)], mesh_.positions[std::max(a, b)],
                                    static_cast<double>(i) / frequency_)));
      ids.push_back(std::max(a, b));
    }
    return a < b ? ids : EdgeVertices(ids.rbegin(), ids.rend());
  }

  std::uint32_t add_vertex(Vec3d position) {
    mesh_.positions.push_back(position);
    return static_cast<std::uint32_t>(mesh_.positions.size() - 1);
  }

  void subdivide(const Triangle& face) {
    const EdgeVertices left = edge(face[0], face[1]);
    const EdgeVertices right = edge(face[0], face[2]);
    const EdgeVertices bottom = edge(face[1], face[2]);
    std::vector<std::uint32_t> above{face[0]};
    for (std::uint32_t row = 1; row <= frequency_; ++row) {
      std::vector<std::uint32_t> below{left[row]};
      for (std::uint32_t i = 1; i < row; ++i)
        below.push_back(row == frequency_
                            ? bottom[i]
                            : add_vertex(models::lerp(mesh_.positions[left[row]], mesh_.positions[right[row]],
                                                      static_cast<double>(i) / row)));
      below.push_back(right[row]);
      for (std::uint32_t i = 0; i < row; ++i) {
        mesh_.triangles.push_back({above[i], below[i], below[i + 1]});
        if (i + 1 < row) mesh_.triangles.push_back({above[i], below[i + 1], above[i + 1]});
      }
      above = std::move(below);
    }
  }

  std::uint32_t frequency_;
  TriangleMesh mesh_;
  std::vector<Triangle> faces_;
  EdgeVertices edges_[12][12];
};

/// The surface of a box on a lattice of (resolution + 1)³ points. Only points on the surface get ids.
class Box {
 public:
  Box(Vec3d size, std::uint32_t resolution) : size_(size), resolution_(resolution) {}

  TriangleMesh make() {
    mesh_.name = "box";
    // Layers in z: the first and the last are full grids, the layers between are rings.
    layers_.resize(resolution_ + 1);
    for (std::uint32_t z = 0; z <= resolution_; ++z) add_layer(z);
    for (int axis = 0; axis < 3; ++axis)
      for (const std::uint32_t at : {0u, resolution_}) add_face(axis, at);
    return std::move(mesh_);
  }

 private:
  using Lattice = std::array<std::uint32_t, 3>;

  double coordinate(int axis, std::uint32_t i) const {
    // This order of operations makes both ends exact and the box symmetric.
    return size_[axis] * ((2.0 * i - resolution_) / (2.0 * resolution_));
  }

  void add_layer(std::uint32_t z) {
    const bool full = z == 0 || z == resolution_;
    layers_[z] = static_cast<std::uint32_t>(mesh_.positions.size());
    for (std::uint32_t y = 0; y <= resolution_; ++y) {
      for (std::uint32_t x = 0; x <= resolution_; ++x) {
        const bool inner = x != 0 && x != resolution_ && y != 0 && y != resolution_;
        if (full || !inner) mesh_.positions.push_back({coordinate(0, x), coordinate(1, y), coordinate(2, z)});
      }
    }
  }

  std::uint32_t vertex(const Lattice& at) const {
    const std::uint32_t row = resolution_ + 1;
    const auto& [x, y, z] = at;
    if (z == 0 || z == resolution_) return layers_[z] + y * row + x;
    if (y == 0) return layers_[z] + x;
    if (y == resolution_) return layers_[z] + row + 2 * (resolution_ - 1) + x;
    return layers_[z] + row + 2 * (y - 1) + (x == 0 ? 0 : 1);
  }

  void add_face(int axis, std::uint32_t at) {
    const int u = (axis + 1) % 3;
    const int v = (axis + 2) % 3;
    for (std::uint32_t j = 0; j < resolution_; ++j) {
      for (std::uint32_t i = 0; i < resolution_; ++i) {
        const auto corner = [&](std::uint32_t du, std::uint32_t dv) {
          Lattice lattice{};
          lattice[axis] = at;
          lattice[u] = i + du;
          lattice[v] = j + dv;
          return vertex(lattice);
        };
        const std::uint32_t a = corner(0, 0);
        const std::uint32_t b = corner(1, 0);
        const std::uint32_t c = corner(1, 1);
        const std::uint32_t d = corner(0, 1);
        if (at == 0) {
          mesh_.triangles.push_back({a, c, b});
          mesh_.triangles.push_back({a, d, c});
        } else {
          mesh_.triangles.push_back({a, b, c});
          mesh_.triangles.push_back({a, c, d});
        }
      }
    }
  }

  Vec3d size_;
  std::uint32_t resolution_;
  TriangleMesh mesh_;
  std::vector<std::uint32_t> layers_;
};

}  // namespace

TriangleMesh make_icosphere(std::uint32_t frequency) {
  check_count("icosphere", "frequency", frequency, 1);
  check_triangles("icosphere", 20.0 * frequency * frequency);
  return Icosphere(frequency).make();
}

TriangleMesh make_torus(std::uint32_t rings, std::uint32_t sides, double major_radius, double minor_radius) {
  check_count("torus", "rings", rings, 3);
  check_count("torus", "sides", sides, 3);
  check_size("torus", "major radius", major_radius);
  check_size("torus", "minor radius", minor_radius);
  check_triangles("torus", 2.0 * rings * sides);
  TriangleMesh mesh{.name = "torus", .positions = {}, .triangles = {}};
  for (std::uint32_t ring = 0; ring < rings; ++ring) {
    const double around = static_cast<double>(ring) / rings;
    for (std::uint32_t side = 0; side < sides; ++side) {
      const double tube = static_cast<double>(side) / sides;
      const double radius = major_radius + minor_radius * cos_turns(tube);
      mesh.positions.push_back(
          {radius * cos_turns(around), minor_radius * sin_turns(tube), radius * sin_turns(around)});
      const std::uint32_t next_ring = (ring + 1) % rings;
      const std::uint32_t next_side = (side + 1) % sides;
      const std::uint32_t a = ring * sides + side;
      const std::uint32_t b = ring * sides + next_side;
      const std::uint32_t c = next_ring * sides + next_side;
      const std::uint32_t d = next_ring * sides + side;
      mesh.triangles.push_back({a, b, c});
      mesh.triangles.push_back({a, c, d});
    }
  }
  return mesh;
}

TriangleMesh make_box(Vec3d size, std::uint32_t resolution) {
  check_size("box", "size along x", size.x);
  check_size("box", "size along y", size.y);
  check_size("box", "size along z", size.z);
  check_count("box", "resolution", resolution, 1);
  check_triangles("box", 12.0 * resolution * resolution);
  return Box(size, resolution).make();
}

TriangleMesh make_cloth(std::uint32_t columns, std::uint32_t rows, double width, double depth) {
  check_count("cloth", "columns", columns, 1);
  check_count("cloth", "rows", rows, 1);
  check_size("cloth", "width", width);
  check_size("cloth", "depth", depth);
  check_triangles("cloth", 2.0 * columns * rows);
  TriangleMesh mesh{.name = "cloth", .positions = {}, .triangles = {}};
  for (std::uint32_t row = 0; row <= rows; ++row)
    for (std::uint32_t column = 0; column <= columns; ++column)
      mesh.positions.push_back({width * ((2.0 * column - columns) / (2.0 * columns)), 0,
                                depth * ((2.0 * row - rows) / (2.0 * rows))});
  for (std::uint32_t row = 0; row < rows; ++row) {
    for (std::uint32_t column = 0; column < columns; ++column) {
      const std::uint32_t a = row * (columns + 1) + column;
      const std::uint32_t b = a + 1;
      const std::uint32_t c = b + columns + 1;
      const std::uint32_t d = c - 1;
      if ((row + column) % 2 == 0) {
        mesh.triangles.push_back({a, c, b});
        mesh.triangles.push_back({a, d, c});
      } else {
        mesh.triangles.push_back({a, d, b});
        mesh.triangles.push_back({b, d, c});
      }
    }
  }
  return mesh;
}

}  // namespace supple
