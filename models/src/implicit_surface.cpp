#include "implicit_surface.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <limits>

namespace supple::models {

void ImplicitSurface::set_style(double blend, double edge_length) {
  assert(blend > 0 && edge_length > 0);
  blend_ = blend;
  edge_length_ = edge_length;
}

void ImplicitSurface::add_bone(Vec3d start, Vec3d end, double start_radius, double end_radius) {
  const double reach = norm(end - start) / 2 + std::max(start_radius, end_radius);
  parts_.push_back({Kind::bone,
                    start,
                    end,
                    start_radius,
                    end_radius,
                    {},
                    {},
                    {},
                    {},
                    lerp(start, end, 0.5),
                    reach,
                    blend_,
                    edge_length_});
}

void ImplicitSurface::add_ellipsoid(Vec3d center, Vec3d radii, Vec3d side, Vec3d up) {
  const Vec3d y = unit(up);
  const Vec3d x = unit(side - y * dot(side, y));
  const double reach = std::max({radii.x, radii.y, radii.z});
  parts_.push_back(
      {Kind::ellipsoid, center, center, 0, 0, radii, x, y, cross(x, y), center, reach, blend_, edge_length_});
}

void ImplicitSurface::carve_ellipsoid(Vec3d center, Vec3d radii, Vec3d side, Vec3d up) {
  add_ellipsoid(center, radii, side, up);
  parts_.back().kind = Kind::carved_ellipsoid;
}

double ImplicitSurface::distance_to(const Part& part, Vec3d point) {
  const Vec3d d = point - part.start;
  if (part.kind == Kind::bone) {
    const Vec3d axis = part.end - part.start;
    const double t = std::clamp(dot(d, axis) / dot(axis, axis), 0.0, 1.0);
    return norm(d - axis * t) - (part.start_radius + (part.end_radius - part.start_radius) * t);
  }
  // First-order distance to an ellipsoid: |p/r| (|p/r| - 1) / |p/r²|.
  const Vec3d scaled{dot(d, part.side) / part.radii.x, dot(d, part.up) / part.radii.y,
                     dot(d, part.front) / part.radii.z};
  const double length = norm(scaled);
  const double slope = norm(Vec3d{scaled.x / part.radii.x, scaled.y / part.radii.y, scaled.z / part.radii.z});
  if (slope == 0) return -std::min({part.radii.x, part.radii.y, part.radii.z});
  return length * (length - 1) / slope;
}

SurfaceSample ImplicitSurface::sample(Vec3d point) const {
  assert(!parts_.empty());
  SurfaceSample result{std::numeric_limits<double>::max(), parts_.front().edge_length};
  for (const Part& part : parts_) {
    // Skip parts that are too far away to contribute. The factor 2 covers the approximate distance of
    // ellipsoids.
    const double range = part.reach + 2 * (std::abs(result.distance) + part.blend);
    const Vec3d from_middle = point - part.middle;
    if (dot(from_middle, from_middle) > range * range) continue;

    const double d = distance_to(part, point);
    // Quadratic smooth minimum (Quilez): both distances contribute while they differ by less than `blend`.
    if (part.kind == Kind::carved_ellipsoid) {
      const double overlap = std::max(part.blend - std::abs(result.distance + d), 0.0);
      const double share = std::clamp(0.5 - 0.5 * (result.distance + d) / part.blend, 0.0, 1.0);
      result.distance = std::max(result.distance, -d) + overlap * overlap / (4 * part.blend);
      result.edge_length += (part.edge_length - result.edge_length) * share;
      continue;
    }
    const double overlap = std::max(part.blend - std::abs(result.distance - d), 0.0);
    const double share = std::clamp(0.5 + 0.5 * (result.distance - d) / part.blend, 0.0, 1.0);
    result.distance = std::min(result.distance, d) - overlap * overlap / (4 * part.blend);
    result.edge_length += (part.edge_length - result.edge_length) * share;
  }
  return result;
}

Vec3d ImplicitSurface::project(Vec3d point) const {
  // Estimate value and gradient from the corners of a small tetrahedron.
  constexpr double step = 1e-4;
  constexpr std::array<Vec3d, 4> corners{{{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}}};
  Vec3d slope;
  double distance = 0;
  for (const Vec3d& corner : corners) {
    const double d = sample(point + corner * step).distance;
    slope = slope + corner * (d / (4 * step));
    distance += d / 4;
  }
  // The gradient is small in creases between parts; the floor bounds the step.
  return point - slope * (distance / std::max(dot(slope, slope), 0.25));
}

namespace {

/// Samples the corners of a grid of cubes and makes the vertices of the surface, at most one per edge.
class TetrahedraMarcher {
 public:
  TetrahedraMarcher(const ImplicitSurface& surface, Vec3d low, Vec3d high, double cell)
      : low_(low), cell_(cell) {
    for (int axis = 0; axis < 3; ++axis)
      counts_[axis] = static_cast<std::uint32_t>((high[axis] - low[axis]) / cell) + 2;
    const std::size_t nodes = std::size_t{counts_[0]} * counts_[1] * counts_[2];
    values_.resize(nodes);
    edge_vertices_.assign(nodes * 7, none);
    for (std::uint32_t z = 0; z < counts_[2]; z += block)
      for (std::uint32_t y = 0; y < counts_[1]; y += block)
        for (std::uint32_t x = 0; x < counts_[0]; x += block) sample_block(surface, {x, y, z});
  }

  TriangleMesh march() {
    for (std::uint32_t z = 0; z + 1 < counts_[2]; ++z)
      for (std::uint32_t y = 0; y + 1 < counts_[1]; ++y)
        for (std::uint32_t x = 0; x + 1 < counts_[0]; ++x) march_cube({x, y, z});
    return std::move(mesh_);
  }

 private:
  static constexpr std::uint32_t none = ~0u;
  static constexpr std::uint32_t block = 4;
  using Node = std::array<std::uint32_t, 3>;

  /// Samples block³ nodes, or writes one value for all when the surface is far from them.
  void sample_block(const ImplicitSurface& surface, const Node& first) {
    const double half_side = cell_ * (block - 1) / 2;
    const double middle = surface.sample(position(first) + Vec3d{1, 1, 1} * half_side).distance;
    // The distance is approximate, so compare with twice the half diagonal.
    const bool far = std::abs(middle) > 2 * std::sqrt(3.0) * half_side;
    for (std::uint32_t z = first[2]; z < std::min(first[2] + block, counts_[2]); ++z)
      for (std::uint32_t y = first[1]; y < std::min(first[1] + block, counts_[1]); ++y)
        for (std::uint32_t x = first[0]; x < std::min(first[0] + block, counts_[0]); ++x)
          values_[index({x, y, z})] = far ? middle : surface.sample(position({x, y, z})).distance;
  }

  Vec3d position(const Node& node) const {
    return low_ +
           Vec3d{static_cast<double>(node[0]), static_cast<double>(node[1]), static_cast<double>(node[2])} *
               cell_;
  }

  std::size_t index(const Node& node) const {
    return (std::size_t{node[2]} * counts_[1] + node[1]) * counts_[0] + node[0];
  }

  bool inside(const Node& node) const { return values_[index(node)] < 0; }

  void march_cube(const Node& corner) {
    // Kuhn's six tetrahedra: paths from the low corner to the high corner, one for each order of the axes.
    static constexpr int orders[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
    for (const auto& order : orders) {
      std::array<Node, 4> nodes{corner, corner, corner, corner};
      for (int step = 0; step < 3; ++step)
        for (int later = step + 1; later < 4; ++later) ++nodes[later][order[step]];
      march_tetrahedron(nodes);
    }
  }

  void march_tetrahedron(const std::array<Node, 4>& nodes) {
    std::array<int, 4> in{};
    std::array<int, 4> out{};
    std::size_t in_count = 0;
    std::size_t out_count = 0;
    for (int i = 0; i < 4; ++i) (inside(nodes[i]) ? in[in_count++] : out[out_count++]) = i;
    if (in_count == 0 || out_count == 0) return;
    const Vec3d outward = position(nodes[out[0]]) - position(nodes[in[0]]);
    const auto cut = [&](int a, int b) { return edge_vertex(nodes[std::min(a, b)], nodes[std::max(a, b)]); };
    if (in_count == 2) {
      const std::uint32_t a = cut(in[0], out[0]);
      const std::uint32_t b = cut(in[0], out[1]);
      const std::uint32_t c = cut(in[1], out[1]);
      const std::uint32_t d = cut(in[1], out[0]);
      add_triangle({a, b, c}, outward);
      add_triangle({a, c, d}, outward);
    } else {
      const bool one_in = in_count == 1;
      const int lone = one_in ? in[0] : out[0];
      const std::array<int, 4>& rest = one_in ? out : in;
      add_triangle({cut(lone, rest[0]), cut(lone, rest[1]), cut(lone, rest[2])}, outward);
    }
  }

  /// The vertex on the edge between two nodes of one tetrahedron. `low` is the node nearer to the origin.
  std::uint32_t edge_vertex(const Node& low, const Node& high) {
    const std::size_t way = (high[0] - low[0]) + 2 * (high[1] - low[1]) + 4 * (high[2] - low[2]);
    std::uint32_t& vertex = edge_vertices_[index(low) * 7 + way - 1];
    if (vertex == none) {
      vertex = static_cast<std::uint32_t>(mesh_.positions.size());
      const double a = values_[index(low)];
      const double b = values_[index(high)];
      // Keep away from the ends, so that no two vertices around a node coincide.
      mesh_.positions.push_back(lerp(position(low), position(high), std::clamp(a / (a - b), 0.1, 0.9)));
    }
    return vertex;
  }

  void add_triangle(Triangle triangle, Vec3d outward) {
    const auto& p = mesh_.positions;
    const Vec3d normal = cross(p[triangle[1]] - p[triangle[0]], p[triangle[2]] - p[triangle[0]]);
    if (dot(normal, outward) < 0) std::swap(triangle[1], triangle[2]);
    mesh_.triangles.push_back(triangle);
  }

  Vec3d low_;
  double cell_;
  std::array<std::uint32_t, 3> counts_{};
  std::vector<double> values_;
  std::vector<std::uint32_t> edge_vertices_;  // seven edges lead up from each node
  TriangleMesh mesh_;
};

}  // namespace

TriangleMesh ImplicitSurface::triangulate(double cell) const {
  assert(!parts_.empty());
  Vec3d low = parts_.front().start;
  Vec3d high = low;
  for (const Part& part : parts_) {
    const double reach =
        std::max({part.start_radius, part.end_radius, part.radii.x, part.radii.y, part.radii.z}) +
        part.blend + 2 * cell;
    for (int axis = 0; axis < 3; ++axis) {
      low[axis] = std::min({low[axis], part.start[axis] - reach, part.end[axis] - reach});
      high[axis] = std::max({high[axis], part.start[axis] + reach, part.end[axis] + reach});
    }
  }
  return TetrahedraMarcher(*this, low, high, cell).march();
}

}  // namespace supple::models
