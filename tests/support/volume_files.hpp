#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "elements/element_mesh.hpp"
#include "files/number_text.hpp"
#include "supple/mesh.hpp"
#include "support/random.hpp"

namespace supple {

/// Polygons and solids with integer coordinates, as they are written into files.
struct Elements {
  struct Element {
    bool is_solid;
    Solid solid;
    std::vector<std::uint32_t> corners;
  };
  std::vector<std::array<int, 3>> points;
  std::vector<Element> elements;

  std::vector<Vec3d> positions() const {
    std::vector<Vec3d> result;
    for (const auto& [x, y, z] : points) result.push_back({double(x), double(y), double(z)});
    return result;
  }
};

/// The numbers of a file: text, or binary in either byte order.
class FileWriter {
 public:
  enum Encoding { text, little, big };
  explicit FileWriter(Encoding encoding) : encoding_(encoding) {}

  FileWriter& line(const std::string& words) {
    bytes_ += words + '\n';
    return *this;
  }
  template <class Scalar>
  FileWriter& put(Scalar value) {
    if (encoding_ == text) {
      if constexpr (std::is_floating_point_v<Scalar>) {
        append_number(bytes_, double(value));
      } else {
        bytes_ += std::to_string(value);
      }
      bytes_ += ' ';
    } else {
      auto scalar = std::bit_cast<std::array<char, sizeof(Scalar)>>(value);
      const bool is_native = (std::endian::native == std::endian::little) == (encoding_ == little);
      if (!is_native) std::reverse(scalar.begin(), scalar.end());
      bytes_.append(scalar.data(), scalar.size());
    }
    return *this;
  }
  /// Ends a row of numbers in a text.
  FileWriter& end_row() {
    if (encoding_ == text) bytes_ += '\n';
    return *this;
  }
  bool is_text() const { return encoding_ == text; }
  std::size_t size() const { return bytes_.size(); }
  const std::string& bytes() const { return bytes_; }

 private:
  Encoding encoding_;
  std::string bytes_;
};

/// Random cubes of a grid, each cut into solids of one kind that fit to those of its neighbours. The corners
/// of some solids are in the opposite order.
inline Elements random_solids(Solid kind, RandomNumbers& random) {
  constexpr int side = 3;
  Elements result;
  const auto id = [](int x, int y, int z) { return std::uint32_t(x + 4 * (y + 4 * z)); };
  for (int z = 0; z <= side; ++z) {
    for (int y = 0; y <= side; ++y) {
      for (int x = 0; x <= side; ++x) result.points.push_back({2 * x, 2 * y, 2 * z});
    }
  }
  const auto add = [&](std::vector<std::uint32_t> corners) {
    if (random.below(4) == 0) {
      switch (kind) {
        case Solid::tetrahedron:
          std::swap(corners[0], corners[1]);
          break;
        case Solid::hexahedron:
          std::rotate(corners.begin(), corners.begin() + 4, corners.end());
          break;
        case Solid::prism:
          std::rotate(corners.begin(), corners.begin() + 3, corners.end());
          break;
        default:
          std::swap(corners[1], corners[3]);
      }
    }
    result.elements.push_back({true, kind, std::move(corners)});
  };
  for (int z = 0; z < side; ++z) {
    for (int y = 0; y < side; ++y) {
      for (int x = 0; x < side; ++x) {
        if (random.below(3) == 0) continue;
        const std::array<std::uint32_t, 8> c = {
            id(x, y, z),     id(x + 1, y, z),     id(x + 1, y + 1, z),     id(x, y + 1, z),
            id(x, y, z + 1), id(x + 1, y, z + 1), id(x + 1, y + 1, z + 1), id(x, y + 1, z + 1)};
        if (kind == Solid::tetrahedron) {
          // Around the diagonal from corner 0 to corner 6.
          const std::array<std::size_t, 6> ring = {1, 2, 3, 7, 4, 5};
          for (std::size_t i = 0; i < 6; ++i) add({c[0], c[ring[i]], c[ring[(i + 1) % 6]], c[6]});
        } else if (kind == Solid::hexahedron) {
          add({c.begin(), c.end()});
        } else if (kind == Solid::prism) {
          add({c[0], c[1], c[2], c[4], c[5], c[6]});
          add({c[0], c[2], c[3], c[4], c[6], c[7]});
        } else {
          const auto middle = std::uint32_t(result.points.size());
          result.points.push_back({2 * x + 1, 2 * y + 1, 2 * z + 1});
          for (const std::array<std::size_t, 4>& f : std::vector<std::array<std::size_t, 4>>{
                   {0, 1, 2, 3}, {4, 7, 6, 5}, {0, 4, 5, 1}, {1, 5, 6, 2}, {2, 6, 7, 3}, {3, 7, 4, 0}})
            add({c[f[0]], c[f[1]], c[f[2]], c[f[3]], middle});
        }
      }
    }
  }
  return result;
}

/// The faces of exactly one solid, as loops that start at their lowest corner, sorted. By another way than
/// the library: it finds outwards from the middle of each convex solid.
inline std::vector<std::vector<std::uint32_t>> boundary_loops(const Elements& mesh) {
  const std::map<Solid, std::vector<std::vector<std::size_t>>> faces = {
      {Solid::tetrahedron, {{0, 1, 2}, {0, 1, 3}, {0, 2, 3}, {1, 2, 3}}},
      {Solid::hexahedron,
       {{0, 1, 2, 3}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}}},
      {Solid::prism, {{0, 1, 2}, {3, 4, 5}, {0, 1, 4, 3}, {1, 2, 5, 4}, {2, 0, 3, 5}}},
      {Solid::pyramid, {{0, 1, 2, 3}, {0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}}}};
  struct Found {
    int count = 0;
    std::vector<std::uint32_t> loop;
  };
  std::map<std::vector<std::uint32_t>, Found> found;
  for (const Elements::Element& element : mesh.elements) {
    if (!element.is_solid) continue;
    const auto n = int(element.corners.size());
    std::array<int, 3> sum{};
    for (const std::uint32_t corner : element.corners) {
      for (std::size_t axis = 0; axis < 3; ++axis) sum[axis] += mesh.points[corner][axis];
    }
    for (const auto& face : faces.at(element.solid)) {
      std::vector<std::uint32_t> loop;
      for (const std::size_t i : face) loop.push_back(element.corners[i]);
      const auto& a = mesh.points[loop[0]];
      std::array<int, 3> u, v, w;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        u[axis] = mesh.points[loop[1]][axis] - a[axis];
        v[axis] = mesh.points[loop[2]][axis] - a[axis];
        w[axis] = n * a[axis] - sum[axis];  // from the middle to the face
      }
      const int outward = w[0] * (u[1] * v[2] - u[2] * v[1]) - w[1] * (u[0] * v[2] - u[2] * v[0]) +
                          w[2] * (u[0] * v[1] - u[1] * v[0]);
      if (outward < 0) std::reverse(loop.begin(), loop.end());
      std::rotate(loop.begin(), std::min_element(loop.begin(), loop.end()), loop.end());
      std::vector<std::uint32_t> key = loop;
      std::sort(key.begin(), key.end());
      ++found[key].count;
      found[key].loop = loop;
    }
  }
  std::vector<std::vector<std::uint32_t>> result;
  for (const auto& [key, face] : found) {
    if (face.count == 1) result.push_back(face.loop);
  }
  std::sort(result.begin(), result.end());
  return result;
}

/// Whether the triangles are those of fans over these loops, each loop once.
inline bool covers(const TriangleMesh& mesh, const std::vector<std::vector<std::uint32_t>>& loops) {
  std::size_t used = 0;
  for (const auto& loop : loops) {
    const auto next = [&](std::uint32_t corner) {
      return loop[std::size_t(std::find(loop.begin(), loop.end(), corner) - loop.begin() + 1) % loop.size()];
    };
    std::size_t triangles = 0, sides = 0;
    for (const Triangle& t : mesh.triangles) {
      if (!std::ranges::all_of(t, [&](std::uint32_t c) { return std::ranges::count(loop, c) == 1; }))
        continue;
      ++triangles;
      for (std::size_t i = 0; i < 3; ++i) sides += next(t[i]) == t[(i + 1) % 3];
    }
    if (triangles != loop.size() - 2 || sides != loop.size()) return false;
    used += triangles;
  }
  return used == mesh.triangles.size();
}

}  // namespace supple
