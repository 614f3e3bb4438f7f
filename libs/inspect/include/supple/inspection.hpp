#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "supple/result.hpp"
#include "supple/types.hpp"

namespace supple {

class Scene;

/// A cell of an object's octree: a node of the paper, A(h, k).
struct OctreeCell {
  std::uint32_t level = 0;  ///< nodes above it; the root is 0
  /// h: the root is 0, and the children of h are mh + 1 … mh + m in a tree of arity m. In a regular octree
  /// they are the octants of the cube around the centres of the triangles in the rest pose, also those
  /// without triangles: bit 0 of a child is the upper half in x, bit 1 in y, bit 2 in z. In other trees, the
  /// children that exist have the first numbers. Empty when the number does not fit into 64 bits, which is
  /// possible below level 20 of an octree (31 with arity 4, 62 with arity 2).
  std::optional<std::uint64_t> number = 0;
  /// k: the level of h. It is more than `level` below a node of a regular octree whose triangles are all in
  /// one octant: the node shrinks to this octant. It equals `level` when there is no number.
  std::uint32_t number_level = 0;
  bool is_leaf = true;
  std::uint32_t triangle_count = 0;
  Aabb box{};               ///< encloses the triangles at their present positions
  BoundingSphere sphere{};  ///< empty unless the scene's bounding volume is the sphere
  /// The oriented box (three slabs, along its axes) or the k-DOP (k / 2 slabs) as the intersection of slabs;
  /// empty for other bounding volumes, and with continuous contacts.
  std::vector<Slab> slabs{};
};

/// Two triangles that the narrow phase passes to the exact stage, as the user's numbers. Within one object,
/// `object_a == object_b` and `triangle_a < triangle_b`.
struct CandidatePair {
  ObjectId object_a, object_b;
  std::uint32_t triangle_a = 0, triangle_b = 0;
  constexpr auto operator<=>(const CandidatePair&) const = default;
};

/// The first candidates of a step, and the number of all.
struct CandidateList {
  std::vector<CandidatePair> pairs;  ///< sorted
  std::uint64_t total = 0;
};

/// The descent of the narrow phase into the octrees of two objects, as a list of pairs by level (Figure 4 of
/// the paper). Pair (A(h, k) of object a, A(h, k) of object b) is in the list when the volumes of both nodes
/// overlap, and so do those of all their ancestors. The descent takes one level of both octrees at a time. A
/// leaf stays while the other side descends, so the nodes of a pair of a level have this
/// `OctreeCell::level`, or one is a leaf above it.
struct NodePairList {
  /// Two nodes that collide, one of each object.
  struct Pair {
    std::uint32_t a = 0, b = 0;  ///< places in `nodes_a` and `nodes_b`
    constexpr auto operator<=>(const Pair&) const = default;
  };
  /// The nodes of each object that collide, each once, by level and in the order of the octree. For one
  /// object with itself, both lists are of this object.
  std::vector<OctreeCell> nodes_a, nodes_b;
  std::vector<Pair> pairs;  ///< level by level; within a level ascending
  /// First pair of each level, then the number of pairs. Level k is [level_begin[k], level_begin[k + 1]).
  std::vector<std::size_t> level_begin{0};

  std::uint32_t level_count() const { return static_cast<std::uint32_t>(level_begin.size() - 1); }
  std::span<const Pair> pairs_of(std::uint32_t level) const {
    return std::span(pairs).subspan(level_begin[level], level_begin[level + 1] - level_begin[level]);
  }
  bool is_leaf_pair(const Pair& pair) const { return nodes_a[pair.a].is_leaf && nodes_b[pair.b].is_leaf; }
};

/// The stage that separated two triangles, in the order of the stages. With continuous contacts, a stage
/// separates the triangles for the whole step. Their elements are tested separately, so `contact` then takes
/// precedence over every stage except the first.
enum class PairStage : std::uint8_t {
  /// The scene does not test these objects (static, group and mask, filter, no self-collision) or these
  /// triangles (groups of vertices).
  not_tested,
  /// Both in one object, with a common vertex, or the same triangle: no contact, unless
  /// `Neighbours::exact` finds that they also meet elsewhere.
  shared_vertex,
  inert,           ///< a corner is not a finite number
  object_volumes,  ///< the volumes of the objects are apart: the broad phase
  octree_volumes,  ///< the volumes of two octree cells are apart: the narrow phase
  triangle_boxes,  ///< the boxes of the triangles are apart: the leaves
  exact_test,      ///< the triangles are apart: the exact stage
  contact,         ///< the triangles intersect: a contact
};

/// Why two triangles are a contact, or why not. With `ContactKinds::none`: whether they would be a contact.
struct PairExplanation {
  PairStage stage = PairStage::contact;
  /// The two volumes that are apart: of the objects, of octree cells or of the triangles. Empty for the other
  /// stages. They enclose the present positions; with continuous contacts, the volumes of objects enclose the
  /// whole path. They are rounded outward to floats, so they may seem to overlap far from the origin.
  Aabb box_a{}, box_b{};
  BoundingSphere sphere_a{}, sphere_b{};  ///< not empty when spheres, not boxes, are apart
  /// Not empty when oriented boxes or k-DOPs are apart, although their boxes overlap; see
  /// `OctreeCell::slabs`.
  std::vector<Slab> slabs_a{}, slabs_b{};
  /// The names of the octree cells: `OctreeCell::number_level` and `number`.
  std::uint32_t level_a = 0, level_b = 0;
  std::optional<std::uint64_t> number_a = 0, number_b = 0;
  /// At `exact_test`: the unit direction from a to b between the closest points of the triangles, and their
  /// distance, both rounded as in `ElementDistance`.
  /// At `object_volumes`, `octree_volumes` and `triangle_boxes`: the coordinate axis from a to b along which
  /// the boxes are furthest apart, the direction between the centers of the spheres, or that of the slabs
  /// that are furthest apart (for oriented boxes also the cross product of two axes), and the gap along it.
  /// With continuous contacts both are taken at the end of the step, and both are zero for triangles that
  /// intersect there because they did so from the start.
  Vec3d axis{};
  double distance = 0;
};

/// Statistics of an object's octree.
struct OctreeStatistics {
  std::uint64_t triangles = 0;
  std::uint64_t vertices = 0;
  std::uint64_t nodes = 0;  ///< nodes of up to eight children
  std::uint64_t leaves = 0;
  std::uint32_t depth = 0;         ///< of the deepest leaf; the root is 0
  std::uint32_t largest_leaf = 0;  ///< triangles
  double mean_leaf_size = 0;       ///< triangles
  double mean_node_width = 0;      ///< children per node, at most eight
  std::uint64_t bytes = 0;         ///< all memory of the octree: nodes, ids and maps, without the positions
  double bytes_per_triangle = 0;
  std::vector<std::uint64_t> leaves_by_level;
  /// Expected visits of a query whose box overlaps the object's box, by the surface-area heuristic: one visit
  /// per child and an eighth per triangle of a leaf. Computed for the volumes of the last refit: those of
  /// `SceneOptions::bounding_volume`, or boxes when the object is on a path. 0 when they have no surface.
  double cost = 0;
  /// The cost by boxes divided by that cost when the octree was built: 2 when queries cost twice as much.
  double degradation = 1;
  std::uint64_t rebuilds = 0;  ///< since the object was added
};

/// The edges of the intersection of slabs, for drawing the `slabs` of a cell. Computed in double and rounded;
/// none when a slab of a box is infinite.
std::vector<std::array<Vec3d, 2>> edges_of(std::span<const Slab> slabs);

/// Looks into a scene and its last `detect`, for drawing, learning and tests. When that call found several
/// kinds of contacts, cells and candidates are those of the first search of these: intersections (also for
/// penetration), continuous contacts, proximity. The inspector refers to the scene, which must outlive it and
/// must not be moved. It keeps no memory. Each call allocates memory and uses one thread.
///
/// `cells`, `leaf`, `node_pairs`, `candidates` and `explain` throw `Error` when something changed since the
/// last `detect` (for `cells`: when the object moved).
class SceneInspector {
 public:
  /// Refers to the scene, O(1).
  explicit SceneInspector(const Scene& scene) : scene_(&scene) {}

  /// The cells of an object's octree at `level` and the leaves above it, which together cover the object.
  /// Without a level: all leaves. Ordered by level. Cells enclose the triangles at their present positions,
  /// rounded outward; for an object on a path, at the end of the step. Cells without a finite triangle are
  /// empty.
  std::vector<OctreeCell> cells(ObjectId object, std::optional<std::uint32_t> level = {}) const;
  /// The leaf that contains a triangle. O(octree depth). Throws `Error` when the triangle is out of range.
  OctreeCell leaf(ObjectId object, std::uint32_t triangle) const;
  /// The pairs of nodes that the narrow phase finds colliding, of two objects, or of one object with itself.
  /// Empty when the last `detect` did not compare the octrees: the broad phase or a filter excludes the pair,
  /// or the object's self-collision is off. Includes pairs that `detect` skips, as `candidates` does.
  /// O(pairs log pairs) time and memory.
  NodePairList node_pairs(ObjectId object_a, ObjectId object_b) const;
  /// The deepest level with cells; 0 for an object without triangles, which has no cell.
  std::uint32_t octree_depth(ObjectId object) const;
  /// Statistics of an object's octree, O(nodes).
  OctreeStatistics octree_statistics(ObjectId object) const;
  /// The box of the object in the last `detect`; empty when no vertex is finite.
  Aabb bounds(ObjectId object) const;
  /// Regions of the scene octree in the last step, root first; empty when another method ran.
  std::vector<SceneRegion> regions() const;
  /// The leaf regions that contain an object, ascending by number; O(placements of all objects).
  std::vector<SceneRegion> regions(ObjectId object) const;

  /// The pairs of triangles that the narrow phase passes to the exact stage: the first `limit` pairs and
  /// their total number. They include pairs that `detect` skips: of two objects that both have not moved, and
  /// in parts of an object that self-collision culling skips. With continuous contacts, they are triangles
  /// whose moving boxes come within `ImpactOptions::min_separation` or slightly more. Pairs that share a
  /// vertex are left out, although their elements are tested. As fast as `detect` with one thread; O(limit)
  /// memory.
  CandidateList candidates(std::size_t limit) const;
  /// Why two triangles are a contact of the last `detect`, or which stage separated them. Calls the pair
  /// filter. Continuous contacts and near pairs that a truncated result leaves out do not count. O(octree
  /// depth), and for these O(contacts of the objects). Throws `Error` when a triangle is out of range.
  PairExplanation explain(ObjectId object_a, std::uint32_t triangle_a, ObjectId object_b,
                          std::uint32_t triangle_b) const;

  /// Checks every invariant of every octree and of the broad phase. Returns an empty string, or a description
  /// of the first error.
  std::string validate() const;

 private:
  const Scene* scene_;
};

}  // namespace supple
