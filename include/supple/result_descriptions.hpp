#pragma once

#include "supple/broad_phase.hpp"
#include "supple/contact.hpp"
#include "supple/continuous.hpp"
#include "supple/description.hpp"
#include "supple/mesh.hpp"
#include "supple/option_descriptions.hpp"
#include "supple/result.hpp"

// Descriptions of the results of the core: the words for kinds, and the statistics (description.hpp).

namespace supple {

template <>
inline constexpr std::array words<IntersectionKind>{"point", "segment", "polygon"};
template <>
inline constexpr std::array words<FeatureKind>{"vertex", "edge", "face"};
template <>
inline constexpr std::array words<ImpactCertainty>{"certain", "within_tolerance"};
/// The element of a before that of b: vertex, edge or face.
template <>
inline constexpr std::array words<ElementPairKind>{"vf", "fv", "ee", "ve", "ev", "vv"};
template <>
inline constexpr std::array words<NothingToTest>{"no_objects", "no_elements", "not_finite", "no_solid",
                                                 "no_motion",  "no_margin",   "one_object", "all_static",
                                                 "groups",     "filter"};
template <>
inline constexpr std::array words<Lasting>{"begin", "stay"};
template <>
inline constexpr std::array words<ManifoldSource>{"curve", "pairs"};

template <>
struct Description<StepStats> {
  static constexpr const char* name = "StepStats";
  static constexpr void visit(auto&& visitor) {
    using Stats = StepStats;
    const auto seconds = [&](const char* field, double Stats::*member, const char* doc) {
      visitor(Field<Stats, double>{
          .name = field, .member = member, .doc = doc, .unit = "s", .is_of_machine = true});
    };
    const auto count = [&](const char* field, std::uint64_t Stats::*member, const char* unit,
                           const char* doc) {
      visitor(Field<Stats, std::uint64_t>{.name = field, .member = member, .doc = doc, .unit = unit});
    };
    const auto work = [&](const char* field, std::uint64_t Stats::*member, const char* doc) {
      visitor(Field<Stats, std::uint64_t>{
          .name = field, .member = member, .doc = doc, .unit = "pairs", .is_of_machine = true});
    };
    seconds("refit_seconds", &Stats::refit_seconds, "Time to refit octrees to new positions");
    seconds("broad_phase_seconds", &Stats::broad_phase_seconds,
            "Time of the broad phase, which finds object pairs");
    seconds("rebuild_seconds", &Stats::rebuild_seconds, "Time to rebuild degraded octrees");
    seconds("traversal_seconds", &Stats::traversal_seconds,
            "Time of the narrow phase, which finds candidates");
    seconds("exact_seconds", &Stats::exact_seconds, "Time of the exact stage, which decides the candidates");
    seconds("penetration_seconds", &Stats::penetration_seconds,
            "Time to find vertices inside solids, contained parts and curves");
    seconds("manifold_seconds", &Stats::manifold_seconds, "Time to find manifolds and their ids");
    seconds("sort_and_events_seconds", &Stats::sort_and_events_seconds,
            "Time to sort contacts and to find events");
    seconds("total_seconds", &Stats::total_seconds, "Time of the whole detection");
    visitor(Field<Stats, BroadPhaseMethod>{.name = "broad_phase_method",
                                           .member = &Stats::broad_phase_method,
                                           .doc = "Method of the broad phase that ran"});
    count("objects_refitted", &Stats::objects_refitted, "objects", "Objects with new positions");
    count("triangles_refitted", &Stats::triangles_refitted, "triangles",
          "Triangles in the refitted leaves of these objects");
    count("octrees_rebuilt", &Stats::octrees_rebuilt, "octrees", "Degraded octrees that were rebuilt");
    count("triangles_rebuilt", &Stats::triangles_rebuilt, "triangles", "Triangles of these octrees");
    count("object_pairs_tested", &Stats::object_pairs_tested, "pairs",
          "Tests of two objects' volumes in the broad phase");
    count("object_pairs", &Stats::object_pairs, "pairs", "Object pairs that the broad phase found");
    work("node_pairs_visited", &Stats::node_pairs_visited,
         "Pairs of octree nodes in the narrow phase; depends on the number of threads");
    work("boxes_tested", &Stats::boxes_tested,
         "Tests of two volumes in nodes and leaves; depends on the number of threads");
    count(
        "candidate_pairs", &Stats::candidate_pairs, "pairs",
        "Pairs of triangles whose boxes overlap; 0 when only continuous contacts or proximity are requested");
    count(
        "vertex_face_candidates", &Stats::vertex_face_candidates, "pairs",
        "Pairs of a vertex and a face whose boxes come within reach, with continuous contacts or proximity");
    count("edge_edge_candidates", &Stats::edge_edge_candidates, "pairs",
          "Pairs of edges whose boxes come within reach, with continuous contacts or proximity");
    count("exact_fallbacks", &Stats::exact_fallbacks, "pairs",
          "Candidates that floating point could not decide");
    count("contacts", &Stats::contacts, "contacts", "Intersections and continuous contacts in the result");
    count("proximity_pairs", &Stats::proximity_pairs, "pairs", "Proximity pairs in the result");
    count("penetrations", &Stats::penetrations, "vertices", "Vertices inside solids in the result");
    count("curves", &Stats::curves, "curves", "Curves of intersection in the result");
  }
};

template <>
struct Description<BroadPhaseStats> {
  static constexpr const char* name = "BroadPhaseStats";
  static constexpr void visit(auto&& visitor) {
    using Stats = BroadPhaseStats;
    const auto count = [&](const char* field, std::uint64_t Stats::*member, const char* unit,
                           const char* doc) {
      visitor(Field<Stats, std::uint64_t>{.name = field, .member = member, .doc = doc, .unit = unit});
    };
    visitor(
        Field<Stats, BroadPhaseMethod>{.name = "method", .member = &Stats::method, .doc = "Method that ran"});
    count("object_pairs_tested", &Stats::object_pairs_tested, "pairs", "Tests of two volumes");
    count("objects_changed", &Stats::objects_changed, "objects", "Volumes that differ from the call before");
    count("objects_paired", &Stats::objects_paired, "objects",
          "Objects whose pairs were searched; the pairs of the others were kept");
    count("exchanges", &Stats::exchanges, "ends", "Exchanges of two ends in the sorted lists of sweep3");
    count("objects_placed", &Stats::objects_placed, "objects", "Objects that left or entered regions");
    count("regions_expanded", &Stats::regions_expanded, "groups", "Groups of regions that were created");
    count("regions_reduced", &Stats::regions_reduced, "regions", "Regions that became leaves again");
    count("regions_rebuilt", &Stats::regions_rebuilt, "times", "All regions were rebuilt");
  }
};

template <>
struct Description<PolygonCounts> {
  static constexpr const char* name = "PolygonCounts";
  static constexpr void visit(auto&& visitor) {
    const auto count = [&](const char* field, std::uint64_t PolygonCounts::*member, const char* doc) {
      visitor(Field<PolygonCounts, std::uint64_t>{
          .name = field, .member = member, .doc = doc, .unit = "polygons"});
    };
    count("quads", &PolygonCounts::quads, "Faces with four corners");
    count("larger", &PolygonCounts::larger, "Faces with five corners or more");
    count("concave", &PolygonCounts::concave, "Of both, those that turn both ways");
    count("crossing", &PolygonCounts::crossing, "Of both, those whose outline crosses itself");
    count("bent", &PolygonCounts::bent, "Of both, those that are not flat within 1/1000 of their size");
  }
};

}  // namespace supple
