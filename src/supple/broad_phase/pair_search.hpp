#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "broad_phase/volume_store.hpp"
#include "supple/broad_phase.hpp"

namespace supple {

/// The pairs and the counters of a broad phase. They persist from search to search.
struct FoundPairs {
  std::vector<IndexPair> pairs;  ///< sorted by (a, b), each once
  BroadPhaseStats stats;
};

/// One method of the broad phase. All methods find the same pairs: (a, b) exactly when neither volume is
/// empty, their kinds are paired, and `overlap` of geometry reports the two.
class PairSearch {
 public:
  virtual ~PairSearch() = default;

  /// Replaces the pairs of the step before by the pairs of the present volumes. At least one volume changed.
  /// All stats are zero except `objects_changed`.
  virtual void search(const VolumeStore& volumes, const Parallel& parallel, FoundPairs& found) = 0;
  /// The regions that the last search used: all, or the leaves that contain the object of a slot.
  virtual std::vector<SceneRegion> regions(std::optional<std::uint32_t>) const { return {}; }
  /// Checks every invariant. Returns the empty string, or what is wrong.
  virtual std::string validate(const VolumeStore&) const { return {}; }
};

}  // namespace supple
