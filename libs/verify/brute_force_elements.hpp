#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <numeric>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "core/parallel.hpp"
#include "supple/contact.hpp"
#include "supple/mesh.hpp"
#include "supple/options.hpp"
#include "supple/queries.hpp"
#include "supple/triangle_intersection.hpp"
#include "world/object/vertex_groups.hpp"

namespace supple {

/// Whether the boxes are farther apart than the separation along some axis. The factor exceeds the rounding
/// of the differences.
inline bool are_apart(const QueryBox& a, const QueryBox& b, double separation) {
  const double least = separation * (1 + 0x1p-50);
  for (int axis = 0; axis < 3; ++axis) {
    if (a.min[axis] - b.max[axis] > least || b.min[axis] - a.max[axis] > least) return true;
  }
  return false;
}

/// The exact box of points, of which there is at least one, and of two boxes.
inline QueryBox exact_box(std::span<const Vec3d> points) {
  QueryBox box{points[0], points[0]};
  for (const Vec3d& p : points) {
    for (int axis = 0; axis < 3; ++axis) {
      box.min[axis] = std::min(box.min[axis], p[axis]);
      box.max[axis] = std::max(box.max[axis], p[axis]);
    }
  }
  return box;
}
inline QueryBox united(const QueryBox& a, const QueryBox& b) {
  return exact_box(std::array{a.min, a.max, b.min, b.max});
}

/// The axis of the largest coordinate.
inline int main_axis(const Vec3d& size) {
  return size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
}

/// A binary tree of boxes, each split at the median along its longest axis.
class PlainTree {
 public:
  explicit PlainTree(std::vector<QueryBox> boxes) : boxes_(std::move(boxes)), items_(boxes_.size()) {
    std::iota(items_.begin(), items_.end(), 0u);
    if (!items_.empty()) build(0, static_cast<std::uint32_t>(items_.size()));
  }

  /// Calls `visit(i)` for every box that `enter(box)` accepts with all boxes above it. Boxes on the side of
  /// the point come first.
  template <class Enter, class Visit>
  void visit(const Vec3d& point, const Enter& enter, const Visit& visit) const {
    if (!nodes_.empty()) visit_node(0, point, enter, visit);
  }

 private:
  struct Node {
    QueryBox box;
    std::uint32_t begin = 0, end = 0;  // in items_
    std::uint32_t right = 0;           // 0 for a leaf; the left child is the next node
    int axis = 0;
  };

  void build(std::uint32_t begin, std::uint32_t end) {
    constexpr std::uint32_t most_in_leaf = 4;
    Node node{boxes_[items_[begin]], begin, end};
    for (std::uint32_t i = begin + 1; i < end; ++i) node.box = united(node.box, boxes_[items_[i]]);
    node.axis = main_axis(node.box.max - node.box.min);
    const std::size_t index = nodes_.size();
    nodes_.push_back(node);
    if (end - begin <= most_in_leaf) return;
    const std::uint32_t middle = begin + (end - begin) / 2;
    std::nth_element(items_.begin() + begin, items_.begin() + middle, items_.begin() + end,
                     [&](std::uint32_t p, std::uint32_t q) {
                       return std::pair(boxes_[p].min[node.axis], p) < std::pair(boxes_[q].min[node.axis], q);
                     });
    build(begin, middle);
    nodes_[index].right = static_cast<std::uint32_t>(nodes_.size());
    build(middle, end);
  }

  template <class Enter, class Visit>
  void visit_node(std::uint32_t index, const Vec3d& point, const Enter& enter, const Visit& visit) const {
    const Node& node = nodes_[index];
    if (!enter(node.box)) return;
    if (node.right == 0) {
      for (std::uint32_t i = node.begin; i < node.end; ++i) {
        if (enter(boxes_[items_[i]])) visit(items_[i]);
      }
      return;
    }
    const bool is_right_first = point[node.axis] > nodes_[node.right].box.min[node.axis];
    visit_node(is_right_first ? node.right : index + 1, point, enter, visit);
    visit_node(is_right_first ? index + 1 : node.right, point, enter, visit);
  }

  std::vector<QueryBox> boxes_;
  std::vector<Node> nodes_;
  std::vector<std::uint32_t> items_;
};

// What the brute forces share: objects, their elements, all pairs of these, and the comparison of lists.

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
  /// Triangles that an edit removed have this vertex, which is not finite.
  std::uint32_t removed_vertex = ~std::uint32_t{0};

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
