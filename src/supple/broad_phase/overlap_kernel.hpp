#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "broad_phase/pair_sorter.hpp"
#include "supple/types.hpp"

namespace supple {

/// A key that sorts slots by the lower ends of their boxes. -0 precedes +0.
inline std::uint64_t order_key(float low, std::uint32_t slot) {
  const auto bits = std::bit_cast<std::uint32_t>(low);
  return std::uint64_t{bits ^ ((bits >> 31) != 0 ? 0xffffffffu : 0x80000000u)} << 32 | slot;
}

/// Boxes as a structure of arrays, for kernels that test one box against many.
struct BoxLanes {
  std::array<std::vector<float>, 3> min, max;
  std::vector<std::uint32_t> slots;
  /// A bit per axis: the box begins in this part of space. A pair is reported where one of its boxes begins
  /// along each axis. All are 7 when space is not divided.
  std::vector<std::uint32_t> begins;
  std::size_t count = 0;
  /// By ascending lower end along axis 0. The tests of a box then end at the first box that begins behind it.
  bool is_sorted = false;

  /// Makes room for `new_count` boxes, all of which must be set. The lanes behind them get NaN, which
  /// overlaps nothing.
  void resize(std::size_t new_count);
  /// `first_axis` becomes axis 0 of the lanes. The others follow in cyclic order.
  void set(std::size_t lane, std::uint32_t slot, const Aabb& box, std::uint32_t begins_here = 7,
           int first_axis = 0) {
    for (int k = 0; k < 3; ++k) {
      const auto axis = static_cast<std::size_t>((k + 3 - first_axis) % 3);
      min[axis][lane] = box.min[k];
      max[axis][lane] = box.max[k];
    }
    slots[lane] = slot;
    begins[lane] = begins_here;
  }
};

/// Tests each of the lanes [begin, end) against all lanes behind it. Adds the pairs that overlap and begin
/// here to `pairs`. When spheres are given, per slot, their overlap decides. Returns the number of tests,
/// which is the same for every instruction set.
std::uint64_t find_overlaps(const BoxLanes& boxes, std::size_t begin, std::size_t end,
                            std::span<const BoundingSphere> spheres, PairList& pairs);

}  // namespace supple
