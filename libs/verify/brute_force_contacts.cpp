#include "verify/brute_force.hpp"

#include <algorithm>
#include <set>

#include "mesh/share_vertex.hpp"

namespace supple {
namespace {

/// Whether triangles (p, q, a) and (p, q, b) share a point outside of the segment from p to q.
bool overlap_beside_edge(const Vec3d& p, const Vec3d& q, const Vec3d& a, const Vec3d& b) {
  const RationalVector zero{}, from = exact(p), u = minus(exact(q), from), to_a = minus(exact(a), from),
                               to_b = minus(exact(b), from);
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
  const auto at = [&](std::uint32_t v) { return object.end[v]; };
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

}  // namespace

std::vector<TrianglePair> intersecting_pairs_by_brute_force(const PlainObject& a, const PlainObject& b,
                                                            bool same_object, const Parallel& parallel) {
  const auto decide = [&](const BoxedElement& p, const BoxedElement& q) -> std::optional<TrianglePair> {
    const TrianglePair pair{p.name[0], q.name[0]};
    if (same_object && pair.b <= pair.a) return {};
    const Triangle &ids_p = a.triangles[pair.a], &ids_q = b.triangles[pair.b];
    const bool are_neighbours = same_object && share_vertex(ids_p, ids_q);
    if (are_neighbours && a.neighbours == Neighbours::skip) return {};
    if (!may_touch_by_groups(a.groups, ids_p, b.groups, ids_q)) return {};
    const bool meet = are_neighbours ? meet_elsewhere_by_axes(a, ids_p, ids_q)
                                     : triangles_intersect_by_axes(a.corners(pair.a), b.corners(pair.b));
    return meet ? std::optional(pair) : std::nullopt;
  };
  std::vector<TrianglePair> pairs;
  decide_all(boxed_faces(a), boxed_faces(b), false, 0, parallel, decide, pairs);
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

}  // namespace supple
