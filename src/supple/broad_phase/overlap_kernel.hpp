#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "broad_phase/pair_sorter.hpp"
#include "broad_phase/volume_store.hpp"
#include "supple/types.hpp"

namespace supple {

/// A key that sorts slots by the lower ends of their boxes. -0 precedes +0.
inline std::uint64_t order_key(float low, std::uint32_t slot) {
  const auto bits = std::bit_cast<std::uint32_t>(low);
  return std::uint64_t{bits ^ ((bits >> 31) != 0 ? 0xffffffffu : 0x80000000u)} << 32 | slot;
}

/// Which pairs of a box are reported.
struct PairMarks {
  /// A bit per axis: the box begins in this part of space. A pair is reported where one of its boxes begins
  /// along each axis. All are set when space is not divided.
  static constexpr std::uint32_t begins = 7;
  static constexpr int partners_shift = 8, kind_shift = 16;
  std::uint32_t bits;

  explicit PairMarks(std::uint32_t begins_here) : bits(begins_here) {}
  /// `partners` has a bit for each kind that the kind of the box is paired with.
  PairMarks(std::uint32_t begins_here, std::size_t kind, std::uint32_t partners)
      : bits(begins_here | partners << partners_shift | static_cast<std::uint32_t>(kind) << kind_shift) {}
  /// With kinds: the bits that the marks of two boxes must have, if one of them has these marks. The bits of
  /// `begins` may be in either, the others are in the other.
  static std::uint32_t required(std::uint32_t marks) {
    return begins | 1u << partners_shift << (marks >> kind_shift);
  }
};

inline PairMarks marks_of(const VolumeStore& volumes, std::uint32_t slot,
                          std::uint32_t begins_here = PairMarks::begins) {
  if (!volumes.wanted().has_kinds()) return PairMarks(begins_here);
  const std::size_t kind = volumes.kind(slot);
  return {begins_here, kind, volumes.wanted().partners(kind)};
}

/// Boxes as a structure of arrays, for kernels that test one box against many.
struct BoxLanes {
  std::array<std::vector<float>, 3> min, max;
  std::vector<std::uint32_t> slots;
  std::vector<std::uint32_t> marks;  ///< `PairMarks::bits`
  std::size_t count = 0;
  /// By ascending lower end along axis 0. The tests of a box then end at the first box that begins behind it.
  bool is_sorted = false;

  /// Makes room for `new_count` boxes, all of which must be set. The lanes behind them get NaN, which
  /// overlaps nothing.
  void resize(std::size_t new_count);
  /// `first_axis` becomes axis 0 of the lanes. The others follow in cyclic order.
  void set(std::size_t lane, std::uint32_t slot, const Aabb& box, PairMarks box_marks, int first_axis = 0) {
    for (int k = 0; k < 3; ++k) {
      const auto axis = static_cast<std::size_t>((k + 3 - first_axis) % 3);
      min[axis][lane] = box.min[k];
      max[axis][lane] = box.max[k];
    }
    slots[lane] = slot;
    marks[lane] = box_marks.bits;
  }
};

/// Tests each of the lanes [begin, end) against all lanes behind it. Adds the pairs that overlap, begin here
/// and have paired kinds to `pairs`. When the volumes are spheres, their overlap decides. Returns the number
/// of tests, which is the same for every instruction set.
std::uint64_t find_overlaps(const BoxLanes& boxes, std::size_t begin, std::size_t end,
                            const VolumeStore& volumes, PairList& pairs);

}  // namespace supple
