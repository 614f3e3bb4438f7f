#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "broad_phase/octree/scene_cube.hpp"
#include "broad_phase/octree/slot_lists.hpp"
#include "broad_phase/volume_store.hpp"
#include "supple/options.hpp"
#include "supple/result.hpp"

namespace supple {

/// The octree of the scene (the paper's section 5): a cube that is divided into groups of eight regions. Each
/// object is in every leaf region that its volume touches. The regions follow the objects from step to step.
///
/// A plane divides space into half-open halves: a box is in the lower half of a region when min < middle, and
/// in the upper half when max >= middle. These tests do not round. The outermost regions are infinite, so
/// every object is in a leaf, wherever it is. Child k of a region is in the upper half along x, y, z when bit
/// 0, 1, 2 of k is set.
///
/// A region divides an object when the object is no longer than the edge of the region's children. A region
/// above `max_level` is expanded exactly when it divides at least `expand_at` of its objects. So an object
/// that is large compared with a region never expands it, and a divided object touches at most eight regions
/// of the next level. Thus each level has at most 8 n / expand_at groups, wherever the n objects are. With
/// `expand_for_large_objects`, a region divides all of its objects, and down to `min_level` every region is
/// expanded. The regions depend on the cube and the present volumes alone, not on earlier steps.
///
/// A tree of arity 4 or 2 halves its regions along two axes or one, with x, y and z in turn. The bits of k
/// belong to these axes in this order. Such a region is not a cube, and it divides an object that is no
/// longer than the shortest edge of its children.
class SceneOctree {
 public:
  struct Region {
    std::uint64_t number = 0;
    Vec3f lower, middle, upper;     ///< lower and upper are infinite at the border of the scene
    std::uint32_t first_child = 0;  ///< 0 for a leaf
    std::uint32_t divided = 0;      ///< the number of its objects that it divides
    SlotLists::List objects;        ///< empty unless this is a leaf
    std::uint8_t level = 0;
    bool in_use = false;

    bool is_leaf() const { return first_child == 0; }
  };

  SceneOctree(BoundingVolume bounding_volume, const SceneOctreeOptions& options);

  /// Whether a tree that is built in the best cube for the present objects would differ much.
  bool is_outdated(const SceneCube& best) const {
    return supple::is_outdated(cube_, best) || expand_at_ != chosen_expand_at();
  }
  /// Whether Arvo's test places spheres. Two spheres that overlap then share a leaf, but perhaps not the leaf
  /// in which the intersection of their boxes begins.
  bool placed_by_sphere() const { return by_sphere_; }

  /// Makes all regions from the root down, O(objects · levels).
  void build(const VolumeStore& volumes, const SceneCube& cube);
  /// True when the present volume surely belongs to the same regions as the volume that was placed last.
  /// O(1).
  bool stays(std::uint32_t slot, const Aabb& box) const;
  /// Moves an object to the regions of its present volume, in one walk down its old and new regions. After
  /// all objects have moved, `settle` must follow.
  void move(const VolumeStore& volumes, std::uint32_t slot);
  /// Expands and reduces regions after moves.
  void settle(const VolumeStore& volumes);

  std::span<const Region> regions() const { return regions_; }
  std::span<const std::uint32_t> objects(const Region& region) const { return lists_.view(region.objects); }
  /// Calls `visit(region)` for each leaf that contains the object.
  template <class Visit>
  void visit_leaves(const ObjectVolume& volume, Visit&& visit) const {
    if (!volume.box.empty()) visit_leaves_below(regions_[0], volume, visit);
  }

  std::size_t object_count() const { return object_count_; }        ///< without empty volumes
  std::uint64_t expanded_count() const { return expanded_count_; }  ///< since construction
  std::uint64_t reduced_count() const { return reduced_count_; }
  /// All regions, or the leaves that contain the object of a slot.
  std::vector<SceneRegion> describe(std::optional<std::uint32_t> slot = {}) const;
  std::string validate(const VolumeStore& volumes) const;

 private:
  /// The ends of a box may move in this range without crossing a plane of the regions that contain the box:
  /// x, y, z of min, then of max; the lower bound is inclusive, the upper exclusive. All zeros is no range.
  struct StayRange {
    std::array<float, 6> low, high;
  };

  /// The number of times that the root is halved along the axis to get the regions of a level.
  int halvings(int axis, std::uint32_t level) const {
    return (static_cast<int>(level) * axes_per_level_ + 2 - axis) / 3;
  }
  /// The axis to which bit `turn` of a child's number belongs.
  int split_axis(std::uint32_t level, int turn) const {
    return (static_cast<int>(level) * axes_per_level_ + turn) % 3;
  }
  bool divides(std::uint32_t level, std::uint8_t finest_level) const {
    return divides_large_ || finest_level >= halvings(0, level + 1);
  }
  std::uint32_t levels_of(std::uint32_t levels_of_eight) const {
    return levels_of_eight * 3 / static_cast<std::uint32_t>(axes_per_level_);
  }
  std::uint8_t finest_level(const Aabb& box) const;
  std::uint32_t children_touched(const Region& region, const ObjectVolume& volume) const;
  std::uint32_t children_of_box(const Region& region, const Aabb& box) const;
  std::uint32_t children_of_sphere(const Region& region, const BoundingSphere& sphere) const;
  void resize(std::size_t slot_count);
  void place(std::uint32_t slot, const ObjectVolume& volume);
  bool should_expand(const Region& region) const;
  void make_root();
  std::uint32_t make_children(std::uint32_t parent);
  void free_children(std::uint32_t parent);
  void expand(const VolumeStore& volumes, std::uint32_t index);
  void reduce(std::uint32_t index);
  void collect(std::uint32_t index);
  struct Journey;
  void move_below(std::uint32_t index, const Journey& journey, bool was_here, bool is_here);
  void narrow_stay_range(std::uint32_t slot, const Region& region);

  template <class Visit>
  void visit_leaves_below(const Region& region, const ObjectVolume& volume, Visit& visit) const {
    if (region.is_leaf()) {
      visit(region);
      return;
    }
    for (std::uint32_t mask = children_touched(region, volume); mask != 0; mask &= mask - 1)
      visit_leaves_below(regions_[region.first_child + static_cast<std::uint32_t>(std::countr_zero(mask))],
                         volume, visit);
  }

  std::string validate_below(const VolumeStore& volumes, std::uint32_t index,
                             std::span<const std::uint32_t> slots) const;
  std::uint32_t chosen_expand_at() const;

  bool by_sphere_, divides_large_;
  std::uint32_t min_level_, max_level_, given_expand_at_;
  std::uint32_t expand_at_ = 2;
  std::uint32_t arity_;
  int axes_per_level_;
  std::uint32_t deepest_level_ = 1;
  SceneCube cube_;
  double inverse_edge_ = 1;      // of the cube
  std::vector<Region> regions_;  // the root is alone in the first group
  std::vector<std::uint32_t> free_groups_;
  SlotLists lists_;
  std::vector<std::uint32_t> due_;  // regions to expand or reduce; repeats are possible
  std::size_t object_count_ = 0;
  std::uint64_t expanded_count_ = 0, reduced_count_ = 0;

  // Per slot.
  std::vector<ObjectVolume> placed_;        // belongs to the same regions as the present volume
  std::vector<StayRange> stay_;             // for boxes
  std::vector<std::uint8_t> finest_level_;  // of the placed volume

  std::vector<std::uint8_t> child_masks_;   // scratch of `expand`
  std::vector<std::uint32_t> collected_;    // scratch of `reduce`
  std::vector<std::uint8_t> is_collected_;  // scratch of `reduce`, per slot
};

/// The level, in halvings of the cube, of the smallest regions whose edge is no shorter than the box, by
/// powers of two.
inline std::uint8_t SceneOctree::finest_level(const Aabb& box) const {
  double extent = 0;
  for (int axis = 0; axis < 3; ++axis) extent = std::max(extent, double{box.max[axis]} - box.min[axis]);
  // The exponent alone: extent / edge is in [2^(e-1), 2^e). Infinity and NaN have the largest.
  const auto bits = std::bit_cast<std::uint64_t>(extent * inverse_edge_);
  const int exponent = static_cast<int>(bits >> 52 & 0x7ff) - 1022;
  return static_cast<std::uint8_t>(std::clamp(-exponent, 0, 31));
}

inline bool SceneOctree::stays(std::uint32_t slot, const Aabb& box) const {
  if (slot >= stay_.size() || box.empty()) return false;
  const StayRange& range = stay_[slot];
  for (int axis = 0; axis < 3; ++axis) {
    const std::size_t k = static_cast<std::size_t>(axis);
    if (!(range.low[k] <= box.min[axis] && box.min[axis] < range.high[k])) return false;
    if (!(range.low[k + 3] <= box.max[axis] && box.max[axis] < range.high[k + 3])) return false;
  }
  return finest_level(box) == finest_level_[slot];
}

}  // namespace supple
