#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/parallel.hpp"
#include "supple/broad_phase.hpp"

namespace supple {

/// Volumes of all object slots at one step. Slots of removed objects hold empty volumes; slots past the end
/// count as removed. No NaN in boxes.
struct ObjectVolumes {
  std::span<const Aabb> boxes;              ///< empty in sphere mode
  std::span<const BoundingSphere> spheres;  ///< empty in box mode
  /// Slots whose volumes may differ from the call before, in any order, perhaps repeated. Nothing: found by
  /// comparing. Slots that are new or gone count as changed whatever it says.
  std::optional<std::span<const std::uint32_t>> changed{};
};

/// One of the methods of the broad phase. All find the same pairs: (a, b) exactly when `overlap` of geometry
/// says so of the two volumes and neither is empty.
class PairFinder {
 public:
  virtual ~PairFinder() = default;

  /// All overlapping pairs, sorted by (a, b), each once; they last until the next call.
  virtual std::span<const IndexPair> find_pairs(const ObjectVolumes& volumes, const Parallel& parallel) = 0;
  virtual std::string validate() const { return {}; }
  virtual std::vector<SceneRegion> regions() const { return {}; }
  const BroadPhaseStats& stats() const { return stats_; }

 protected:
  BroadPhaseStats stats_;
};

/// Throws `Error` when an option is out of its range.
std::unique_ptr<PairFinder> make_pair_finder(BroadPhaseMethod method, BoundingVolume bounding_volume,
                                             const SceneOctreeOptions& octree_options);

}  // namespace supple
