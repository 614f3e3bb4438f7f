#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "core/float_rounding.hpp"
#include "core/parallel.hpp"
#include "geometry/sphere.hpp"
#include "supple/broad_phase.hpp"
#include "supple/options.hpp"

namespace supple {

/// The wanted pairs of kinds: for each kind a bit for each kind that it is paired with.
class WantedKinds {
 public:
  /// All volumes have the kind 0 and are paired.
  WantedKinds() : partners_{1} {}
  /// Nothing else is paired, unless the list is empty.
  explicit WantedKinds(std::span<const KindPair> pairs) : has_kinds_(!pairs.empty()) {
    partners_[0] = has_kinds_ ? 0 : 1;
    for (const auto [a, b] : pairs) {
      partners_[a] = static_cast<std::uint8_t>(partners_[a] | 1u << b);
      partners_[b] = static_cast<std::uint8_t>(partners_[b] | 1u << a);
    }
  }
  bool has_kinds() const { return has_kinds_; }
  std::uint32_t partners(std::size_t kind) const { return partners_[kind]; }
  bool are_paired(std::size_t a, std::size_t b) const { return (partners_[a] >> b & 1) != 0; }

 private:
  static_assert(volume_kind_count == 8, "a byte has a bit for each kind");
  std::array<std::uint8_t, volume_kind_count> partners_{};
  bool has_kinds_ = false;
};

/// The volumes that a caller gives for one step, by slot: boxes or spheres. The volumes of removed objects
/// are empty. A box with a NaN is empty.
struct ObjectVolumes {
  std::span<const Aabb> boxes{};
  std::span<const BoundingSphere> spheres{};
  std::span<const std::uint8_t> kinds{};  ///< as many as volumes if the kinds are wanted, otherwise empty
  /// The dirty list: slots whose volumes may differ from the step before, in any order; repeats are allowed.
  /// Without a list all volumes are compared. Slots that are new or gone need not be listed.
  std::optional<std::span<const std::uint32_t>> dirty{};
};

/// A box around the sphere. The boxes of two spheres overlap whenever `overlap` reports the spheres.
///
/// Reported spheres have |c1 - c2| <= (r1 + r2)(1 + 2^-48) along each axis. The factor covers the slack of
/// `overlap` and its roundings. With R = fl(r (1 + 2^-40)) this gives c1 - R1 <= c2 + R2. Rounding is
/// monotone, so the rounded ends compare the same way. A sphere with a number that is not finite may be
/// reported with any other sphere (infinity minus infinity is NaN, and NaN overlaps), so its box is all of
/// space.
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

/// The volumes of all slots in the present step, and the slots that changed since the step before.
class VolumeStore {
 public:
  explicit VolumeStore(BoundingVolume bounding_volume, const WantedKinds& wanted = {})
      : has_spheres_(bounding_volume == BoundingVolume::sphere), wanted_(wanted) {}

  /// Copies the volumes that differ bit by bit, or in their kind, from those of the step before, and lists
  /// their slots. Two empty volumes are equal. A volume whose kind has no partner is stored as empty.
  /// O(slots), or O(dirty log dirty) with a dirty list.
  void update(const ObjectVolumes& given, const Parallel& parallel);
  /// Slots that changed, ascending.
  std::span<const std::uint32_t> changed() const { return changed_; }
  /// The number of updates that found changes.
  std::uint64_t revision() const { return revision_; }

  /// The larger number of slots of this step and the step before. Slots past the end of this step are empty.
  std::size_t slot_count() const { return boxes_.size(); }
  std::span<const Aabb> boxes() const { return boxes_; }
  /// Empty when the volumes are boxes; then boxes decide which pairs overlap, otherwise spheres.
  std::span<const BoundingSphere> spheres() const { return spheres_; }
  const WantedKinds& wanted() const { return wanted_; }
  /// The volume must not be empty.
  std::size_t kind(std::uint32_t slot) const { return wanted_.has_kinds() ? kinds_[slot] : 0; }
  ObjectVolume volume(std::uint32_t slot) const {
    return {boxes_[slot], has_spheres_ ? spheres_[slot] : BoundingSphere{}};
  }

 private:
  bool take_volume_if_changed(const ObjectVolumes& given, std::uint32_t slot, bool has_partner);
  bool take_kind_if_changed(const ObjectVolumes& given, std::uint32_t slot);
  bool take_if_changed(const ObjectVolumes& given, std::uint32_t slot);
  bool is_same_block(const ObjectVolumes& given, std::size_t begin, std::size_t end) const;

  bool has_spheres_;
  WantedKinds wanted_;
  std::size_t given_count_ = 0;  // volumes of this step
  std::uint64_t revision_ = 0;
  std::vector<Aabb> boxes_;
  std::vector<BoundingSphere> spheres_;
  std::vector<std::uint8_t> kinds_;  // empty unless kinds are wanted
  std::vector<std::uint32_t> changed_;
  std::vector<std::uint8_t> is_changed_;  // per slot, without a dirty list
};

}  // namespace supple
