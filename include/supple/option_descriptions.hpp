#pragma once

#include <vector>

#include "supple/broad_phase.hpp"
#include "supple/continuous.hpp"
#include "supple/description.hpp"
#include "supple/options.hpp"

// Descriptions of the options of the core (description.hpp).

namespace supple {

template <>
inline constexpr std::array words<BoundingVolume>{"aabb", "sphere", "obb", "kdop14", "kdop18", "kdop26"};
template <>
inline constexpr std::array words<ObjectOctreeBuild>{"balanced", "regular", "bottom_up"};
template <>
inline constexpr std::array words<SphereFit>{"vertices", "minimal", "medial", "box"};
template <>
inline constexpr std::array words<BroadPhaseMethod>{"automatic", "octree", "grid",
                                                    "sweep",     "brute",  "sweep3"};
template <>
inline constexpr std::array words<RegionSphereTest>{"arvo", "grown_box"};
template <>
inline constexpr std::array words<Descent>{"both_sides", "one_side_first"};
template <>
inline constexpr std::array set_words<ContactKinds>{"none", "intersection", "continuous", "proximity",
                                                    "penetration"};
template <>
inline constexpr std::array words<ContactKinds> = detail::words_of_sets<ContactKinds>();
template <>
inline constexpr std::array words<ProximityListing>{"features", "elements"};
template <>
inline constexpr std::array words<ElementKinds>{"all", "vertex_face", "edge_edge"};
template <>
inline constexpr std::array words<ContinuousListing>{"all", "first"};
template <>
inline constexpr std::array words<Neighbours>{"skip", "exact"};

template <>
struct Description<ImpactOptions> {
  static constexpr const char* name = "ImpactOptions";
  static constexpr void visit(auto&& visitor) {
    using Options = ImpactOptions;
    visitor(
        Field<Options, double>{.name = "min_separation",
                               .member = &Options::min_separation,
                               .doc = "Continuous contacts: distance at which two elements count as touching",
                               .range = ValueRange::from(0),
                               .unit = "length"});
    visitor(
        Field<Options, bool>{.name = "exact",
                             .member = &Options::exact,
                             .doc = "Continuous contacts that floating point cannot decide: exact arithmetic "
                                    "decides them (exact), or they are reported as within tolerance (report)",
                             .key = "undecided",
                             .truth_words = {"report", "exact"}});
    visitor(Field<Options, double>{
        .name = "max_time",
        .member = &Options::max_time,
        .doc = "Continuous contacts: leave out those later in the step, which is from 0 to 1",
        .range = ValueRange::from(0, 1)});
    visitor(Field<Options, bool>{
        .name = "skip_parting",
        .member = &Options::skip_parting,
        .doc =
            "Continuous contacts: leave out elements that are within the separation at the start and part"});
  }
};

template <>
struct Description<ObjectOctreeOptions> {
  static constexpr const char* name = "ObjectOctreeOptions";
  static constexpr void visit(auto&& visitor) {
    using Options = ObjectOctreeOptions;
    visitor(Field<Options, std::uint32_t>{.name = "max_level",
                                          .member = &Options::max_level,
                                          .doc = "Deepest level of the object's octree; the root is level 0",
                                          .range = ValueRange::from(0, 32)});
    visitor(Field<Options, std::uint32_t>{
        .name = "leaf_size",
        .member = &Options::leaf_size,
        .doc = "A node with at most this many triangles is not split; half as many with continuous contacts "
               "or proximity",
        .range = ValueRange::from(1, 0xffffffff),
        .unit = "triangles"});
    visitor(Field<Options, std::uint32_t>{.name = "arity",
                                          .member = &Options::arity,
                                          .doc = "Children of a node of the object's octree",
                                          .range = ValueRange::from(2, 8).only_powers_of_two(),
                                          .key = "tree_arity"});
    visitor(Field<Options, ObjectOctreeBuild>{
        .name = "build",
        .member = &Options::build,
        .doc = "How the object's octree is built: with equally full leaves (balanced), from the octants of "
               "each cell as in the paper (regular), or by merging neighbours (bottom-up)",
        .key = "object_octree"});
    visitor(Field<Options, bool>{
        .name = "rebuild_degraded",
        .member = &Options::rebuild_degraded,
        .doc = "Rebuild the object's octree when it has become slow because the object deformed"});
  }
};

template <>
struct Description<SceneOctreeOptions> {
  static constexpr const char* name = "SceneOctreeOptions";
  static constexpr void visit(auto&& visitor) {
    using Options = SceneOctreeOptions;
    visitor(Field<Options, std::uint32_t>{
        .name = "max_level",
        .member = &Options::max_level,
        .doc = "Deepest level of the scene octree; 0 means the largest possible level, 20",
        // A 64-bit number can distinguish the regions of at most 20 levels.
        .range = ValueRange::from(0, 20),
        .key = "scene_octree_max_level"});
    visitor(Field<Options, std::uint32_t>{
        .name = "expand_at",
        .member = &Options::expand_at,
        .doc = "A region of the scene octree expands when this many of its objects fit into regions of half "
               "its edge; 0 means 2 for scenes of up to 64 objects, otherwise 96",
        .range = ValueRange::from(2, 0xffffffff).or_zero(),
        .unit = "objects",
        .key = "scene_octree_expand_at"});
    visitor(Field<Options, RegionSphereTest>{.name = "region_sphere_test",
                                             .member = &Options::region_sphere_test,
                                             .doc = "Test of a region of the scene octree against a sphere: "
                                                    "Arvo's test, or the test of the paper (grown box)",
                                             .key = "region_test"});
    visitor(Field<Options, bool>{
        .name = "expand_for_large_objects",
        .member = &Options::expand_for_large_objects,
        .doc =
            "Count all objects of a region, also those that dividing it cannot separate (the paper's Figure "
            "2); needs a deepest level from 1 to 6",
        .key = "scene_octree_expand_for_large",
        .truth_words = {"off", "on"}});
    visitor(Field<Options, std::uint32_t>{.name = "min_level",
                                          .member = &Options::min_level,
                                          .doc =
                                              "Regions above this level of the scene octree always expand; "
                                              "1 in the paper",
                                          .range = ValueRange::from(0, most_full_levels),
                                          .key = "scene_octree_min_level"});
    visitor(Field<Options, std::uint32_t>{.name = "arity",
                                          .member = &Options::arity,
                                          .doc = "Children of a region of the scene octree",
                                          .range = ValueRange::from(2, 8).only_powers_of_two(),
                                          .key = "scene_octree_arity"});
    visitor(Field<Options, std::optional<RootCube>>{
        .name = "root",
        .member = &Options::root,
        .doc = "Root region of the scene octree, a cube; without a value it is fitted to the objects",
        .unit = "length",
        .key = "scene_octree_root"});
  }
};

template <>
struct Description<ObjectOptions> {
  static constexpr const char* name = "ObjectOptions";
  static constexpr void visit(auto&& visitor) {
    using Options = ObjectOptions;
    visitor(Field<Options, std::string>{.name = "name",
                                        .member = &Options::name,
                                        .doc = "Name of the object in tables, messages and results"});
    visitor(Field<Options, bool>{.name = "self_collision",
                                 .member = &Options::self_collision,
                                 .doc = "Also test the object against itself",
                                 .key = "self"});
    visitor(Field<Options, Neighbours>{
        .name = "neighbours",
        .member = &Options::neighbours,
        .doc = "Triangles of one object that share a vertex: not tested (skip), or tested for intersection "
               "beyond what they share (exact)"});
    visitor(Field<Options, bool>{.name = "weld",
                                 .member = &Options::weld,
                                 .doc = "Vertices with equal positions count as one, so that a seam that was "
                                        "split for texture coordinates is no border"});
    visitor(Field<Options, bool>{
        .name = "is_static",
        .member = &Options::is_static,
        .doc = "The object never moves; static objects are not tested against each other",
        .key = "static"});
    visitor(Field<Options, double>{
        .name = "margin",
        .member = &Options::margin,
        .doc = "Proximity: two objects are near where they come within the sum of their margins",
        .range = ValueRange::from(0),
        .unit = "length"});
    visitor(Field<Options, double>{
        .name = "min_separation",
        .member = &Options::min_separation,
        .doc = "Continuous contacts: added to the minimum separation, for each of two objects",
        .range = ValueRange::from(0),
        .unit = "length"});
    visitor(Field<Options, bool>{
        .name = "solid",
        .member = &Options::solid,
        .doc = "Penetration: the object is solid, so that vertices can be inside it; its surface must be "
               "closed and oriented alike"});
    visitor(Field<Options, std::uint32_t>{
        .name = "group",
        .member = &Options::group,
        .doc = "Two objects are tested when the group of each has a bit in common with the mask of the other",
        .range = ValueRange::from(0, 0xffffffff)});
    visitor(Field<Options, std::uint32_t>{.name = "mask",
                                          .member = &Options::mask,
                                          .doc = "Groups, as bits, with which the object is tested",
                                          .range = ValueRange::from(0, 0xffffffff)});
    visitor(Field<Options, ObjectOctreeOptions>{
        .name = "octree", .member = &Options::octree, .doc = "Shape of the object's octree"});
  }
};

template <>
struct Description<ComparisonOptions> {
  static constexpr const char* name = "ComparisonOptions";
  static constexpr void visit(auto&& visitor) {
    using Options = ComparisonOptions;
    visitor(Field<Options, SphereFit>{.name = "sphere_fit",
                                      .member = &Options::sphere_fit,
                                      .doc = "How spheres are fitted: around the middle of the box up to "
                                             "the farthest vertex (vertices), as small as possible "
                                             "(minimal), on the medial axis (medial), or from the box by "
                                             "the paper's eq. 3 and 4, which misses contacts (box)"});
    visitor(Field<Options, bool>{
        .name = "colliding_vertices",
        .member = &Options::colliding_vertices,
        .doc = "Also report the paper's output: the vertices in the colliding leaves of both octrees"});
    visitor(Field<Options, Descent>{
        .name = "descent",
        .member = &Options::descent,
        .doc =
            "Order in which the children of two nodes are compared: all with all (both sides), or first the "
            "children of one node with the other node, as in the paper's Figure 4 (one side first)"});
    visitor(Field<Options, bool>{
        .name = "lazy_refit",
        .member = &Options::lazy_refit,
        .doc = "Refit below the root of an object only the nodes where it may collide with another object",
        .truth_words = {"off", "on"}});
  }
};

template <>
struct Description<SceneOptions> {
  static constexpr const char* name = "SceneOptions";
  static constexpr void visit(auto&& visitor) {
    using Options = SceneOptions;
    visitor(Field<Options, BoundingVolume>{
        .name = "bounding_volume",
        .member = &Options::bounding_volume,
        .doc = "Shape that encloses the objects and the nodes of their octrees"});
    visitor(Field<Options, BroadPhaseMethod>{
        .name = "broad_phase",
        .member = &Options::broad_phase,
        .doc = "How object pairs are found; all methods find the same pairs"});
    visitor(Field<Options, SceneOctreeOptions>{
        .name = "scene_octree", .member = &Options::scene_octree, .doc = "Shape of the scene octree"});
    visitor(Field<Options, ContactKinds>{
        .name = "contacts",
        .member = &Options::contacts,
        .doc =
            "Contacts to find: pairs of triangles that intersect (intersection); vertices and faces, and "
            "pairs of edges, that touch on their paths from the frame before (continuous); pairs within the "
            "margins of their objects (proximity); vertices inside solid objects, contained parts and curves "
            "of intersection (penetration, which includes intersection); several of these with commas "
            "between them; or none. Bodies that already cut through each other at the start of the paths are "
            "found by intersection, not by continuous"});
    visitor(Field<Options, bool>{.name = "contact_points",
                                 .member = &Options::contact_points,
                                 .doc = "Compute the normal and the points of each contact of triangles"});
    visitor(Field<Options, ImpactOptions>{
        .name = "impact", .member = &Options::impact, .doc = "Options of continuous contacts"});
    visitor(Field<Options, ProximityListing>{
        .name = "proximity_listing",
        .member = &Options::proximity_listing,
        .doc = "Proximity: list each pair of closest features once (features), or every vertex and face and "
               "every two edges within the margins (elements)"});
    visitor(Field<Options, ElementKinds>{
        .name = "element_kinds",
        .member = &Options::element_kinds,
        .doc = "Continuous contacts and proximity: search all pairs of elements, only vertices with faces "
               "(vertex_face), or only pairs of edges (edge_edge)"});
    visitor(Field<Options, ContinuousListing>{
        .name = "continuous_listing",
        .member = &Options::continuous_listing,
        .doc = "Continuous contacts: list all, or the first of each vertex, edge and face (first)"});
    visitor(Field<Options, bool>{
        .name = "manifolds",
        .member = &Options::manifolds,
        .doc = "Penetration and proximity: also reduce each patch of contacts to a normal, a depth and at "
               "most four points, with ids that last from frame to frame"});
    visitor(Field<Options, bool>{
        .name = "curves",
        .member = &Options::curves,
        .doc = "List the curves in which surfaces intersect, with what they enclose, a normal and a depth, "
               "for penetration"});
    visitor(Field<Options, std::uint32_t>{.name = "threads",
                                          .member = &Options::threads,
                                          .doc = "Worker threads; 0 means one per core",
                                          .range = ValueRange::from(0, 1024),
                                          .is_of_machine = true});
    visitor(Field<Options, ComparisonOptions>{
        .name = "comparison", .member = &Options::comparison, .doc = "Options for comparison"});
  }
};

template <>
struct Description<StepOptions> {
  static constexpr const char* name = "StepOptions";
  static constexpr void visit(auto&& visitor) {
    using Options = StepOptions;
    visitor(Field<Options, double>{
        .name = "keep",
        .member = &Options::keep,
        .doc = "Share of its distance at the start that each pair of elements keeps in a safe step",
        .range = ValueRange::from(0, 0.99)});
  }
};

template <>
struct Description<BroadPhaseOptions> {
  static constexpr const char* name = "BroadPhaseOptions";
  static constexpr void visit(auto&& visitor) {
    using Options = BroadPhaseOptions;
    visitor(Field<Options, BroadPhaseMethod>{
        .name = "method", .member = &Options::method, .doc = "How overlapping pairs are found"});
    visitor(Field<Options, SceneOctreeOptions>{
        .name = "scene_octree", .member = &Options::scene_octree, .doc = "Shape of the scene octree"});
    visitor(Field<Options, std::uint32_t>{.name = "threads",
                                          .member = &Options::threads,
                                          .doc = "Worker threads; 0 means one per core",
                                          .range = ValueRange::from(0, 1024),
                                          .is_of_machine = true});
    visitor(Field<Options, std::vector<KindPair>>{
        .name = "kind_pairs", .member = &Options::kind_pairs, .doc = "Wanted pairs of kinds of volumes"});
  }
};

}  // namespace supple
