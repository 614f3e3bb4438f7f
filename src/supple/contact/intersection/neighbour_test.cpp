#include "contact/intersection/neighbour_test.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "geometry/exact_predicates.hpp"

namespace supple {
namespace {

/// Distinct vertices of a triangle: those that the other one also has, and the rest.
struct Corners {
  std::array<std::uint32_t, 3> ids{};
  std::array<Vec3d, 3> points{};
  std::size_t count = 0;

  void add(std::uint32_t id, const Vec3d& point) {
    if (std::find(ids.begin(), ids.begin() + count, id) != ids.begin() + count) return;
    ids[count] = id;
    points[count++] = point;
  }
  const Vec3d& last() const { return points[count - 1]; }
};

bool has(const Triangle& triangle, std::uint32_t vertex) {
  return std::find(triangle.begin(), triangle.end(), vertex) != triangle.end();
}

/// Whether b is between a and c on their line; the three points lie on one line.
bool is_between(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  return !lexicographically_less(b, a) == !lexicographically_less(c, b) || a == b || b == c;
}

/// Whether the segments from p through a and from p through b have the same direction.
bool have_same_direction(const Vec3d& p, const Vec3d& a, const Vec3d& b, bool& used_exact) {
  if (a == p || b == p || find_projection(p, a, b, used_exact)) return false;
  return lexicographically_less(p, a) == lexicographically_less(p, b);
}

/// Triangles (p, q, a) and (p, q, b), outside of the segment from p to q.
bool overlap_beside_edge(const Vec3d& p, const Vec3d& q, const Vec3d& a, const Vec3d& b) {
  bool used_exact = false;
  if (p == q) return have_same_direction(p, a, b, used_exact);
  if (orient3d(p, q, a, b, used_exact) != 0) return false;
  const Projection of_a = find_projection(p, q, a, used_exact);
  if (of_a) return orient2d(p, q, b, of_a.axis, used_exact) == of_a.turn;
  if (find_projection(p, q, b, used_exact)) return false;
  const auto is_beyond = [](const Vec3d& start, const Vec3d& end, const Vec3d& point) {
    return point != end && is_between(start, end, point);
  };
  return (is_beyond(p, q, a) && is_beyond(p, q, b)) || (is_beyond(q, p, a) && is_beyond(q, p, b));
}

/// Whether the side opposite to v meets a triangle with the corner v elsewhere. Where v is on that side, its
/// ends count.
bool opposite_side_meets(const Vec3d& v, const Corners& side, const TrianglePoints& triangle) {
  const Vec3d &first = side.points[0], &last = side.last();
  bool used_exact = false;
  // Most sides are above or below the plane of the triangle.
  const auto above_plane = [&](const Vec3d& point) {
    return orient3d(triangle[0], triangle[1], triangle[2], point, used_exact);
  };
  if (above_plane(first) * above_plane(last) > 0) return false;
  const bool is_on_side = !find_projection(v, first, last, used_exact) && is_between(first, v, last);
  if (!is_on_side) return triangles_intersect({first, last, last}, triangle);
  const auto meets = [&](const Vec3d& end) {
    return end != v && triangles_intersect({end, end, end}, triangle);
  };
  return meets(first) || meets(last);
}

}  // namespace

// What the triangles share is convex. Suppose it has another point than the common vertex. The segment from
// the vertex to that point, continued, leaves one of the triangles on its side opposite to the vertex. With a
// common edge, the triangles lie in one plane, and the third vertices on one side of the edge.
bool meet_elsewhere(const Triangle& ids_a, const TrianglePoints& a, const Triangle& ids_b,
                    const TrianglePoints& b) {
  Corners common, of_a, of_b;
  for (std::size_t i = 0; i < 3; ++i) {
    (has(ids_b, ids_a[i]) ? common : of_a).add(ids_a[i], a[i]);
    if (!has(ids_a, ids_b[i])) of_b.add(ids_b[i], b[i]);
  }
  if (common.count == 3) return true;
  if (of_a.count == 0 || of_b.count == 0) return false;
  if (common.count == 2)
    return overlap_beside_edge(common.points[0], common.points[1], of_a.points[0], of_b.points[0]);
  return opposite_side_meets(common.points[0], of_a, b) || opposite_side_meets(common.points[0], of_b, a);
}

}  // namespace supple
