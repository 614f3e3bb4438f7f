#pragma once

#include <cmath>
#include <cstddef>
#include <limits>

#include "broad_phase/pair_finder.hpp"
#include "core/float_rounding.hpp"
#include "geometry/sphere.hpp"

namespace supple {

/// A box that overlaps the box of every ball which `overlap(ball, ball)` reports with this one.
///
/// Reported balls have |c1 - c2| <= (r1 + r2)(1 + 2^-48) along each axis, the factor covering the slack of
/// that test and its roundings. With R = fl(r (1 + 2^-40)) this gives c1 - R1 <= c2 + R2, and rounding is
/// monotone, so the rounded ends compare the same way. A ball with anything not finite can pass that test
/// with any other (infinity minus infinity is NaN, and NaN overlaps): its box is all of space.
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

/// One object as the broad phase sees it: its box, and in sphere mode the ball that the box encloses.
struct ObjectVolume {
  Aabb box;
  BoundingSphere sphere;

  bool empty() const { return box.empty(); }
};

inline std::size_t slot_count(const ObjectVolumes& volumes, BoundingVolume kind) {
  return kind == BoundingVolume::sphere ? volumes.spheres.size() : volumes.boxes.size();
}

/// The volume in a slot; the canonical empty one when the slot is past the end or its volume empty.
inline ObjectVolume volume_at(const ObjectVolumes& volumes, BoundingVolume kind, std::size_t slot) {
  if (slot >= slot_count(volumes, kind)) return {};
  if (kind == BoundingVolume::sphere) {
    const BoundingSphere& sphere = volumes.spheres[slot];
    return sphere.empty() ? ObjectVolume{} : ObjectVolume{bounding_box(sphere), sphere};
  }
  const Aabb& box = volumes.boxes[slot];
  return box.empty() ? ObjectVolume{} : ObjectVolume{box, {}};
}

}  // namespace supple
