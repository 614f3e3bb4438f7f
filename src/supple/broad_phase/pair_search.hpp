#pragma once

#include <string>
#include <vector>

#include "broad_phase/volume_store.hpp"
#include "supple/broad_phase.hpp"

namespace supple {

/// What a search finds: it stays there for the next one.
struct FoundPairs {
  std::vector<IndexPair> pairs;  ///< sorted by (a, b), each once
  BroadPhaseStats stats;
};

/// One method of the broad phase. All methods find the same pairs: (a, b) exactly when `overlap` of geometry
/// says so of the two volumes and neither is empty.
class PairSearch {
 public:
  virtual ~PairSearch() = default;

  /// Takes the changed volumes of the store and replaces the pairs, which are those of the volumes before, by
  /// the pairs of the volumes now. The stats are zero but for `objects_changed`; at least one object changed.
  virtual void search(VolumeStore& volumes, const Parallel& parallel, FoundPairs& found) = 0;
  /// The next search follows each object from its previous volume.
  virtual bool needs_previous(const VolumeStore&) const { return false; }
  /// Regions that the last search used.
  virtual std::vector<SceneRegion> regions() const { return {}; }
  /// Checks every invariant; the empty string, or what is wrong.
  virtual std::string validate(const VolumeStore&) const { return {}; }
};

}  // namespace supple
