#pragma once

#include <cstdint>
#include <iterator>

#include "supple/result.hpp"

namespace supple::viewer {

/// A number that frames have of the step: a member of `StepStats`.
struct Statistic {
  const char* name;
  double StepStats::*seconds;
  std::uint64_t StepStats::*count;
};

/// `motion_seconds` comes before them.
inline constexpr Statistic statistics[] = {
    {"refit_seconds", &StepStats::refit_seconds, nullptr},
    {"broad_phase_seconds", &StepStats::broad_phase_seconds, nullptr},
    {"rebuild_seconds", &StepStats::rebuild_seconds, nullptr},
    {"traversal_seconds", &StepStats::traversal_seconds, nullptr},
    {"exact_seconds", &StepStats::exact_seconds, nullptr},
    {"sort_and_events_seconds", &StepStats::sort_and_events_seconds, nullptr},
    {"total_seconds", &StepStats::total_seconds, nullptr},
    {"objects_refitted", nullptr, &StepStats::objects_refitted},
    {"triangles_refitted", nullptr, &StepStats::triangles_refitted},
    {"subtrees_rebuilt", nullptr, &StepStats::subtrees_rebuilt},
    {"triangles_rebuilt", nullptr, &StepStats::triangles_rebuilt},
    {"object_pairs_tested", nullptr, &StepStats::object_pairs_tested},
    {"object_pairs", nullptr, &StepStats::object_pairs},
    {"node_pairs_visited", nullptr, &StepStats::node_pairs_visited},
    {"boxes_tested", nullptr, &StepStats::boxes_tested},
    {"candidate_pairs", nullptr, &StepStats::candidate_pairs},
    {"vertex_face_candidates", nullptr, &StepStats::vertex_face_candidates},
    {"edge_edge_candidates", nullptr, &StepStats::edge_edge_candidates},
    {"exact_fallbacks", nullptr, &StepStats::exact_fallbacks},
    {"contacts", nullptr, &StepStats::contacts},
};

inline double value_of(const Statistic& statistic, const StepStats& stats) {
  return statistic.seconds != nullptr ? stats.*statistic.seconds
                                      : static_cast<double>(stats.*statistic.count);
}

}  // namespace supple::viewer
