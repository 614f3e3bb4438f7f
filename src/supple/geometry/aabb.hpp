#pragma once

#include <algorithm>

#include "core/float_rounding.hpp"
#include "supple/types.hpp"

namespace supple {

/// Whether two closed boxes overlap; touching counts. Exact.
inline bool overlap(const Aabb& a, const Aabb& b) {
  return a.min.x <= b.max.x && b.min.x <= a.max.x && a.min.y <= b.max.y && b.min.y <= a.max.y &&
         a.min.z <= b.max.z && b.min.z <= a.max.z;
}

inline void extend(Aabb& box, const Aabb& other) {
  for (int axis = 0; axis < 3; ++axis) {
    box.min[axis] = std::min(box.min[axis], other.min[axis]);
    box.max[axis] = std::max(box.max[axis], other.max[axis]);
  }
}

/// Adds a finite point to the box; bounds round outward.
template <class Scalar>
void extend(Aabb& box, const Vec3<Scalar>& point) {
  for (int axis = 0; axis < 3; ++axis) {
    box.min[axis] = std::min(box.min[axis], round_down(point[axis]));
    box.max[axis] = std::max(box.max[axis], round_up(point[axis]));
  }
}

/// The box that is larger by this on all sides, rounded outward.
inline Aabb grown(const Aabb& box, double by) {
  if (by == 0 || box.empty()) return box;
  Aabb result;
  for (int axis = 0; axis < 3; ++axis) {
    result.min[axis] = round_down(box.min[axis] - by);
    result.max[axis] = round_up(box.max[axis] + by);
  }
  return result;
}

/// The squared distance of two boxes, rounded.
template <class Box>
double squared_gap(const Box& a, const Box& b) {
  double square = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double gap = std::max({double{a.min[axis]} - b.max[axis], double{b.min[axis]} - a.max[axis], 0.0});
    square += gap * gap;
  }
  return square;
}

/// Encloses fl(p + offset) for every p in the box, because the rounded sum is monotonic.
inline Aabb moved(const Aabb& box, const Vec3d& offset) {
  if (offset == Vec3d{} || box.empty()) return box;
  Aabb result;
  for (int axis = 0; axis < 3; ++axis) {
    result.min[axis] = round_down(double{box.min[axis]} + offset[axis]);
    result.max[axis] = round_up(double{box.max[axis]} + offset[axis]);
  }
  return result;
}

/// The intersection of two boxes; `empty()` when they are apart.
inline Aabb shared_box(const Aabb& a, const Aabb& b) {
  Aabb result;
  for (int axis = 0; axis < 3; ++axis) {
    result.min[axis] = std::max(a.min[axis], b.min[axis]);
    result.max[axis] = std::min(a.max[axis], b.max[axis]);
  }
  return result;
}

/// Half the surface area of the box; 0 when it is empty.
inline double half_surface(const Aabb& box) {
  const auto extent = [&](int axis) { return std::max(0.0, double{box.max[axis]} - double{box.min[axis]}); };
  return extent(0) * extent(1) + extent(1) * extent(2) + extent(2) * extent(0);
}

}  // namespace supple
