#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "supple/mesh.hpp"
#include "supple/options.hpp"
#include "supple/views.hpp"

namespace supple {

struct ChildPair;
struct CollidingVertexLists;
struct ContactJob;
struct IntersectedObject;
class NodeVolumes;
class ObjectOctree;
struct NodePair;
struct ObjectPairView;
struct OctreeTopology;
class PairSearch;
class VertexBuffer;
class World;

/// Methods that only serve comparisons with the defaults. They are in the library supple::comparison.
struct ComparisonMethods {
  /// For all kinds but boxes.
  std::unique_ptr<NodeVolumes> (*node_volumes)(BoundingVolume kind, SphereFit fit, const ObjectOctree& octree,
                                               const PositionsView& rest_positions);
  /// For all builds but the balanced one.
  OctreeTopology (*octree)(const PositionsView& positions, std::span<const Triangle> triangles,
                           std::span<const Vec3d> centers, const ObjectOctreeOptions& options);
  /// For `sweep`, `brute` and `sweep3`.
  std::unique_ptr<PairSearch> (*pair_search)(BroadPhaseMethod method);
  /// For `Descent::one_side_first`: the children of two nodes that overlap, as `overlap_masks`. Adds the
  /// number of tests.
  std::uint64_t (*mask_one_side_first)(const ObjectPairView& pair, const NodePair& nodes,
                                       std::uint64_t& tests);
  /// For `ComparisonOptions::colliding_vertices`: fills the groups and the vertices of empty lists.
  void (*list_colliding_vertices)(std::span<const ContactJob> jobs,
                                  std::span<const IntersectedObject> objects, CollidingVertexLists& lists);

  // For `ComparisonOptions::lazy_refit`:
  /// Computes the volume of the whole object alone; the volumes of nodes are out of date until
  /// `refit_children` computes them. `box`, if any, encloses all vertices, which are then finite. O(n), or
  /// O(1) for a box that is given and no sphere. Returns false when a vertex is not finite; then the volumes
  /// are invalid.
  bool (*refit_object)(ObjectOctree& octree, const VertexBuffer& vertices, const std::optional<Aabb>& box);
  /// After `refit_object`: computes the volumes of the children of a node from the vertices below, unless it
  /// has. Returns the number of triangles that it read.
  std::size_t (*refit_children)(ObjectOctree& octree, std::uint32_t node, const VertexBuffer& vertices);
  /// After `World::refit` of lazy shapes: refits the nodes that a search of these jobs visits. Returns the
  /// number of triangles that it read. The vectors are scratch memory.
  std::uint64_t (*refit_where_objects_meet)(const World& world, std::span<const ContactJob> jobs,
                                            std::vector<NodePair>& node_pairs,
                                            std::vector<ChildPair>& children);
};

/// Any number of threads may set the same methods, which must live until the end.
void set_comparison_methods(const ComparisonMethods& methods);
/// Throws `Error` when no methods were set. `option` names what needs them.
const ComparisonMethods& comparison_methods(const std::string& option);

}  // namespace supple
