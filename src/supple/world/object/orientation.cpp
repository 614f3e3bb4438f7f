#include "world/object/orientation.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include "contact/distance/axis_ray.hpp"
#include "geometry/numbers/integer_points.hpp"
#include "geometry/vector.hpp"
#include "mesh/vertex_sets.hpp"
#include "supple/orientation.hpp"
#include "supple/queries.hpp"
#include "supple/topology.hpp"

namespace supple {
namespace {

TrianglePoints corners_of(const Triangle& triangle, const PositionsView& positions) {
  return {positions[triangle[0]], positions[triangle[1]], positions[triangle[2]]};
}

/// The sign of the volume that triangles enclose; 0 also when a vertex is not finite. `for_each(visit)` calls
/// `visit` with the corners of each triangle. The filter takes `origin` as the origin.
template <class ForEach>
int sign_of_volume(const Vec3d& origin, const ForEach& for_each) {
  double volume = 0, products = 0, largest = 0, count = 0;
  for_each([&](const TrianglePoints& p) {
    const Vec3d u = p[0] - origin, v = p[1] - origin, w = p[2] - origin;
    volume += dot(cross(u, v), w);
    const Vec3d a = absolute(u), b = absolute(v), c = absolute(w);
    products += (a.y * b.z + a.z * b.y) * c.x + (a.z * b.x + a.x * b.z) * c.y + (a.x * b.y + a.y * b.x) * c.z;
    largest = std::max({largest, largest_magnitude(u), largest_magnitude(v), largest_magnitude(w)});
    ++count;
  });
  // Each term has less than 12 roundings, and each sum one for each term. Terms that vanish in the range of
  // doubles are below 2^-1074 · 2^300 each.
  const double bound = (count + 16) * 0x1p-52 * products;
  if (largest < 0x1p300 && products > 0x1p-600 && std::fabs(volume) > bound) return volume > 0 ? 1 : -1;

  BitExtent extent;
  bool all_finite = true;
  for_each([&](const TrianglePoints& p) {
    for (const Vec3d& corner : p) {
      all_finite = all_finite && is_finite(corner);
      for (int axis = 0; all_finite && axis < 3; ++axis) extent.include(corner[axis]);
    }
  });
  if (!all_finite) return 0;
  UnboundedInteger sum = 0;
  for_each([&](const TrianglePoints& p) {
    std::array<Vector3<UnboundedInteger>, 3> integers;
    for (std::size_t i = 0; i < 9; ++i)
      integers[i / 3][i % 3] = to_integer<UnboundedInteger>(p[i / 3][static_cast<int>(i % 3)], extent.bottom);
    sum += determinant(integers[0], integers[1], integers[2]);
  });
  return sign(sum);
}

/// Whether a box is inside another one and touches no side of it.
bool surrounds(const QueryBox& outer, const QueryBox& inner) {
  for (int axis = 0; axis < 3; ++axis) {
    if (!(outer.min[axis] < inner.min[axis] && inner.max[axis] < outer.max[axis])) return false;
  }
  return true;
}

}  // namespace

Orientation::Orientation(std::vector<Triangle> triangles, const PositionsView& positions)
    : triangles_(std::move(triangles)), order_(triangles_.size()), inward_(triangles_.size()) {
  VertexSets sets(positions.size());
  for (const auto& [v, w, x] : triangles_) sets.join(sets.join(v, w), x);
  const auto root_of = [&](std::uint32_t t) { return sets.root(triangles_[t][0]); };
  std::iota(order_.begin(), order_.end(), 0u);
  std::ranges::sort(order_, {}, [&](std::uint32_t t) { return std::pair(root_of(t), t); });
  for (std::uint32_t i = 0; i < order_.size(); ++i) {
    if (i == 0 || root_of(order_[i]) != root_of(order_[i - 1])) parts_.push_back({i, i});
    ++parts_.back().last;
  }
  if (parts_.size() > 1) find_holes(positions);
  judge(positions);
}

void Orientation::find_holes(const PositionsView& positions) {
  std::vector<QueryBox> boxes(parts_.size());
  std::vector<std::uint32_t> by_x, reached;  // parts, and those that may reach to the present one
  for (std::uint32_t i = 0; i < parts_.size(); ++i) {
    const std::span<const std::uint32_t> triangles = triangles_of(parts_[i]);
    boxes[i].min = boxes[i].max = positions[triangles_[triangles.front()][0]];
    bool all_finite = true;
    for (const std::uint32_t t : triangles) {
      for (const Vec3d& p : corners_of(triangles_[t], positions)) {
        all_finite = all_finite && is_finite(p);
        boxes[i].min = {std::min(boxes[i].min.x, p.x), std::min(boxes[i].min.y, p.y),
                        std::min(boxes[i].min.z, p.z)};
        boxes[i].max = larger(boxes[i].max, p);
      }
    }
    if (all_finite) by_x.push_back(i);
  }
  const auto is_inside = [&](const Part& inner, const Part& outer) {
    constexpr std::size_t most = 32;
    const std::span<const std::uint32_t> triangles = triangles_of(inner);
    for (std::size_t i = 0; i < most; ++i) {
      const std::size_t corner = i * 3 * triangles.size() / most;
      AxisRay ray(positions[triangles_[triangles[corner / 3]][corner % 3]]);
      for (const std::uint32_t t : triangles_of(outer)) ray.meet(corners_of(triangles_[t], positions));
      if (ray.starts_on_surface() || !ray.is_odd()) return false;
    }
    return true;
  };
  std::ranges::sort(by_x, {}, [&](std::uint32_t i) { return boxes[i].min.x; });
  for (const std::uint32_t i : by_x) {
    std::erase_if(reached, [&](std::uint32_t outer) { return boxes[outer].max.x < boxes[i].min.x; });
    for (const std::uint32_t outer : reached) {
      if (surrounds(boxes[outer], boxes[i]) && is_inside(parts_[i], parts_[outer]))
        parts_[i].is_hole = !parts_[i].is_hole;
    }
    reached.push_back(i);
  }
}

void Orientation::judge(const PositionsView& positions) {
  has_inward_ = false;
  for (const Part& part : parts_) {
    const std::span<const std::uint32_t> triangles = triangles_of(part);
    const int sign = sign_of_volume(positions[triangles_[triangles.front()][0]], [&](const auto& visit) {
      for (const std::uint32_t t : triangles) visit(corners_of(triangles_[t], positions));
    });
    const bool is_inward = sign == (part.is_hole ? 1 : -1);
    has_inward_ = has_inward_ || is_inward;
    for (const std::uint32_t t : triangles) inward_[t] = is_inward ? 1 : 0;
  }
}

std::uint64_t count_inward_triangles(const TriangleMesh& mesh) {
  if (!fault_of_solid(mesh).empty()) return 0;
  const Orientation orientation(mesh.triangles, mesh.positions);
  return static_cast<std::uint64_t>(std::ranges::count(orientation.inward(), 1));
}

}  // namespace supple
