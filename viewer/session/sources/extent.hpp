#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <span>

#include "scene_view.hpp"
#include "sources/start.hpp"
#include "supple/simulation.hpp"
#include "supple/types.hpp"

namespace supple::viewer {

inline bool is_finite(const Vec3d& p) {
  return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}

/// A box in double; empty until a finite point is added.
struct Extent {
  Vec3d low{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity(),
            std::numeric_limits<double>::infinity()};
  Vec3d high = -1.0 * low;

  bool empty() const { return !(low.x <= high.x); }
  void add(const Vec3d& p) {
    if (!is_finite(p)) return;
    for (int axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], p[axis]);
      high[axis] = std::max(high[axis], p[axis]);
    }
  }
  void add(std::span<const Vec3d> points) {
    for (const Vec3d& p : points) add(p);
  }
  Vec3d center() const { return empty() ? Vec3d{} : low * 0.5 + high * 0.5; }
  Vec3d size() const { return empty() ? Vec3d{} : high - low; }
  double longest_side() const { return std::max({size().x, size().y, size().z}); }
};

/// The box around all objects at the start, and around the border when it is finite.
inline Extent extent_of(const SceneView& show) {
  Extent extent;
  for (const ViewedObject& object : show.objects) extent.add(start_of(show, object).positions);
  const std::optional<Border>& border = show.simulation.border;
  if (border && is_finite((*border)[0]) && is_finite((*border)[1])) extent.add(*border);
  return extent;
}

}  // namespace supple::viewer
