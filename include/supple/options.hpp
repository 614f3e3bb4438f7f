#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>
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
/// contacts are the same for all. Searches for continuous contacts and proximity use boxes for the nodes, and
/// boxes or spheres for the objects.
///
/// Volumes other than boxes need `use_comparison_methods`. Oriented boxes and k-DOPs are tested where boxes
/// overlap. They are tighter than boxes, and take more memory and more time to refit and to test.
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
  sweep,   ///< sweep and prune along one axis; needs `use_comparison_methods`
  brute,   ///< every object against every other; needs `use_comparison_methods`
  sweep3,  ///< sweep and prune on three lists that stay sorted (Baraff 1992); needs `use_comparison_methods`
};

/// Kinds of contacts, a set: `ContactKinds::intersection | ContactKinds::continuous`.
enum class ContactKinds : std::uint8_t {
  none = 0,          ///< object pairs and candidate counts only
  intersection = 1,  ///< every pair of triangles that intersects, with normal and points
  /// Every vertex and face and every two edges that touch on their paths within the step. Bodies that already
  /// cut through each other at the start of the step are found by `intersection`, not by `continuous`.
  continuous = 2,
  /// Every two features, or elements, within the margins of their objects at the current positions; see
  /// `ProximityPair`.
  proximity = 4,
  /// What objects that intersect do: vertices inside solids with their depths, and contained parts; with
  /// `SceneOptions::curves` also curves. See `Penetration`, `ContainedPart` and `IntersectionCurve`. It
  /// includes `intersection`.
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

/// The pairs of elements that continuous contacts and proximity search. For proximity, `all` also has edges
/// that cross faces.
enum class ElementKinds : std::uint8_t {
  all,
  vertex_face,  ///< vertices with faces, edges and points
  edge_edge,
};

/// Which continuous contacts are listed.
enum class ContinuousListing : std::uint8_t {
  all,
  /// The first contact of each vertex, edge and face, by time of impact and then in canonical order.
  first,
};

/// Whether triangles of one object that share a vertex id are tested against each other.
enum class Neighbours : std::uint8_t {
  skip,
  /// Intersections of triangles with themselves also find triangles that share a vertex or an edge and meet
  /// elsewhere, as exact arithmetic decides. Two triangles with the same vertices always do.
  exact,
};

/// Options of one object, given when it is added. `Scene::set_options` changes those of `ObjectChanges`.
struct ObjectOptions {
  /// Appears in messages and results; the mesh's name when empty.
  std::string name{};
  /// Also test the object against itself. Triangles that share a vertex id are not tested, unless
  /// `neighbours` is `exact`.
  bool self_collision = false;
  Neighbours neighbours = Neighbours::skip;
  /// Vertices with equal positions when the object is added count as one: the first of them stands for all,
  /// in triangles and in results, and the positions of the others are not read. So a seam that was split for
  /// texture coordinates is no border, and its two sides are neighbours, not contacts. O(n).
  bool weld = false;
  /// The same for chosen vertices: vertex v counts as vertex `same_vertex[v]`, which counts as itself. Empty,
  /// or an id for each vertex. Not together with `weld`.
  std::vector<std::uint32_t> same_vertex{};
  /// Edges and points of no triangle, for example of rods and particles, as vertex ids. They take part in
  /// continuous contacts, proximity, and distances of objects. Other queries and other kinds of contacts read
  /// triangles alone: where a rod passes through a surface, proximity names the place.
  std::vector<std::array<std::uint32_t, 2>> edges{};
  std::vector<std::uint32_t> points{};
  /// The object never moves: it is not tested against other static objects, and moving it is an error.
  bool is_static = false;
  /// Proximity: two objects, or one with itself, are near where their elements come within the sum of their
  /// margins, in the unit of the coordinates. Finite, at least 0.
  double margin = 0;
  /// Continuous contacts: elements of two objects, or of one with itself, touch at a distance of
  /// `ImpactOptions::min_separation` plus this value of both objects. Finite, at least 0.
  double min_separation = 0;
  /// The surface bounds a solid, into which other objects can penetrate. `Scene::add` checks that it is
  /// closed and that its triangles are oriented alike: each edge has as many triangles in one direction as in
  /// the other. A point is inside where a ray from it crosses the surface an odd number of times. The
  /// triangles may face inwards or outwards; see `count_inward_triangles`. While a vertex of a triangle is
  /// not finite, nothing is inside; points on the other triangles are still on the surface.
  bool solid = false;
  /// Two objects are tested when the `group` of each has a bit in common with the `mask` of the other.
  std::uint32_t group = 1;
  std::uint32_t mask = ~std::uint32_t{0};
  /// A number or a pointer of the user; the library does not read it.
  std::uint64_t user_data = 0;
  ObjectOctreeOptions octree{};  ///< shape of the octree; only for comparison
};

/// New values for options of an object that is in a scene; see `Scene::set_options`. An option without a
/// value stays as it is. Options that are not here are fixed when the object is added.
struct ObjectChanges {
  std::optional<bool> self_collision{}, is_static{};
  std::optional<double> margin{}, min_separation{};
  std::optional<std::uint32_t> group{}, mask{};
  std::optional<std::uint64_t> user_data{};
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
  /// For continuous contacts and proximity: the pairs of elements that are searched.
  ElementKinds element_kinds = ElementKinds::all;
  ContinuousListing continuous_listing = ContinuousListing::all;
  /// For penetration and proximity: also a normal, a depth and up to four points for each patch of contacts,
  /// with ids that last from step to step; see `Manifold`. It needs `use_manifolds`. A request with this
  /// option and without these kinds is an error.
  bool manifolds = false;
  /// For penetration: also the curves in which surfaces intersect, each with what it encloses, a normal and a
  /// depth; see `IntersectionCurve`. Takes time in proportion to the contacts and the vertices behind them,
  /// so leave it out where depths of vertices suffice. Manifolds of penetration are made from curves:
  /// `manifolds` includes them. They need `use_manifolds`. A request with it and no penetration is an error.
  bool curves = false;
  /// Worker threads; 0 means one for each core. Fewer work when the system refuses to create them
  /// (supple/threads.hpp). The results are the same for any number.
  std::uint32_t threads = 0;
  ComparisonOptions comparison{};
};

/// The contacts that one call of `Scene::detect` finds, and limits of the call.
struct DetectRequest {
  /// Without a value, these are those of `SceneOptions`.
  std::optional<ContactKinds> contacts{};
  std::optional<ImpactOptions> impact{};
  std::optional<ProximityListing> proximity_listing{};
  std::optional<ElementKinds> element_kinds{};
  std::optional<ContinuousListing> continuous_listing{};
  std::optional<bool> manifolds{};
  std::optional<bool> curves{};
  /// The largest number of contacts of each kind in the result: the first ones in canonical order, for any
  /// number of threads. `DetectResult::truncated` says that there are more. The limit bounds the result and
  /// saves exact tests and memory: each worker holds at most about twice the limit for a pair of objects,
  /// and the search skips pairs after the last reported contact. For first contacts of elements, the limit
  /// shortens the result, not the search, which takes memory for each element that touches. Penetration needs
  /// all intersections: a limit is an error then.
  std::uint64_t max_contacts = std::numeric_limits<std::uint64_t>::max();
#ifdef __cpp_lib_jthread
  /// Any thread can stop the call: it ends within milliseconds during the search, otherwise after the current
  /// stage. The result is then empty and has `stopped` set. The next `detect` gives the same result as
  /// without the stopped call.
  std::stop_token stop{};
#endif
};

/// How a step is shortened; see `Scene::collision_free_step`.
struct StepOptions {
  /// The share of its distance at the start that each pair of elements keeps, 0 to 0.99.
  double keep = 0.2;
};

/// Returns whether a pair of objects may be tested. The scene calls it from one thread, in ascending order,
/// for pairs whose groups and masks agree: `detect` for pairs whose volumes overlap, and for further pairs
/// where a kind of contacts had nothing to test (`DetectResult::untested`), `verify` for all pairs. It must
/// return the same answer within one step.
using PairFilter = std::function<bool(ObjectId, ObjectId)>;

}  // namespace supple
