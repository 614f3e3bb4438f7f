#include "verify/brute_force_contacts.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "contact/distance/distance_algebra.hpp"
#include "mesh/share_vertex.hpp"
#include "supple/triangle_intersection.hpp"

namespace supple {
namespace {

struct BoxedTriangle {
  double min[3], max[3];
  std::uint32_t triangle;
};

TrianglePoints points_of(const PlainObject& object, std::uint32_t triangle) {
  const Triangle& ids = object.triangles[triangle];
  return {object.positions[ids[0]], object.positions[ids[1]], object.positions[ids[2]]};
}

/// The exact boxes of all finite triangles.
std::vector<BoxedTriangle> boxed_triangles(const PlainObject& object) {
  std::vector<BoxedTriangle> result;
  result.reserve(object.triangles.size());
  for (std::uint32_t t = 0; t < object.triangles.size(); ++t) {
    const TrianglePoints p = points_of(object, t);
    BoxedTriangle boxed{{}, {}, t};
    bool finite = true;
    for (int axis = 0; axis < 3; ++axis) {
      for (const Vec3d& corner : p) finite = finite && std::isfinite(corner[axis]);
      boxed.min[axis] = std::min({p[0][axis], p[1][axis], p[2][axis]});
      boxed.max[axis] = std::max({p[0][axis], p[1][axis], p[2][axis]});
    }
    if (finite) result.push_back(boxed);
  }
  return result;
}

using RationalVector = std::array<Rational, 3>;

RationalVector difference(const Vec3d& p, const Vec3d& q) {
  return {Rational(p.x) - Rational(q.x), Rational(p.y) - Rational(q.y), Rational(p.z) - Rational(q.z)};
}
Rational dot(const RationalVector& u, const RationalVector& v) {
  return u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
}
RationalVector cross(const RationalVector& u, const RationalVector& v) {
  return {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
}

/// Whether triangles (p, q, a) and (p, q, b) share a point outside of the segment from p to q.
bool overlap_beside_edge(const Vec3d& p, const Vec3d& q, const Vec3d& a, const Vec3d& b) {
  const RationalVector zero{}, u = difference(q, p), to_a = difference(a, p), to_b = difference(b, p);
  if (u == zero) return cross(to_a, to_b) == zero && dot(to_a, to_b) > 0;
  const RationalVector of_a = cross(u, to_a), of_b = cross(u, to_b);
  if (of_a == zero && of_b == zero) {
    const Rational at_a = dot(u, to_a), at_b = dot(u, to_b), end = dot(u, u);
    return (at_a < 0 && at_b < 0) || (at_a > end && at_b > end);
  }
  return cross(of_a, of_b) == zero && dot(of_a, of_b) > 0;
}

/// Whether two triangles with vertices in common share a point of no common vertex or edge. A segment or a
/// point as a triangle repeats a corner.
///
/// What they share is convex. Suppose it has another point. From a common vertex, the segment to that point
/// and beyond leaves one of the triangles on its side opposite to the vertex. With two common vertices, this
/// takes a common plane and both third vertices on one side of the common edge.
bool meet_elsewhere_by_axes(const PlainObject& object, const Triangle& p, const Triangle& q) {
  std::vector<std::uint32_t> shared, of_p, of_q;
  const auto has = [](const Triangle& t, std::uint32_t v) {
    return std::find(t.begin(), t.end(), v) != t.end();
  };
  for (const std::uint32_t v : std::set(p.begin(), p.end())) (has(q, v) ? shared : of_p).push_back(v);
  for (const std::uint32_t v : std::set(q.begin(), q.end())) {
    if (!has(p, v)) of_q.push_back(v);
  }
  if (shared.size() == 3) return true;
  if (of_p.empty() || of_q.empty()) return false;
  const auto at = [&](std::uint32_t v) { return object.positions[v]; };
  if (shared.size() == 2) return overlap_beside_edge(at(shared[0]), at(shared[1]), at(of_p[0]), at(of_q[0]));
  const Vec3d v = at(shared[0]);
  // The side opposite to v; where v is on it, its ends.
  const auto opposite_meets = [&](const std::vector<std::uint32_t>& own,
                                  const std::vector<std::uint32_t>& other) {
    const Vec3d first = at(own.front()), last = at(own.back());
    const TrianglePoints triangle{v, at(other.front()), at(other.back())};
    if (!triangles_intersect_by_axes({first, last, last}, {v, v, v}))
      return triangles_intersect_by_axes({first, last, last}, triangle);
    return std::ranges::any_of(std::array{first, last}, [&](const Vec3d& end) {
      return end != v && triangles_intersect_by_axes({end, end, end}, triangle);
    });
  };
  return opposite_meets(of_p, of_q) || opposite_meets(of_q, of_p);
}

bool boxes_overlap(const BoxedTriangle& p, const BoxedTriangle& q) {
  for (int axis = 0; axis < 3; ++axis) {
    if (p.min[axis] > q.max[axis] || q.min[axis] > p.max[axis]) return false;
  }
  return true;
}

}  // namespace

std::vector<TrianglePair> intersecting_pairs_by_brute_force(const PlainObject& a, const PlainObject& b,
                                                            bool same_object, const Parallel& parallel) {
  const std::vector<BoxedTriangle> boxes_a = boxed_triangles(a);
  std::vector<BoxedTriangle> boxes_b = boxed_triangles(b);
  std::sort(boxes_b.begin(), boxes_b.end(), [](const BoxedTriangle& p, const BoxedTriangle& q) {
    return p.min[0] != q.min[0] ? p.min[0] < q.min[0] : p.triangle < q.triangle;
  });
  // For each box, the largest max x of the boxes up to it. Where that is less than the min x of a box of a,
  // none of the boxes up to here overlaps it.
  std::vector<double> reach;
  reach.reserve(boxes_b.size());
  for (const BoxedTriangle& q : boxes_b)
    reach.push_back(reach.empty() ? q.max[0] : std::max(reach.back(), q.max[0]));

  std::vector<std::vector<TrianglePair>> found(parallel.worker_count());
  parallel.for_ranges(boxes_a.size(), 64, [&](std::size_t begin, std::size_t end, std::uint32_t worker) {
    for (std::size_t i = begin; i < end; ++i) {
      const BoxedTriangle& p = boxes_a[i];
      const auto first = std::lower_bound(reach.begin(), reach.end(), p.min[0]) - reach.begin();
      for (auto q = boxes_b.begin() + first; q != boxes_b.end() && q->min[0] <= p.max[0]; ++q) {
        const Triangle &ids_p = a.triangles[p.triangle], &ids_q = b.triangles[q->triangle];
        if (same_object && q->triangle <= p.triangle) continue;
        const bool are_neighbours = same_object && share_vertex(ids_p, ids_q);
        if (are_neighbours && a.neighbours == Neighbours::skip) continue;
        if (!boxes_overlap(p, *q) || !may_touch_by_groups(a.groups, ids_p, b.groups, ids_q)) continue;
        const bool meet =
            are_neighbours ? meet_elsewhere_by_axes(a, ids_p, ids_q)
                           : triangles_intersect_by_axes(points_of(a, p.triangle), points_of(b, q->triangle));
        if (meet) found[worker].push_back({p.triangle, q->triangle});
      }
    }
  });
  std::vector<TrianglePair> pairs;
  for (const auto& part : found) pairs.insert(pairs.end(), part.begin(), part.end());
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

}  // namespace supple
