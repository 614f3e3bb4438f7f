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

/// The box from `lowest` to `highest`, grown by `radius` on all sides and rounded outward: it contains every
/// point whose distance along each axis is at most the radius, exactly. Bounds that are finite floats stay.
/// Others move outward by at most 3 units in the last place or 2^-125, whichever is more; beyond the range of
/// float they become infinite. The box is empty when a coordinate is a NaN, or when `lowest` is above
/// `highest` along an axis.
/// Throws `Error` when the radius is negative or a NaN. O(1), 15 to 40 ns.
Aabb enclosing_box(const Vec3d& lowest, const Vec3d& highest, double radius = 0);
/// The same around points, such as the vertices of an element at both ends of a step. The box is empty when
/// there are no points.
Aabb enclosing_box(std::span<const Vec3d> points, double radius = 0);

/// What the last call of `BroadPhase::find_object_pairs` did. All counts are 0 when no volume changed.
struct BroadPhaseStats {
  /// The method that ran last: octree or grid when `automatic` was chosen.
  BroadPhaseMethod method = BroadPhaseMethod::automatic;
  std::uint64_t object_pairs_tested = 0;  ///< tests of two volumes
  /// Volumes that differ from the call before, including new and removed volumes.
  std::uint64_t objects_changed = 0;
  std::uint64_t objects_paired = 0;  ///< objects whose pairs were searched; the pairs of others were kept
  std::uint64_t exchanges = 0;       ///< of two ends in the sorted lists of sweep3; 0 for other methods
  // Counts of the octree; 0 for other methods.
  std::uint64_t objects_placed = 0;    ///< objects that left or entered regions
  std::uint64_t regions_expanded = 0;  ///< groups of child regions that were created
  std::uint64_t regions_reduced = 0;   ///< regions that became leaves again
  std::uint64_t regions_rebuilt = 0;   ///< 1 when all regions were rebuilt
};

/// The number of kinds that volumes may have: kinds are 0 to 7.
inline constexpr std::uint32_t volume_kind_count = 8;

/// Two kinds whose volumes are paired with each other, in any order, or one kind whose volumes are paired
/// among themselves.
struct KindPair {
  std::uint8_t a = 0, b = 0;
  constexpr bool operator==(const KindPair&) const = default;
};

/// Options of a broad phase, fixed at its construction.
struct BroadPhaseOptions {
  BroadPhaseMethod method = BroadPhaseMethod::automatic;
  /// For the methods automatic and octree.
  SceneOctreeOptions scene_octree{};
  /// Worker threads; 0 means one per core. The pairs are the same for any number of threads.
  std::uint32_t threads = 0;
  /// The wanted pairs of kinds, for example vertices with faces and edges with edges. Repeats are allowed.
  /// When there are some, each call needs the kind of each volume, and the result has only pairs of volumes
  /// of these kinds. The default finds the pairs of all volumes, and calls have no kinds.
  std::vector<KindPair> kind_pairs{};
};

/// The broad phase alone: volumes in, overlapping pairs out. For programs that have boxes or spheres and no
/// meshes.
///
/// It keeps the volumes and the pairs of the last call: volume i is the same object in every call. Calls on
/// one `BroadPhase` must not overlap.
class BroadPhase {
 public:
  /// Throws `Error` when an option is out of its range, or has no effect with the method, and when
  /// `kind_pairs` has a kind that is not below `volume_kind_count`.
  explicit BroadPhase(const BroadPhaseOptions& options = {});
  ~BroadPhase();
  BroadPhase(BroadPhase&&) noexcept;
  BroadPhase& operator=(BroadPhase&&) noexcept;

  /// All pairs whose closed volumes overlap, each once, sorted by (a, b). The span lasts until the next call.
  ///
  /// The number of volumes may change between calls: volumes past the end were removed. Empty volumes are in
  /// no pair. Coordinates may be infinite. A box with a NaN is empty. A sphere with a NaN overlaps every
  /// sphere that is not empty. Spheres are compared in double: rounding may add pairs of spheres that are
  /// just apart, but never loses a pair. A call with spheres after a call with boxes, or the reverse, forgets
  /// all volumes of the call before.
  ///
  /// Cost for n volumes, k pairs and c changed volumes: the comparison of volumes is O(n). When no volume
  /// changed, this is the whole cost. Otherwise the search is
  /// - octree: O(c + k), or O(n + k) when c is large or the regions are rebuilt,
  /// - grid: O(n + k) unless many volumes share cells,
  /// - sweep: O(n log n + pairs that overlap along one axis),
  /// - brute: O(n²),
  /// - sweep3: O(n + k + exchanges of two ends), or as sweep when a volume appears or becomes empty.
  /// A call with at most 2^20 pairs allocates no memory once the buffers are as large as the scene needs.
  std::span<const IndexPair> find_object_pairs(std::span<const Aabb> boxes);
  std::span<const IndexPair> find_object_pairs(std::span<const BoundingSphere> spheres);

  /// The same with a dirty list, which avoids the comparison of all volumes. `dirty` has the indices of all
  /// volumes that may differ from the call before, in any order. It may contain repeats and unchanged
  /// volumes. New volumes at the end need not be listed. A volume that changed and is not listed keeps its
  /// old value until a list contains it or a call has no list.
  /// Throws `Error` when an index is not below the number of volumes.
  std::span<const IndexPair> find_object_pairs(std::span<const Aabb> boxes,
                                               std::span<const std::uint32_t> dirty);
  std::span<const IndexPair> find_object_pairs(std::span<const BoundingSphere> spheres,
                                               std::span<const std::uint32_t> dirty);

  /// The same for volumes of several kinds: only pairs of `BroadPhaseOptions::kind_pairs`. `kinds` has the
  /// kind of each volume. A volume whose kind differs from the call before counts as changed, and a dirty
  /// list must contain it. Volumes whose kind is in no wanted pair count as empty.
  ///
  /// The grid keeps the volumes of each kind apart, so it does not test unwanted pairs. The other methods
  /// test them and leave them out.
  /// Throws `Error` when there are not as many kinds as volumes, when a kind is not below
  /// `volume_kind_count`, when the options have no `kind_pairs`, and in the functions without kinds when they
  /// have some.
  std::span<const IndexPair> find_object_pairs(std::span<const Aabb> boxes,
                                               std::span<const std::uint8_t> kinds);
  std::span<const IndexPair> find_object_pairs(std::span<const BoundingSphere> spheres,
                                               std::span<const std::uint8_t> kinds);
  std::span<const IndexPair> find_object_pairs(std::span<const Aabb> boxes,
                                               std::span<const std::uint8_t> kinds,
                                               std::span<const std::uint32_t> dirty);
  std::span<const IndexPair> find_object_pairs(std::span<const BoundingSphere> spheres,
                                               std::span<const std::uint8_t> kinds,
                                               std::span<const std::uint32_t> dirty);

  /// Statistics of the last call.
  const BroadPhaseStats& stats() const;
  /// The regions that the last search used, root first, ascending by number. Empty unless the octree ran.
  /// O(regions log regions).
  std::vector<SceneRegion> regions() const;
  /// Checks every invariant. Returns an empty string, or a description of the first error. For tests.
  std::string validate() const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace supple
