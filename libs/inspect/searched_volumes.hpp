#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "geometry/aabb.hpp"
#include "narrow_phase/traversal.hpp"
#include "octree/octree_topology.hpp"
#include "octree/volumes/moving_boxes.hpp"
#include "scene/scene_implementation.hpp"
#include "supple/types.hpp"

namespace supple {

/// The inside of a scene that is as in its last `detect`. Throws an error when it is not.
inline const auto& detected(const Scene& scene, const char* call) {
  const auto& inside = SceneAccess::of(scene);
  if (inside.is_current()) return inside;
  fail(std::string(call) + ": nothing was detected at the present positions; call detect first");
}

/// The pair as the narrow phase sees it, without self-collision culling.
ObjectPairView search_view(const World& world, const Question& question, const ContactJob& job);

/// Swept boxes are clamped to the range of float. A bound at the end of the range stands for infinity.
inline Aabb unclamped(const Aabb& box) {
  constexpr float greatest = std::numeric_limits<float>::max(), inf = std::numeric_limits<float>::infinity();
  Aabb result = box;
  for (int axis = 0; axis < 3; ++axis) {
    if (box.min[axis] == -greatest) result.min[axis] = -inf;
    if (box.max[axis] == greatest) result.max[axis] = inf;
  }
  return result;
}

/// The box of a child's triangles at the current positions, with continuous contacts at the end of the step,
/// without the view's translation.
inline Aabb child_box(const OctreeView& view, std::uint32_t node, int child) {
  const bool is_moving = view.moving.start != nullptr;
  return is_moving ? unclamped(child_box(view.moving.end[node], child)) : child_box(view.boxes[node], child);
}
/// Without the view's translation; empty for other volumes.
inline BoundingSphere child_sphere(const OctreeView& view, std::uint32_t node, int child) {
  return view.volumes == nullptr ? BoundingSphere{} : view.volumes->sphere(node, child);
}

/// The oriented box or k-DOP of a child, and of the whole object, where the object is now; empty for other
/// volumes.
inline std::vector<Slab> child_slabs(const OctreeView& view, std::uint32_t node, int child) {
  if (view.volumes == nullptr) return {};
  return view.volumes->slabs(node, child, child_box(view.boxes[node], child), view.translation);
}
inline std::vector<Slab> object_slabs(const OctreeView& view) {
  if (view.volumes == nullptr) return {};
  return view.volumes->slabs(view.volumes->object(), 0, enclosing_box(view.boxes[0]), view.translation);
}

/// Whether the octree is a single leaf. Its only cell is then the root.
inline bool is_one_leaf(const OctreeView& view) {
  return !view.nodes.empty() && view.nodes[0].child_count == 1;
}

/// The level of the children of a node.
inline std::uint32_t cell_level(const OctreeView& view, std::uint32_t node) {
  return is_one_leaf(view) ? 0 : view.nodes[node].level + 1u;
}

/// `OctreeCell::number` of a child: h of the paper.
inline std::optional<std::uint64_t> cell_number(const OctreeView& view, std::uint64_t arity,
                                                std::uint32_t node, int child) {
  if (is_one_leaf(view)) return 0;
  if (!view.cell_numbers.empty()) {
    const std::uint64_t number =
        view.cell_numbers[std::size_t{node} * node_width + static_cast<std::size_t>(child)];
    return number == no_number ? std::nullopt : std::optional(number);
  }
  const OctreeNode& of = view.nodes[node];
  const auto parent = node == 0 ? 0 : cell_number(view, arity, of.parent, of.index_in_parent);
  constexpr std::uint64_t most = std::numeric_limits<std::uint64_t>::max();
  if (!parent || *parent > (most - arity) / arity) return std::nullopt;
  return arity * *parent + 1 + static_cast<std::uint64_t>(child);
}

/// `OctreeCell::number_level` of a child with this number: k of the paper.
inline std::uint32_t number_level(const OctreeView& view, std::uint64_t arity, std::uint32_t node,
                                  std::optional<std::uint64_t> number) {
  if (!number) return cell_level(view, node);
  std::uint32_t level = 0;
  for (std::uint64_t above = *number; above != 0; above = (above - 1) / arity) ++level;
  return level;
}

/// The boxes of a moving face at both ends of the step, not yet grown or moved; empty when it is inert.
inline std::array<Aabb, 2> moving_face_boxes(const MovingView& view, std::uint32_t face) {
  std::array<Aabb, 2> boxes;
  for (const std::uint32_t vertex : view.face_ids[face]) {
    if (view.inert != nullptr && view.inert[vertex] != 0) return {};
    for (const bool at_end : {false, true}) {
      const VertexCorners& corners = at_end ? view.end_corners : view.start_corners;
      const float* const low = corners.lower + vertex * corners.step;
      const float* const high = corners.upper + vertex * corners.step;
      extend(boxes[at_end ? 1 : 0], Aabb{{low[0], low[1], low[2]}, {high[0], high[1], high[2]}});
    }
  }
  return boxes;
}

/// Whether one face stays on one side of the other along some axis, by more than the separation, at both ends
/// of the step and therefore at all times. Faces are in octree order.
inline bool moving_faces_apart(const ObjectPairView& pair, TrianglePair faces) {
  const auto [start_a, end_a] = moving_face_boxes(pair.a.moving, faces.a);
  const auto [start_b, end_b] = moving_face_boxes(pair.b.moving, faces.b);
  const double separation = pair.separation;
  if (start_a.empty() || start_b.empty()) return true;
  for (int axis = 0; axis < 3; ++axis) {
    const double offset = pair.placement.offset[axis];
    const auto below = [&](const Aabb& low, const Aabb& high, double offset_of_high) {
      return double{high.min[axis]} + offset_of_high - low.max[axis] > separation;
    };
    if (below(start_a, start_b, offset) && below(end_a, end_b, offset)) return true;
    if (below(start_b, start_a, -offset) && below(end_b, end_a, -offset)) return true;
  }
  return false;
}

}  // namespace supple
