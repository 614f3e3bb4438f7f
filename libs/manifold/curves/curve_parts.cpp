#include "manifold/curves/curve_parts.hpp"

#include <algorithm>
#include <cmath>

#include "geometry/vector.hpp"

namespace supple {
namespace {

/// Twice the area of a triangle across z.
double turn(const Vec3d& p, const Vec3d& q, const Vec3d& r) {
  return (q.x - p.x) * (r.y - p.y) - (q.y - p.y) * (r.x - p.x);
}

/// Whether a corner of b is on the inner side of each edge of a, by more than rounding.
bool reaches_in(const TrianglePoints& a, const TrianglePoints& b, double slack) {
  const double area = turn(a[0], a[1], a[2]);
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3d &p = a[i], &q = a[(i + 1) % 3];
    const double least = slack * (std::fabs(q.x - p.x) + std::fabs(q.y - p.y));
    const bool is_in = std::any_of(b.begin(), b.end(), [&](const Vec3d& r) {
      const double height = turn(p, q, r);
      return (area > 0 ? height : -height) > least;
    });
    if (!is_in) return false;
  }
  return true;
}

/// A convex polygon: the part of triangle a that lies above or below triangle b.
class SharedPolygon {
 public:
  SharedPolygon(const TrianglePoints& a, const TrianglePoints& b) {
    std::copy(a.begin(), a.end(), corners_.begin());
    const double area = turn(b[0], b[1], b[2]);
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3d &p = b[i], &q = b[(i + 1) % 3];
      cut([&](const Vec3d& r) { return area > 0 ? turn(p, q, r) : -turn(p, q, r); });
    }
  }
  const Vec3d* begin() const { return corners_.data(); }
  const Vec3d* end() const { return corners_.data() + count_; }

 private:
  template <class Height>
  void cut(const Height& height) {
    std::array<Vec3d, 9> kept;
    std::size_t count = 0;
    for (std::size_t i = 0; i < count_; ++i) {
      const Vec3d &p = corners_[i], &q = corners_[(i + 1) % count_];
      const double of_p = height(p), of_q = height(q);
      if (of_p >= 0) kept[count++] = p;
      if ((of_p > 0 && of_q < 0) || (of_p < 0 && of_q > 0)) kept[count++] = mix(p, q, of_p / (of_p - of_q));
    }
    corners_ = kept;
    count_ = count;
  }

  std::array<Vec3d, 9> corners_;
  std::size_t count_ = 3;
};

/// The height of the plane of a triangle at a point, within that of its corners.
double height_at(const TrianglePoints& q, double area, const Vec3d& p) {
  const double along_1 = turn(q[2], q[0], p) / area, along_2 = turn(q[0], q[1], p) / area;
  const auto [low, high] = std::minmax({q[0].z, q[1].z, q[2].z});
  return std::clamp(q[0].z + along_1 * (q[1].z - q[0].z) + along_2 * (q[2].z - q[0].z), low, high);
}

/// The longest way in z from the edges of an upright triangle to another triangle, or the other way round.
/// Edges at its border are not ahead of it.
double way_of_upright(const TrianglePoints& upright, const TrianglePoints& q, double area, double slack,
                      double sign) {
  double longest = -CurveParts::nothing_ahead;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3d &p = upright[i], &r = upright[(i + 1) % 3];
    double first = 0, last = 1;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3d &u = q[k], &v = q[(k + 1) % 3];
      const double side = area > 0 ? 1 : -1, least = slack * (std::fabs(v.x - u.x) + std::fabs(v.y - u.y));
      const double of_p = side * turn(u, v, p) - least, of_r = side * turn(u, v, r) - least;
      if (of_p <= 0 && of_r <= 0) last = -1;
      if (of_p < 0 && of_r > 0) first = std::max(first, of_p / (of_p - of_r));
      if (of_p > 0 && of_r < 0) last = std::min(last, of_p / (of_p - of_r));
    }
    if (first > last) continue;
    for (const double t : {first, last}) {
      const Vec3d at = mix(p, r, t);
      longest = std::max(longest, sign * (height_at(q, area, at) - at.z));
    }
  }
  return longest;
}

/// The longest way in z from a to b; minus infinity when nothing of b is straight ahead.
double way_between(const TrianglePoints& a, const TrianglePoints& b) {
  double size = 0;
  for (std::size_t i = 0; i < 3; ++i)
    size = std::max({size, largest_magnitude(a[i] - a[0]), largest_magnitude(b[i] - b[0])});
  const double slack = 0x1p-40 * size, area_a = turn(a[0], a[1], a[2]), area_b = turn(b[0], b[1], b[2]);
  const bool a_is_upright = !(std::fabs(area_a) > slack * size),
             b_is_upright = !(std::fabs(area_b) > slack * size);
  if (a_is_upright && b_is_upright) return -CurveParts::nothing_ahead;
  if (a_is_upright) return way_of_upright(a, b, area_b, slack, 1);
  if (b_is_upright) return way_of_upright(b, a, area_a, slack, -1);
  if (!reaches_in(a, b, slack) || !reaches_in(b, a, slack)) return -CurveParts::nothing_ahead;
  // The heights stay within those of the corners, so that no way exceeds the bound of a node.
  const double lowest_a = std::min({a[0].z, a[1].z, a[2].z});
  double longest = -CurveParts::nothing_ahead;
  for (const Vec3d& p : SharedPolygon(a, b))
    longest = std::max(longest, height_at(b, area_b, p) - std::max(p.z, lowest_a));
  return longest;
}

}  // namespace

void CurveParts::look_along(const Vec3d& normal) {
  const Vec3d across = cross(normal, shortest_axis(normal)), u = across / norm(across), v = cross(normal, u);
  axes_ = {u, v, normal};
}

std::optional<Vec3d> CurveParts::middle_of(const TrianglePoints& p, const TrianglePoints& q,
                                           const Vec3d& normal) {
  look_along(normal);
  const SharedPolygon polygon(seen(p), seen(q));
  if (polygon.begin() == polygon.end()) return std::nullopt;
  Vec3d sum;
  for (const Vec3d& corner : polygon) sum += corner;
  sum = sum / static_cast<double>(polygon.end() - polygon.begin());
  return sum.x * axes_[0] + sum.y * axes_[1] + sum.z * axes_[2];
}

double CurveParts::way_along(const Vec3d& normal, double limit, double least) {
  look_along(normal);
  if (triangles_[0].empty() || triangles_[1].empty()) return nothing_ahead;
  for (std::size_t side = 0; side < 2; ++side) {
    if (!is_built_[side]) build(side);
    project(side);
  }
  is_built_ = {true, true};
  double longest = least;
  const auto push = [&](std::uint32_t a, std::uint32_t b) {
    const Box &of_a = nodes_[0][a].box, &of_b = nodes_[1][b].box;
    if (of_a.is_upright && of_b.is_upright) return;
    const double bound = of_b.max.z - of_a.min.z;
    const bool overlap = of_a.min.x < of_b.max.x && of_b.min.x < of_a.max.x && of_a.min.y < of_b.max.y &&
                         of_b.min.y < of_a.max.y;
    if (overlap && bound > longest) stack_.push_back({a, b, bound});
  };
  stack_.clear();
  push(0, 0);
  while (!stack_.empty() && longest <= limit) {
    const auto [a, b, bound] = stack_.back();
    stack_.pop_back();
    if (bound <= longest) continue;
    if (bound <= rounding && longest > 0) {
      longest = bound;
      continue;
    }
    const Node &of_a = nodes_[0][a], &of_b = nodes_[1][b];
    const std::size_t first = stack_.size();
    if (of_a.child == 0 && of_b.child == 0) {
      for (std::uint32_t i = of_a.first; i < of_a.last; ++i) {
        for (std::uint32_t k = of_b.first; k < of_b.last; ++k) {
          const double way = way_between(projected_[0][i].corners, projected_[1][k].corners);
          if (way > longest) ends_ = {triangles_[0][i].triangle, triangles_[1][k].triangle};
          longest = std::max(longest, way);
        }
      }
    } else if (of_b.child == 0 || (of_a.child != 0 && of_a.last - of_a.first >= of_b.last - of_b.first)) {
      push(of_a.child, b);
      push(of_a.child + 1, b);
    } else {
      push(a, of_b.child);
      push(a, of_b.child + 1);
    }
    if (stack_.size() == first + 2 && stack_[first].bound > stack_[first + 1].bound)
      std::swap(stack_[first], stack_[first + 1]);
  }
  return longest == least ? nothing_ahead : std::max(longest, 0.0);
}

bool CurveParts::is_covered(std::size_t side, const Vec3d& point, double way) {
  const Vec3d p = seen(point);
  const double sign = side == 0 ? 1 : -1;
  const auto& nodes = nodes_[1 - side];
  stack_.assign(1, {0, 0, 0});
  while (!stack_.empty()) {
    const Node& node = nodes[stack_.back().a];
    stack_.pop_back();
    const Box& box = node.box;
    if (p.x < box.min.x || p.x > box.max.x || p.y < box.min.y || p.y > box.max.y) continue;
    if (node.child != 0) {
      stack_.push_back({node.child, 0, 0});
      stack_.push_back({node.child + 1, 0, 0});
    }
    for (std::uint32_t i = node.first; node.child == 0 && i < node.last; ++i) {
      const TrianglePoints& q = projected_[1 - side][i].corners;
      const double area = turn(q[0], q[1], q[2]), a = turn(q[1], q[2], p) / area,
                   b = turn(q[2], q[0], p) / area;
      const double height = sign * (a * q[0].z + b * q[1].z + (1 - a - b) * q[2].z - p.z);
      if (a >= 0 && b >= 0 && a + b <= 1 && height >= 0 && height <= way * (1 + 0x1p-36)) return true;
    }
  }
  return false;
}

/// A binary tree over the triangles of a side; a child stands behind its parent.
void CurveParts::build(std::size_t side) {
  nodes_[side].clear();
  nodes_[side].push_back({{}, 0, static_cast<std::uint32_t>(triangles_[side].size()), 0});
  for (std::uint32_t node = 0; node < nodes_[side].size(); ++node) split(side, node);
}

void CurveParts::split(std::size_t side, std::uint32_t number) {
  constexpr std::uint32_t leaf_size = 2;
  const Node node = nodes_[side][number];
  if (node.last - node.first <= leaf_size) return;
  const auto at = [&](std::uint32_t i) { return triangles_[side].begin() + static_cast<std::ptrdiff_t>(i); };
  const auto middle_of = [](const Part& p) { return p.corners[0] + p.corners[1] + p.corners[2]; };
  Box box{middle_of(*at(node.first)), middle_of(*at(node.first))};
  for (std::uint32_t i = node.first + 1; i < node.last; ++i)
    box.include({middle_of(*at(i)), middle_of(*at(i))});
  const Vec3d size = box.max - box.min;
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const std::uint32_t middle = node.first + (node.last - node.first) / 2;
  std::nth_element(at(node.first), at(middle), at(node.last),
                   [&](const Part& p, const Part& q) { return middle_of(p)[axis] < middle_of(q)[axis]; });
  nodes_[side][number].child = static_cast<std::uint32_t>(nodes_[side].size());
  nodes_[side].push_back({{}, node.first, middle, 0});
  nodes_[side].push_back({{}, middle, node.last, 0});
}

/// The triangles and the boxes of the nodes as seen along the normal.
void CurveParts::project(std::size_t side) {
  projected_[side].clear();
  for (const Part& part : triangles_[side]) {
    TrianglePoints triangle = part.corners;
    for (Vec3d& p : triangle) p = seen(p);
    Box box{triangle[0], triangle[0]};
    for (const Vec3d& p : triangle) box.include({p, p});
    const double size = largest_magnitude(box.max - box.min);
    box.is_upright = std::fabs(turn(triangle[0], triangle[1], triangle[2])) < 0x1p-43 * size * size;
    projected_[side].push_back({triangle, box});
  }
  for (std::size_t i = nodes_[side].size(); i-- > 0;) {
    Node& node = nodes_[side][i];
    node.box = node.child != 0 ? nodes_[side][node.child].box : projected_[side][node.first].box;
    if (node.child != 0) node.box.include(nodes_[side][node.child + 1].box);
    for (std::uint32_t k = node.first + 1; node.child == 0 && k < node.last; ++k)
      node.box.include(projected_[side][k].box);
  }
}

}  // namespace supple
