#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <utility>
#include <vector>

#include "core/parallel.hpp"
#include "supple/contact.hpp"
#include "supple/mesh.hpp"
#include "world/object/vertex_groups.hpp"

// What the brute forces of continuous contacts and of proximity share: all elements, and all pairs of them.
namespace supple {

/// The input of the brute force: positions at both ends of the step and triangles with the user's ids.
struct PlainMovingObject {
  std::vector<Vec3d> start, end;
  std::vector<Triangle> triangles;
  VertexGroups groups{};
  /// Triangles from here on are edges and points of no triangle, with the last vertex repeated.
  std::size_t face_count = triangles.size();
};

/// A vertex, edge or face: its vertices, its ids, and its exact boxes at both ends of the step.
struct BoxedElement {
  std::array<std::uint32_t, 3> vertices;
  std::array<std::uint32_t, 2> name;
  FeatureKind kind;
  double start_min[3], start_max[3], end_min[3], end_max[3];

  double sweep_min() const { return std::min(start_min[0], end_min[0]); }
  double sweep_max() const { return std::max(start_max[0], end_max[0]); }
};

/// `faces` also has the edges and points of no triangle.
struct BoxedElements {
  std::vector<BoxedElement> vertices, edges, faces;
};

// Vertices that no triangle uses, and elements with a coordinate that is not finite, are left out.
std::vector<BoxedElement> boxed_faces(const PlainMovingObject& object);
BoxedElements boxed_elements(const PlainMovingObject& object);

/// The number of vertex-face, face-vertex and edge-edge pairs; within one object, each pair once.
std::uint64_t element_pairs(const BoxedElements& a, const BoxedElements& b, bool same_object);

/// Whether p and q are farther apart than the separation along some axis, on the same side at both ends. The
/// factor exceeds the rounding of the differences.
bool stay_apart(const BoxedElement& p, const BoxedElement& q, double separation);

bool share_vertex(const BoxedElement& p, const BoxedElement& q);

inline bool may_touch_by_groups(const PlainMovingObject& a, const BoxedElement& p, const PlainMovingObject& b,
                                const BoxedElement& q) {
  return may_touch_by_groups(a.groups, p.vertices, b.groups, q.vertices);
}

/// Elements of b sorted by their least x. `reach` is, for each, the greatest x of the elements up to it:
/// where that is less than the least x of another element, none of the elements up to here comes near it.
struct Sweep {
  std::vector<BoxedElement> elements;
  std::vector<double> reach;

  explicit Sweep(std::vector<BoxedElement> unsorted);
};

/// Calls `decide(p, q)` for all pairs of elements that may come within `separation` of each other within the
/// step, on all workers, and appends what it returns: an optional value. Within one object, leaves out pairs
/// that share a vertex, and takes pairs of edges once, the smaller one first.
template <class Found, class Decide>
void decide_all(const std::vector<BoxedElement>& a, const Sweep& b, bool same_object, bool are_edges,
                double separation, const Parallel& parallel, Decide&& decide, std::vector<Found>& found) {
  std::vector<std::vector<Found>> parts(parallel.worker_count());
  const double margin = separation * (1 + 0x1p-50);
  parallel.for_ranges(a.size(), 64, [&](std::size_t begin, std::size_t end, std::uint32_t worker) {
    for (std::size_t i = begin; i < end; ++i) {
      const BoxedElement& p = a[i];
      // Widened by more than the sums can lose.
      const double slack = (std::abs(p.sweep_min()) + std::abs(p.sweep_max()) + margin) * 0x1p-50;
      const double low = p.sweep_min() - margin - slack, high = p.sweep_max() + margin + slack;
      const auto first = std::lower_bound(b.reach.begin(), b.reach.end(), low) - b.reach.begin();
      for (auto q = b.elements.begin() + first; q != b.elements.end() && q->sweep_min() <= high; ++q) {
        if (same_object && share_vertex(p, *q)) continue;
        if (same_object && are_edges && q->name <= p.name) continue;
        if (stay_apart(p, *q, separation)) continue;
        if (auto result = decide(p, *q)) parts[worker].push_back(std::move(*result));
      }
    }
  });
  for (auto& part : parts) std::move(part.begin(), part.end(), std::back_inserter(found));
}

}  // namespace supple
