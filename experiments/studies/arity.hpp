#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "results.hpp"
#include "supple/inspection.hpp"

namespace supple::experiments {

struct ArityOptions {
  std::uint32_t frequency = 128;  ///< of the spheres: 20 f² triangles
  std::uint32_t rings = 512;      ///< of the tori: r² triangles
  bool with_bikes = true;
  std::vector<std::size_t> box_counts{1000, 10'000, 100'000};  ///< of scenes, ascending
  int rounds = 5;                                              ///< ≥ 1
  std::uint64_t seed = 1;
};

ArityOptions arity_options(bool quick);

/// The mean level of the leaves; 0 for an octree without leaves.
double mean_depth(const OctreeStatistics& octree);

/// Trees of two, four and eight children, of objects and of the scene, with one thread. Times are the least of
/// the rounds.
Results run_arity(const ArityOptions& options, bool show_progress);

}  // namespace supple::experiments
