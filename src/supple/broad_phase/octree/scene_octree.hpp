#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "broad_phase/octree/scene_cube.hpp"
#include "broad_phase/octree/slot_lists.hpp"
#include "broad_phase/volume_store.hpp"
#include "supple/options.hpp"
#include "supple/result.hpp"

namespace supple {

/// The octree of the scene (the paper's section 5): a cube divided into groups of eight regions, which holds
/// each object in every leaf region that its volume touches, and follows the objects from step to step.
///
/// Regions part space at planes, half-open: a box is in the lower half of a region when min < middle and in
/// the upper half when max >= middle. There is no rounding in this, and the outermost regions reach to
/// infinity, so an object anywhere is in some leaf. Child k of a region is in the upper half along x, y, z
/// when bit 0, 1, 2 of k is set.
///
/// A region divides an object when the object is no longer than the edge of its children. A region is
/// expanded exactly when at least `expand_at` of its objects are divided by it and it is above `max_level`.
/// An object that is large against a region thus never expands it, and one that is divided touches at most
/// eight regions of that level: there are at most 8 n / expand_at groups on each level, however the n objects
/// lie. The regions depend on the cube and the present volumes alone, not on the way there.
///
/// A tree of arity 4 or 2 halves its regions along two axes or one, x, y and z in turn; the bits of k are for
/// these axes in the order of their turns. A region is then no cube, and it divides an object that is no
/// longer than the shortest edge of its children.
class SceneOctree {
 public:
  struct Region {
    std::uint64_t number = 0;
    Vec3f lower, middle, upper;     ///< lower and upper infinite at the border of the scene
    std::uint32_t first_child = 0;  ///< the group of children; 0 for a leaf
    std::uint32_t divided = 0;      ///< objects in it that it divides
    SlotLists::List objects;        ///< of a leaf; empty for others
    std::uint8_t level = 0;
    bool in_use = false;

    bool is_leaf() const { return first_child == 0; }
  };

  SceneOctree(BoundingVolume bounding_volume, const SceneOctreeOptions& options);

  /// A tree that is built in the best cube for the present objects would differ much.
  bool is_outdated(const SceneCube& best) const {
    return supple::is_outdated(cube_, best) || expand_at_ != chosen_expand_at();
  }
  /// Spheres are placed by Arvo's test: two that overlap share a region, but perhaps not the one in which the
  /// intersection of their boxes begins.
  bool placed_by_sphere() const { return by_sphere_; }

  // Each of these reads the volumes that it is given; what is said of a slot's present volume is that one.

  /// Makes all regions anew, top down, O(objects · levels).
  void build(const VolumeStore& volumes, const SceneCube& cube);
  /// True when the object's leaves and the regions that it divides are the same for the volume `now`; false
  /// when a walk down the regions has to find out. O(1). The object's previous volume was not empty.
  bool stays(std::uint32_t slot, const ObjectVolume& now) const;
  /// Moves an object from the regions of its volume `from` to those of its present one, in one walk down the
  /// regions of both. `settle` must follow when all objects have moved.
  void move(const VolumeStore& volumes, std::uint32_t slot, const ObjectVolume& from);
  /// Expands and reduces the regions that `move` left due for it.
  void settle(const VolumeStore& volumes);

  std::span<const Region> regions() const { return regions_; }
  std::span<const std::uint32_t> objects(const Region& region) const { return lists_.view(region.objects); }
  /// Calls `visit(region)` for each leaf that the object is in.
  template <class Visit>
  void visit_leaves(const ObjectVolume& volume, Visit&& visit) const {
    if (!volume.box.empty()) visit_leaves_below(regions_[0], volume, visit);
  }

  std::size_t object_count() const { return object_count_; }        ///< that are not empty
  std::uint64_t expanded_count() const { return expanded_count_; }  ///< since construction
  std::uint64_t reduced_count() const { return reduced_count_; }
  std::vector<SceneRegion> describe() const;
  std::string validate(const VolumeStore& volumes) const;

 private:
  /// Within which the ends of a box may move while every comparison with the regions' planes comes out the
  /// same: x, y, z of min, then of max, lower bound inclusive, upper exclusive.
  struct StayRange {
    std::array<float, 6> low, high;
  };

  /// How often regions of this level are halved along the axis, counted from the root.
  int halvings(int axis, std::uint32_t level) const {
    return (static_cast<int>(level) * axes_per_level_ + 2 - axis) / 3;
  }
  /// The axis that bit `turn` of a child's number is for.
  int split_axis(std::uint32_t level, int turn) const {
    return (static_cast<int>(level) * axes_per_level_ + turn) % 3;
  }
  float shortest_edge(std::uint32_t level) const { return std::ldexp(cube_.edge, -halvings(0, level)); }
  bool divides(std::uint32_t level, std::uint8_t finest_level) const {
    return finest_level >= halvings(0, level + 1);
  }
  std::uint8_t finest_level(const Aabb& box) const;
  std::uint32_t children_touched(const Region& region, const ObjectVolume& volume) const;
  std::uint32_t children_of_box(const Region& region, const Aabb& box) const;
  std::uint32_t children_of_sphere(const Region& region, const BoundingSphere& sphere) const;
  void resize(std::size_t slot_count);
  bool should_expand(const Region& region) const;
  void make_root();
  std::uint32_t make_children(std::uint32_t parent);
  void free_children(std::uint32_t parent);
  void expand(const VolumeStore& volumes, std::uint32_t index);
  void reduce(std::uint32_t index);
  void collect(std::uint32_t index);
  struct Journey;
  void move_below(std::uint32_t index, const Journey& journey, bool was_here, bool is_here);
  void open_stay_range(std::uint32_t slot);
  void narrow_stay_range(std::uint32_t slot, const Aabb& box, const Region& region);
  void set_sphere_stay_range(std::uint32_t slot, const Aabb& box, const Region& leaf);

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

  bool by_sphere_;
  std::uint32_t max_level_, given_expand_at_;
  std::uint32_t expand_at_ = 2;
  std::uint32_t arity_;
  int axes_per_level_;
  std::uint32_t deepest_level_ = 1;  // of this tree: levels of arity 4 and 2 are more than the cube's
  SceneCube cube_;
  double inverse_edge_ = 1;      // of the cube
  std::vector<Region> regions_;  // the root is alone in the first group
  std::vector<std::uint32_t> free_groups_;
  SlotLists lists_;
  std::vector<std::uint32_t> due_;  // regions to expand or reduce, perhaps several times
  std::size_t object_count_ = 0;
  std::uint64_t expanded_count_ = 0, reduced_count_ = 0;

  // Per slot.
  std::vector<StayRange> stay_;
  std::vector<std::uint8_t> finest_level_;  // in levels of eight: regions whose children are above divide it

  std::vector<std::uint8_t> child_masks_;   // scratch of `expand`
  std::vector<std::uint32_t> collected_;    // scratch of `reduce`
  std::vector<std::uint8_t> is_collected_;  // scratch of `reduce`, per slot
};

/// Level of the smallest regions whose edge is no shorter than the box, by powers of two.
inline std::uint8_t SceneOctree::finest_level(const Aabb& box) const {
  double extent = 0;
  for (int axis = 0; axis < 3; ++axis) extent = std::max(extent, double{box.max[axis]} - box.min[axis]);
  // The exponent alone: extent / edge is in [2^(e-1), 2^e). Infinity and NaN have the largest.
  const auto bits = std::bit_cast<std::uint64_t>(extent * inverse_edge_);
  const int exponent = static_cast<int>(bits >> 52 & 0x7ff) - 1022;
  return static_cast<std::uint8_t>(std::clamp(-exponent, 0, 31));
}

inline bool SceneOctree::stays(std::uint32_t slot, const ObjectVolume& now) const {
  if (now.box.empty()) return false;
  const StayRange& range = stay_[slot];
  for (int axis = 0; axis < 3; ++axis) {
    const std::size_t k = static_cast<std::size_t>(axis);
    if (!(range.low[k] <= now.box.min[axis] && now.box.min[axis] < range.high[k])) return false;
    if (!(range.low[k + 3] <= now.box.max[axis] && now.box.max[axis] < range.high[k + 3])) return false;
  }
  return finest_level(now.box) == finest_level_[slot];
}

}  // namespace supple
