#pragma once

#include <array>
#include <cstdint>

#include "supple/types.hpp"

namespace supple {

/// A cell of an object's octree: a lane of a node, to draw or to study. `Scene::octree_cells` gives them.
struct OctreeCell {
  std::uint32_t level = 0;  ///< the root is 0
  bool is_leaf = true;
  std::uint32_t triangle_count = 0;
  Aabb box{};               ///< round the triangles where they are now
  BoundingSphere sphere{};  ///< empty unless the scene's bounding volume is the sphere
};

/// Two triangles that the narrow phase hands to the exact stage, the user's numbers. Within one object
/// `object_a == object_b` and `triangle_a < triangle_b`.
struct CandidatePair {
  ObjectId object_a, object_b;
  std::uint32_t triangle_a = 0, triangle_b = 0;
  constexpr auto operator<=>(const CandidatePair&) const = default;
};

/// The stage that told two triangles apart, in the order of the flow. Of continuous contacts: told them apart
/// all the way; elements that two triangles own touch on their own account, so that `contact` comes before
/// all but the first.
enum class PairStage : std::uint8_t {
  not_tested,  ///< the scene does not test these objects: static, group and mask, filter, no self-collision
  shared_vertex,   ///< of one object, with a common vertex (or one and the same): never a contact
  inert,           ///< a corner is not a finite number
  object_volumes,  ///< the volumes of the objects are apart: the broad phase
  octree_volumes,  ///< volumes of two octree cells are apart: the narrow phase
  triangle_boxes,  ///< the boxes of the triangles are apart: the leaves
  exact_test,      ///< the triangles themselves are apart
  contact,         ///< they are not apart: a contact
};

/// Why two triangles are, or are not, a contact (`Scene::explain`); with `ContactKinds::none`, whether they
/// would be.
struct PairExplanation {
  PairStage stage = PairStage::contact;
  /// The two volumes that are apart: of the objects, of octree cells, of the triangles; empty for other
  /// stages. They are of the present positions; of continuous contacts those of objects hold the whole way.
  /// Rounded outward to floats, so that far from the origin they may seem to meet.
  Aabb box_a{}, box_b{};
  BoundingSphere sphere_a{}, sphere_b{};   ///< not empty when spheres, not boxes, told them apart
  std::uint32_t level_a = 0, level_b = 0;  ///< of those cells
  /// At `exact_test` the direction from a to b, of unit length, between the points where the triangles are
  /// closest, and their distance: rounded; where rounding leaves none it is 0, and the direction one that
  /// separates them as well as rounding lets it. At `object_volumes`, `octree_volumes` and `triangle_boxes`
  /// the coordinate axis from a to b along which the boxes are furthest apart, or the direction between the
  /// centres of spheres, and by how much. Of continuous contacts, where these are at the end of the step;
  /// both zero for triangles that meet there: they did so all the time.
  Vec3d axis{};
  double distance = 0;
};

}  // namespace supple
