#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "core/float_rounding.hpp"
#include "core/parallel.hpp"
#include "geometry/sphere.hpp"
#include "supple/options.hpp"

namespace supple {

/// The volumes that a caller gives for one step, by slot: boxes or spheres. Slots of removed objects hold
/// empty volumes. A box with a NaN is empty.
struct ObjectVolumes {
  std::span<const Aabb> boxes{};
  std::span<const BoundingSphere> spheres{};
  /// The dirty list: slots whose volumes may differ from the step before, in any order, repeats allowed.
  /// Without a list all volumes are compared. Slots that are new or gone need not be listed.
  std::optional<std::span<const std::uint32_t>> dirty{};
};

/// A box that overlaps the box of every sphere which `overlap(sphere, sphere)` reports with this one.
///
/// Reported spheres have |c1 - c2| <= (r1 + r2)(1 + 2^-48) along each axis, the factor covering the slack of
/// that test and its roundings. With R = fl(r (1 + 2^-40)) this gives c1 - R1 <= c2 + R2, and rounding is
/// monotone, so the rounded ends compare the same way. A sphere with a number that is not finite can pass
/// that test with any other (infinity minus infinity is NaN, and NaN overlaps): its box is all of space.
inline Aabb bounding_box(const BoundingSphere& sphere) {
  constexpr float infinity = std::numeric_limits<float>::infinity();
  if (sphere.empty()) return {};
  if (!std::isfinite(sphere.radius) || !std::isfinite(sphere.center.x) || !std::isfinite(sphere.center.y) ||
      !std::isfinite(sphere.center.z))
    return {{-infinity, -infinity, -infinity}, {infinity, infinity, infinity}};
  const double radius = sphere.radius * (1 + 0x1p-40);
  Aabb box;
  for (int axis = 0; axis < 3; ++axis) {
    box.min[axis] = round_down(sphere.center[axis] - radius);
    box.max[axis] = round_up(sphere.center[axis] + radius);
  }
  return box;
}

/// One object as the broad phase sees it: its box and, in sphere mode, the sphere that the box encloses.
struct ObjectVolume {
  Aabb box;
  BoundingSphere sphere;
};

/// The volumes of all slots as the broad phase last saw them, and the slots that changed in this step.
class VolumeStore {
 public:
  explicit VolumeStore(BoundingVolume kind) : has_spheres_(kind == BoundingVolume::sphere) {}

  /// Lists the slots whose volumes differ bit by bit from those of the step before; two empty volumes are
  /// equal. O(slots), or O(dirty log dirty) with a dirty list. With `keep_previous` the store holds the
  /// previous volumes until `take`; otherwise it takes the changed volumes here, while they are in the cache.
  /// `given` must live until the next call of a search has ended.
  void update(const ObjectVolumes& given, bool keep_previous, const Parallel& parallel);
  /// Slots that changed, ascending. A search must leave all of them taken.
  std::span<const std::uint32_t> changed() const { return {listed_.data(), changed_count_}; }
  void take(std::uint32_t slot);
  /// Takes all changed slots that are not taken yet.
  void take_changed();

  /// Slots of this step and those that the step before had beyond; the latter are empty.
  std::size_t slot_count() const { return boxes_.size(); }
  std::span<const Aabb> boxes() const { return boxes_; }
  /// Empty when the volumes are boxes; then boxes decide which pairs overlap, otherwise spheres.
  std::span<const BoundingSphere> spheres() const { return spheres_; }
  bool has_spheres() const { return has_spheres_; }
  ObjectVolume volume(std::uint32_t slot) const {
    return {boxes_[slot], has_spheres_ ? spheres_[slot] : BoundingSphere{}};
  }
  /// The volume that `take` will store.
  ObjectVolume incoming(std::uint32_t slot) const;
  /// The changed volumes are not taken yet.
  bool holds_previous() const { return !taken_; }
  /// Updates that found changes.
  std::uint64_t revision() const { return revision_; }

 private:
  bool is_changed(std::uint32_t slot) const;
  void list_dirty(std::span<const std::uint32_t> dirty);
  void compare_all(const Parallel& parallel);

  bool has_spheres_;
  bool taken_ = true;  // the store holds the changed volumes
  ObjectVolumes given_;
  std::size_t given_count_ = 0;
  std::uint64_t revision_ = 0;
  std::vector<Aabb> boxes_;
  std::vector<BoundingSphere> spheres_;
  std::vector<std::uint32_t> listed_;
  std::size_t changed_count_ = 0;
  std::vector<std::size_t> chunk_sizes_;
};

}  // namespace supple
