#pragma once

#include <compare>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "supple/options.hpp"
#include "supple/result.hpp"
#include "supple/types.hpp"

namespace supple {

/// Two different objects as indices into the span of volumes, `a < b`.
struct IndexPair {
  std::uint32_t a = 0, b = 0;
  constexpr auto operator<=>(const IndexPair&) const = default;
};

/// What the last call of `BroadPhase::find_object_pairs` did.
struct BroadPhaseStats {
  std::uint64_t object_pairs_tested = 0;  ///< volume against volume
  std::uint64_t objects_changed = 0;      ///< volumes that differ from the call before, new ones included
  // Of the scene octree; 0 for other methods, and in a call that searches without regions.
  std::uint64_t objects_placed = 0;    ///< taken out of regions or put into others
  std::uint64_t regions_expanded = 0;  ///< groups of eight made
  std::uint64_t regions_reduced = 0;   ///< regions that became leaves again
  std::uint64_t regions_rebuilt = 0;   ///< 1 when all regions were made anew
  std::uint64_t objects_paired = 0;    ///< whose pairs were searched; those of the others were kept
};

struct BroadPhaseOptions {
  BroadPhaseMethod method = BroadPhaseMethod::octree;
  SceneOctreeOptions scene_octree;
  /// Worker threads, 0 for one a core. The pairs are the same for any number.
  std::uint32_t threads = 0;
};

/// The broad phase by itself: volumes in, overlapping pairs out, for programs that have boxes or balls of
/// their own and want no meshes.
///
/// It keeps what the last call found: volume i is taken to be the same object from call to call, and what did
/// not change costs close to nothing. Calls on one object must not overlap.
class BroadPhase {
 public:
  /// Throws `Error` when an option is out of its range.
  explicit BroadPhase(const BroadPhaseOptions& options = {});
  ~BroadPhase();
  BroadPhase(BroadPhase&&) noexcept;
  BroadPhase& operator=(BroadPhase&&) noexcept;

  /// All pairs whose closed volumes overlap, each once, sorted by (a, b). The span lasts until the next call.
  ///
  /// The number of volumes may differ from call to call: those past the end are gone. Empty volumes are in no
  /// pair. Coordinates may be infinite. A box with a NaN is empty, a ball with a NaN overlaps everything but
  /// empty balls. Balls are compared in double and may be reported when apart by rounding, never the reverse.
  /// A call with balls after one with boxes, or the reverse, starts afresh.
  ///
  /// Cost for n volumes and k pairs: octree O(n + k), with c of them changed O(c), besides comparing volumes
  /// and moving pairs in memory, or all anew, whichever costs less; sweep O(n log n + pairs that overlap
  /// along one axis); brute O(n²). No allocation once the buffers are as large as the scene needs.
  std::span<const IndexPair> find_object_pairs(std::span<const Aabb> boxes);
  std::span<const IndexPair> find_object_pairs(std::span<const BoundingSphere> spheres);

  /// The same, told which volumes may differ from the call before: `changed` has the indices of all that do,
  /// in any order; one that does not differ, or is there twice, does no harm. Volumes past the end of those
  /// of the call before are found without. The octree looks at no others, in O(c) instead of O(n): one that
  /// changed and is not in the list is taken to be as it was last seen, until a list has it or a call comes
  /// without one. The other methods look at all.
  /// Throws `Error` when an index is not below the number of volumes.
  std::span<const IndexPair> find_object_pairs(std::span<const Aabb> boxes,
                                               std::span<const std::uint32_t> changed);
  std::span<const IndexPair> find_object_pairs(std::span<const BoundingSphere> spheres,
                                               std::span<const std::uint32_t> changed);

  /// Of the last call.
  const BroadPhaseStats& stats() const;
  /// Regions of the scene octree, root first, ascending by number; empty for other methods. Made for this
  /// call, O(n log n), when the last search did without.
  std::vector<SceneRegion> regions() const;
  /// Checks every invariant; the empty string, or what is wrong.
  std::string validate() const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace supple
