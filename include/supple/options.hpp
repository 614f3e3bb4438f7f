#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <version>
#ifdef __cpp_lib_jthread
#include <stop_token>
#endif

#include "supple/comparison_options.hpp"
#include "supple/continuous.hpp"
#include "supple/proximity.hpp"
#include "supple/types.hpp"

namespace supple {

/// Shape that encloses the nodes of an object's octree, and the object itself in the broad phase. The
/// contacts are the same for all. With continuous contacts, nodes have boxes, and objects have boxes or
/// spheres.
///
/// Oriented boxes and k-DOPs are tested where boxes overlap. They are tighter than boxes, and take more
/// memory and more time to refit and to test.
enum class BoundingVolume : std::uint8_t {
  aabb,    ///< axis-aligned box
  sphere,  ///< fitted as `SphereFit` says
  /// Box along the principal axes of the surface (Gottschalk, Lin and Manocha 1996). Each refit computes its
  /// axes again.
  obb,
  /// Polytopes with fixed directions (Klosowski et al. 1998): the faces of the box, and planes that cut off
  /// its corners (14), its edges (18), or both (26).
  kdop14,
  kdop18,
  kdop26,
};

/// How object pairs are found. All methods report the same pairs in the same order.
enum class BroadPhaseMethod : std::uint8_t {
  /// Picks octree or grid in each step. The octree runs when fewer than one object in 24 changed in this step
  /// and in each of the three before; otherwise the grid runs. A scene in which more than 256 other objects
  /// share the grid cell of an average object runs the octree, and tries the grid again after 64 steps.
  automatic,
  /// The paper's incremental octree of regions. Best when few objects change, or when many objects are in
  /// few places. `SceneInspector::regions` returns its regions.
  octree,
  /// A hierarchical grid that is rebuilt in each step with changes. Best when many objects change.
  grid,
  sweep,  ///< sweep and prune along one axis
  brute,  ///< every object against every other
};

/// Kinds of contacts, a set: `ContactKinds::intersection | ContactKinds::continuous`.
enum class ContactKinds : std::uint8_t {
  none = 0,          ///< object pairs and candidate counts only
  intersection = 1,  ///< every pair of triangles that intersects, with normal and points
  /// Every vertex and face and every two edges that touch on their way within the step. Bodies that already
  /// cut through each other at the start of the step are found by `intersection`, not by `continuous`.
  continuous = 2,
  /// Every two features, or elements, within the margins of their objects at the current positions; see
  /// `ProximityPair`.
  proximity = 4,
  /// What objects that intersect do: vertices inside solids with their depths, contained parts, and curves;
  /// see `Penetration`, `ContainedPart` and `IntersectionCurve`. It includes `intersection`.
  penetration = 8,
};
constexpr ContactKinds operator|(ContactKinds p, ContactKinds q) {
  return static_cast<ContactKinds>(static_cast<unsigned>(p) | static_cast<unsigned>(q));
}
constexpr ContactKinds& operator|=(ContactKinds& p, ContactKinds q) {
  return p = p | q;
}
/// Whether all of `kinds` are in the set.
constexpr bool contains(ContactKinds set, ContactKinds kinds) {
  return (set | kinds) == set;
}

/// The set with all that its kinds include.
constexpr ContactKinds with_included(ContactKinds set) {
  return contains(set, ContactKinds::penetration) ? set | ContactKinds::intersection : set;
}

/// Options of one object, given when it is added.
struct ObjectOptions {
  /// Appears in messages and results; the mesh's name when empty.
  std::string name{};
  /// Also test the object against itself. Triangles that share a vertex id are never a contact.
  bool self_collision = false;
  /// Vertices with equal positions when the object is added count as one: the first of them stands for all,
  /// in triangles and in results, and the positions of the others are not read. So a seam that was split for
  /// texture coordinates is no border, and its two sides are neighbours, not contacts. O(n).
  bool weld = false;
  /// The object never moves: it is not tested against other static objects, and moving it is an error.
  bool is_static = false;
  /// Proximity: two objects, or one with itself, are near where their elements come within the sum of their
  /// margins, in the unit of the coordinates. Finite, at least 0.
  double margin = 0;
  /// The surface bounds a solid, into which other objects can penetrate. `Scene::add` checks that it is
  /// closed and that its triangles are oriented alike: each edge has as many triangles in one direction as in
  /// the other. A point is inside where a ray from it crosses the surface an odd number of times.
  bool solid = false;
  /// Two objects are tested when the `group` of each has a bit in common with the `mask` of the other.
  std::uint32_t group = 1;
  std::uint32_t mask = ~std::uint32_t{0};
  ObjectOctreeOptions octree{};  ///< shape of the octree; only for comparison
};

/// Options of a scene, fixed at its construction.
struct SceneOptions {
  BoundingVolume bounding_volume = BoundingVolume::aabb;
  BroadPhaseMethod broad_phase = BroadPhaseMethod::automatic;
  SceneOctreeOptions scene_octree{};  ///< only for comparison
  /// The contacts that `detect` finds, unless its request has other kinds.
  ContactKinds contacts = ContactKinds::intersection;
  /// Also report the normal and the points of each contact (`Contact::normal`,
  /// `DetectResult::contact_points`). Without them `detect` takes less time.
  bool contact_points = true;
  /// For continuous contacts: the distance at which elements touch, and whether exact arithmetic decides what
  /// floating point cannot.
  ImpactOptions impact{};
  /// For proximity: what its list contains.
  ProximityListing proximity_listing = ProximityListing::features;
  /// Worker threads; 0 means one for each core. The results are the same for any number.
  std::uint32_t threads = 0;
  ComparisonOptions comparison{};
};

/// The contacts that one call of `Scene::detect` finds, and limits of the call.
struct DetectRequest {
  /// Without a value, these are those of `SceneOptions`.
  std::optional<ContactKinds> contacts{};
  std::optional<ImpactOptions> impact{};
  std::optional<ProximityListing> proximity_listing{};
  /// The largest number of contacts of each kind in the result: the first ones in canonical order, for any
  /// number of threads. `DetectResult::truncated` says that there are more. The limit bounds the memory and
  /// the number of exact tests. The search skips object pairs after the last reported contact, but it
  /// searches one object pair to its end. Proximity pairs are all found first. Penetration needs all
  /// intersections: a limit is an error then.
  std::uint64_t max_contacts = std::numeric_limits<std::uint64_t>::max();
#ifdef __cpp_lib_jthread
  /// Any thread can stop the call: it ends within milliseconds during the search, otherwise after the current
  /// stage. The result is then empty and has `stopped` set. The next `detect` gives the same result as
  /// without the stopped call.
  std::stop_token stop{};
#endif
};

/// Returns whether a pair of objects may be tested. The scene calls it from one thread, in ascending order,
/// for pairs whose groups and masks agree: `detect` for pairs whose volumes overlap, `verify` for all pairs.
/// It must return the same answer within one step.
using PairFilter = std::function<bool(ObjectId, ObjectId)>;

}  // namespace supple
