#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "supple/continuous.hpp"
#include "supple/types.hpp"

namespace supple {

/// Shape that encloses the nodes of an object's octree, and the object itself in the broad phase. Of
/// continuous contacts it is that of the objects alone: nodes in motion have boxes.
enum class BoundingVolume : std::uint8_t { aabb, sphere };

/// How a sphere is fitted to a node.
enum class SphereFit : std::uint8_t {
  /// Centre of the node's box, radius to the farthest vertex (the paper's eq. 5). Conservative.
  vertices,
  /// Centre and radius from the box's longest side L (the paper's eq. 3 and 4). It does not enclose the
  /// corners
  /// of the box, so collisions are missed: for repeating the paper's experiment only.
  box,
};

/// How object pairs are found. All methods report the same pairs in the same order.
enum class BroadPhaseMethod : std::uint8_t {
  /// Picks octree or grid in each step. The octree runs when fewer than one object in 24 changed in this step
  /// and in each of the three before; otherwise the grid runs. A scene in which more than 256 other objects
  /// share the grid cell of an average object runs the octree, and tries the grid again after 64 steps.
  automatic,
  /// The paper's incremental octree of regions. Best when few objects change, or when objects crowd in few
  /// places. It has regions to look at.
  octree,
  /// A hierarchical grid that is made anew in each step with changes. Best when many objects change.
  grid,
  sweep,  ///< sweep and prune along one axis
  brute,  ///< every object against every other
};

/// How a region of the scene octree is tested against a sphere.
enum class RegionSphereTest : std::uint8_t {
  arvo,       ///< closest point of the region (Arvo 1990)
  grown_box,  ///< the paper's: the centre in the region grown by the radius; over-reports near corners
};

/// Which exact stage follows the candidates.
enum class ContactMode : std::uint8_t {
  none,          ///< object pairs and candidate counts only
  intersection,  ///< every intersecting pair of triangles, with its points
  continuous,    ///< every pair of vertex and face, and of two edges, that touches within the step
};

/// Shape of the octree of one object.
struct ObjectOctreeOptions {
  /// Depth below the root at which splitting ends, 0 to 32 (the paper's level-allowed). It counts levels of
  /// eight children whatever the arity: a tree of arity 4 may have half as many levels more (rounded down),
  /// one of arity 2 three times as many, so that no cell is smaller.
  std::uint32_t max_level = 16;
  /// A node with at most this many triangles is not split, ≥ 1. The triangles of two leaves that meet are
  /// tested in vectors, so that small leaves are slower; and they take more memory. With continuous contacts
  /// half as many, unless `regular`.
  std::uint32_t leaf_size = 64;
  /// Children of a node: 8, 4 or 2. A level then halves a node's cell along three axes, two or one, which
  /// take turns. Contacts are the same for all, the paper's colliding vertices are not: the leaves differ.
  /// Nodes are eight lanes wide in any case, so fewer children take more memory and time; for comparison.
  std::uint32_t arity = 8;
  /// Build the paper's regular octree: a node's children are the octants of its cell. Otherwise, and if the
  /// arity is 8, triangles are shared out among children so that leaves are about equally full, which takes
  /// fewer of them. Contacts are the same, the paper's colliding vertices are not: the leaves differ.
  bool regular = false;
  /// Build parts anew when the object has deformed so far from what they were built from that queries cost
  /// too much, and a scene has paid for that often enough. Contacts are the same; for comparison. Never when
  /// a scene gives the paper's colliding vertices or has its spheres, which depend on the leaves.
  bool rebuild_degraded = true;
};

/// Shape of the octree of the scene. Any value but the default is an `Error` when the broad phase is grid,
/// sweep or brute.
struct SceneOctreeOptions {
  /// Depth at which regions no longer expand, 1 to 20; 0 chooses it from the number, the places and the sizes
  /// of the objects. Less far from the origin, where floats cannot tell finer regions apart. It counts levels
  /// of eight children whatever the arity, as `ObjectOctreeOptions::max_level` does.
  std::uint32_t max_level = 0;
  /// A region expands when this many of its objects fit into regions half its edge, ≥ 2 (the paper: 2).
  std::uint32_t expand_at = 2;
  RegionSphereTest region_sphere_test = RegionSphereTest::arvo;
  /// Children of a region: 8, 4 or 2. The pairs found are the same; for comparison.
  std::uint32_t arity = 8;

  constexpr bool operator==(const SceneOctreeOptions&) const = default;
};

/// Of one object, given when it is added.
struct ObjectOptions {
  /// Shown in messages and results; the mesh's name when empty.
  std::string name{};
  /// Also test the object against itself; triangles that share a vertex id are not a contact.
  bool self_collision = false;
  /// Never moves: it is not tested against other static objects, and moving it is an error.
  bool is_static = false;
  /// Two objects are tested when each one's `group` has a bit in common with the other's `mask`.
  std::uint32_t group = 1;
  std::uint32_t mask = ~std::uint32_t{0};
  ObjectOctreeOptions octree{};
};

/// Of a scene, fixed at its construction.
struct SceneOptions {
  BoundingVolume bounding_volume = BoundingVolume::aabb;
  SphereFit sphere_fit = SphereFit::vertices;
  BroadPhaseMethod broad_phase = BroadPhaseMethod::automatic;
  SceneOctreeOptions scene_octree{};
  ContactMode contacts = ContactMode::intersection;
  /// Also give the points of each contact (`DetectResult::contact_points`). Off saves a little time.
  bool contact_points = true;
  /// Of continuous contacts: how near elements come before they touch, and whether exact arithmetic decides
  /// what floating point cannot.
  ImpactOptions impact{};
  /// Also give the paper's output: the vertices in the colliding leaves of both octrees. Not of continuous
  /// contacts.
  bool colliding_vertices = false;
  /// Worker threads, 0 for one a core. The results are the same for any number.
  std::uint32_t threads = 0;
};

/// Says whether a pair may be tested; called from one thread, in ascending order, for pairs whose groups and
/// masks agree: by `detect` for those whose volumes overlap, by `verify` for all. It must answer the same
/// within one step.
using PairFilter = std::function<bool(ObjectId, ObjectId)>;

}  // namespace supple
