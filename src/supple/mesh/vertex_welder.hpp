#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "supple/types.hpp"

namespace supple {

/// Gives equal points one id, numbered by first use, for formats that repeat a vertex for each corner. The
/// first of equal points is kept. -0 equals +0. A point with a NaN equals no point, not even itself.
class VertexWelder {
 public:
  std::uint32_t id_of(const Vec3d& point) {
    if (2 * (points_.size() + 1) > slots_.size()) grow();
    const auto id = static_cast<std::uint32_t>(points_.size());
    if (std::isnan(point.x) || std::isnan(point.y) || std::isnan(point.z)) {
      points_.push_back(point);
      return id;
    }
    std::uint32_t& slot = slots_[slot_of(point)];
    if (slot == empty_slot) {
      slot = id;
      points_.push_back(point);
    }
    return slot;
  }

  std::vector<Vec3d> take_points() { return std::exchange(points_, {}); }

 private:
  static constexpr std::uint32_t empty_slot = std::numeric_limits<std::uint32_t>::max();

  // The slot of the point, or the slot for it when it is new, by linear probing. The table is never iterated,
  // so the hash does not affect any order.
  std::size_t slot_of(const Vec3d& point) const {
    const std::size_t mask = slots_.size() - 1;
    std::size_t slot = hash(point) & mask;
    while (slots_[slot] != empty_slot && points_[slots_[slot]] != point) slot = (slot + 1) & mask;
    return slot;
  }

  static std::size_t hash(const Vec3d& point) {
    std::uint64_t bits = 0;
    for (int axis = 0; axis < 3; ++axis) {
      // Adding zero turns -0 into +0: they compare equal, so they must have the same hash.
      bits = (bits ^ std::bit_cast<std::uint64_t>(point[axis] + 0.0)) * 0x9e3779b97f4a7c15u;
      bits ^= bits >> 32;
    }
    return static_cast<std::size_t>(bits);
  }

  void grow() {
    slots_.assign(slots_.empty() ? 64 : 2 * slots_.size(), empty_slot);
    for (std::uint32_t id = 0; id < points_.size(); ++id) {
      const Vec3d& point = points_[id];
      if (point == point) slots_[slot_of(point)] = id;
    }
  }

  std::vector<Vec3d> points_;
  std::vector<std::uint32_t>
      slots_;  // ids of points; the size is a power of two, and at most half of the slots are used
};

}  // namespace supple
