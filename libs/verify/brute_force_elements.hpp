#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "core/parallel.hpp"
#include "supple/contact.hpp"
#include "supple/mesh.hpp"
#include "supple/options.hpp"
#include "supple/triangle_intersection.hpp"
#include "verify/plain_tree.hpp"
#include "world/object/vertex_groups.hpp"

// What the brute forces share: objects, their elements, all pairs of these, and the comparison of lists.
namespace supple {

class WorldObject;

/// The input of the brute force: placed positions at both ends of the step and triangles, with the user's
/// ids.
struct PlainObject {
  std::vector<Vec3d> start{}, end{};
  std::vector<Triangle> triangles{};
  VertexGroups groups{};
  /// Triangles from here on are edges and points of no triangle, with the last vertex repeated.
  std::size_t face_count = triangles.size();
  Neighbours neighbours = Neighbours::skip;

  std::span<const Triangle> faces() const { return std::span(triangles).first(face_count); }
  /// The corners of a triangle at the end.
  TrianglePoints corners(std::uint32_t t) const {
    return {end[triangles[t][0]], end[triangles[t][1]], end[triangles[t][2]]};
  }
};

/// What brute force reads of an object: at both ends of the step, or at rest at its end.
PlainObject plain_object(const WorldObject& object, bool at_rest = true);

/// A vertex, edge or face: its vertices, its ids, and its exact boxes at both ends of the step.
struct BoxedElement {
  std::array<std::uint32_t, 3> vertices;
  std::array<std::uint32_t, 2> name;
  FeatureKind kind;
  QueryBox start, end;
};

/// `faces` also has the edges and points of no triangle.
struct BoxedElements {
  std::vector<BoxedElement> vertices, edges, faces;
};

// Vertices that no triangle uses, and elements with a coordinate that is not finite, are left out.
std::vector<BoxedElement> boxed_faces(const PlainObject& object);
BoxedElements boxed_elements(const PlainObject& object);

/// The number of vertex-face, face-vertex and edge-edge pairs; within one object, each pair once.
std::uint64_t element_pairs(const BoxedElements& a, const BoxedElements& b, bool same_object);

/// Whether p and q are farther apart than the separation along some axis, on the same side at both ends. The
/// factor exceeds the rounding of the differences.
bool stay_apart(const BoxedElement& p, const BoxedElement& q, double separation);

bool share_vertex(const BoxedElement& p, const BoxedElement& q);

inline bool may_touch_by_groups(const PlainObject& a, const BoxedElement& p, const PlainObject& b,
                                const BoxedElement& q) {
  return may_touch_by_groups(a.groups, p.vertices, b.groups, q.vertices);
}

/// Calls `decide(p, q)` for all pairs of elements that may come within `separation` of each other within the
/// step, on all workers, and appends what it returns: an optional value. Within one object, leaves out pairs
/// that share a vertex, and takes pairs of edges once, the smaller one first.
template <class Found, class Decide>
void decide_all(const std::vector<BoxedElement>& a, const std::vector<BoxedElement>& b, bool same_object,
                double separation, const Parallel& parallel, Decide&& decide, std::vector<Found>& found) {
  const auto on_path = [](const BoxedElement& element) { return united(element.start, element.end); };
  std::vector<QueryBox> boxes(b.size());
  std::ranges::transform(b, boxes.begin(), on_path);
  const PlainTree tree(std::move(boxes));
  std::vector<std::vector<Found>> parts(parallel.worker_count());
  parallel.for_ranges(a.size(), 64, [&](std::size_t begin, std::size_t end, std::uint32_t worker) {
    for (std::size_t i = begin; i < end; ++i) {
      const BoxedElement& p = a[i];
      const QueryBox box = on_path(p);
      const auto may_touch = [&](const QueryBox& other) { return !are_apart(box, other, separation); };
      tree.visit(box.min, may_touch, [&](std::uint32_t k) {
        const BoxedElement& q = b[k];
        if (same_object && share_vertex(p, q)) return;
        if (same_object && p.kind == FeatureKind::edge && q.kind == p.kind && q.name <= p.name) return;
        if (stay_apart(p, q, separation)) return;
        if (auto result = decide(p, q)) parts[worker].push_back(std::move(*result));
      });
    }
  });
  for (auto& part : parts) std::move(part.begin(), part.end(), std::back_inserter(found));
}

/// The order of lists of contacts of elements and of near elements.
template <class Pair>
auto place_of(const Pair& pair) {
  if constexpr (requires { pair.kind; })
    return std::tie(pair.kind, pair.element_a, pair.element_b);
  else
    return std::tie(pair.kind_a, pair.kind_b, pair.element_a, pair.element_b);
}

/// Calls `decide(p, q, swaps)` as above for all pairs of elements of these kinds: p is a vertex or an edge of
/// a, with `swaps` a vertex of b.
template <class Found, class Decide>
void decide_elements(const BoxedElements& a, const BoxedElements& b, bool same_object, ElementKinds kinds,
                     double separation, const Parallel& parallel, const Decide& decide,
                     std::vector<Found>& found) {
  const auto in_order = [&](const BoxedElement& p, const BoxedElement& q) { return decide(p, q, false); };
  const auto swapped = [&](const BoxedElement& q, const BoxedElement& p) { return decide(p, q, true); };
  if (kinds != ElementKinds::edge_edge) {
    decide_all(a.vertices, b.faces, same_object, separation, parallel, in_order, found);
    if (!same_object) decide_all(a.faces, b.vertices, false, separation, parallel, swapped, found);
  }
  if (kinds != ElementKinds::vertex_face)
    decide_all(a.edges, b.edges, same_object, separation, parallel, in_order, found);
}

/// Sorts a list and keeps one of the pairs at each place.
template <class Pair>
void sort_by_place(std::vector<Pair>& pairs) {
  std::ranges::sort(pairs, {}, place_of<Pair>);
  const auto rest = std::ranges::unique(pairs, {}, place_of<Pair>);
  pairs.erase(rest.begin(), rest.end());
}

/// Compares two lists in the order of `place`. Calls `added(f)` or `missed(t)` for what only one of them has,
/// and `both(f, t)` for what both have.
template <class Found, class Truth, class Place, class Added, class Missed, class Both>
void match(std::span<const Found> found, std::span<const Truth> truth, const Place& place, const Added& added,
           const Missed& missed, const Both& both) {
  auto next = found.begin();
  for (const Truth& expected : truth) {
    for (; next != found.end() && place(*next) < place(expected); ++next) added(*next);
    if (next != found.end() && place(*next) == place(expected))
      both(*next++, expected);
    else
      missed(expected);
  }
  std::for_each(next, found.end(), added);
}

}  // namespace supple
