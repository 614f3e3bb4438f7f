#include "broad_phase/move_kernel.hpp"

#include <algorithm>
#include <bit>
#include <utility>

#include "geometry/aabb.hpp"
#include "geometry/sphere.hpp"

// Highway compiles the rest of this file once for each instruction set, and picks one when the program runs.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "broad_phase/move_kernel.cpp"
#include <hwy/foreach_target.h>

#include <hwy/cache_control.h>
#include <hwy/highway.h>

#include "broad_phase/measure-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace supple {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

/// Of some boxes, bit 4 k for the k-th: it overlaps another surely, or perhaps.
struct Overlaps {
  std::uint32_t sure, perhaps;
};

#if HWY_TARGET == HWY_SCALAR
constexpr std::size_t boxes_at_once() {
  return 1;
}

/// What the ends of boxes must not pass, less one in each half of a word.
using Bounds = std::array<std::uint32_t, 3>;

Bounds bounds_of(const MeasuredBox& box) {
  Bounds bounds;
  for (std::size_t axis = 0; axis < 3; ++axis) bounds[axis] = ~std::rotl(box.ends[axis], 16) - 0x00010001u;
  return bounds;
}

Overlaps compare(const MeasuredBox* box, const Bounds& bounds) {
  std::uint32_t over = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::uint32_t end = box->ends[axis], bound = bounds[axis];
    over |= (end & 0xffff) - std::min(end & 0xffff, bound & 0xffff);
    over |= ((end >> 16) - std::min(end >> 16, bound >> 16)) << 16;
  }
  return {over == 0 ? 1u : 0u, (over & 0xfffefffe) == 0 ? 1u : 0u};
}

std::uint32_t whole_boxes_near(const MeasuredBox* box, const Bounds& bounds) {
  return compare(box, bounds).perhaps;
}

bool meet(const MeasuredBox& a, const MeasuredBox& b) {
  return compare(&a, bounds_of(b)).perhaps != 0;
}

MeasuredBox hull_of(const MeasuredBox& a, const MeasuredBox& b) {
  MeasuredBox hull{};
  for (std::size_t axis = 0; axis < 3; ++axis)
    hull.ends[axis] = std::min(a.ends[axis] & 0xffff, b.ends[axis] & 0xffff) |
                      std::min(a.ends[axis] >> 16, b.ends[axis] >> 16) << 16;
  return hull;
}
#else
using Words = hn::CappedTag<std::uint32_t, kMaxLanes>;
using Halves = hn::Repartition<std::uint16_t, Words>;
using OneBox = hn::Full128<std::uint32_t>;

HWY_INLINE std::size_t boxes_at_once() {
  return hn::Lanes(Words()) / 4;
}

/// What the ends of boxes must not pass, less one in each half of a word; the same for each box of a vector.
using Bounds = hn::Vec<Halves>;

HWY_INLINE hn::Vec<OneBox> one_bounds_of(const MeasuredBox& box) {
  const OneBox words;
  const auto ends = hn::Load(words, box.ends.data());
  const auto swapped = hn::Or(hn::ShiftLeft<16>(ends), hn::ShiftRight<16>(ends));
  return hn::Sub(hn::Not(swapped), hn::Set(words, 0x00010001u));
}

HWY_INLINE Bounds bounds_of(const MeasuredBox& box) {
  alignas(16) std::array<std::uint32_t, 4> bounds;
  hn::Store(one_bounds_of(box), OneBox(), bounds.data());
  return hn::BitCast(Halves(), hn::LoadDup128(Words(), bounds.data()));
}

/// Whether two boxes meet, as far as steps tell.
HWY_INLINE bool meet(const MeasuredBox& a, const MeasuredBox& b) {
  const OneBox words;
  const hn::Repartition<std::uint16_t, OneBox> halves;
  const auto ends = hn::BitCast(halves, hn::Load(words, a.ends.data()));
  const auto over = hn::BitCast(words, hn::SaturatedSub(ends, hn::BitCast(halves, one_bounds_of(b))));
  const auto within = hn::Eq(hn::And(over, hn::Set(words, 0xfffefffeu)), hn::Zero(words));
  return hn::CountTrue(words, hn::And(within, hn::FirstN(words, 3))) == 3;
}

template <class Mask>
HWY_INLINE std::uint32_t whole_boxes(Mask words) {
  std::array<std::uint8_t, 8> bytes{};
  hn::StoreMaskBits(Words(), words, bytes.data());
  const std::uint32_t bits = bytes[0] + 256u * bytes[1];
  return bits & bits >> 1 & bits >> 2 & 0x1111;
}

/// Nothing is left of an end that is surely within its bound, 1 of one that is in the same step.
HWY_INLINE Overlaps compare(const MeasuredBox* boxes, Bounds bounds) {
  const Words words;
  const auto ends = hn::LoadU(words, boxes->ends.data());
  const auto over = hn::BitCast(words, hn::SaturatedSub(hn::BitCast(Halves(), ends), bounds));
  const auto apart = hn::And(over, hn::Set(words, 0xfffefffeu));
  return {whole_boxes(hn::Eq(over, hn::Zero(words))), whole_boxes(hn::Eq(apart, hn::Zero(words)))};
}

HWY_INLINE std::uint32_t whole_boxes_near(const MeasuredBox* boxes, Bounds bounds) {
  const Words words;
  const auto ends = hn::LoadU(words, boxes->ends.data());
  const auto over = hn::BitCast(words, hn::SaturatedSub(hn::BitCast(Halves(), ends), bounds));
  return whole_boxes(hn::Eq(hn::And(over, hn::Set(words, 0xfffefffeu)), hn::Zero(words)));
}

HWY_INLINE MeasuredBox hull_of(const MeasuredBox& a, const MeasuredBox& b) {
  const OneBox words;
  const hn::Repartition<std::uint16_t, OneBox> halves;
  const auto load = [&](const MeasuredBox& box)
                        HWY_ATTR { return hn::BitCast(halves, hn::Load(words, box.ends.data())); };
  MeasuredBox hull;
  hn::Store(hn::BitCast(words, hn::Min(load(a), load(b))), words, hull.ends.data());
  return hull;
}
#endif

/// Divisions of one axis in which boxes of a level may begin that this one meets.
struct Span {
  std::uint32_t first, last;
};
HWY_INLINE Span span_of(const BoxRows& rows, std::uint32_t ends, std::size_t axis) {
  const std::uint32_t low = ends & 0xffff;
  return {rows.division(axis, low - std::min(low, rows.reach[axis])),
          rows.division(axis, 0xffff - (ends >> 16))};
}

/// Where a box was, or is: nowhere when it is empty.
struct Whereabouts {
  MeasuredBox steps;
  std::array<std::uint32_t, 4> extents;
  bool is_somewhere;
};

/// Cells that follow one another in a row: the first, and the one behind the last.
struct CellRange {
  const std::uint32_t *first, *last;
};

/// A box on its way.
struct Move {
  std::uint32_t slot;
  bool is_far;  // from where it was, so that what is between does not matter
  Whereabouts was, is;
  MeasuredBox hull;
  std::size_t range_count;
  std::array<CellRange, 8> ranges;  // that the hull meets, when it is not far and there are no more
};

class Mover {
 public:
  Mover(BoxCells& cells, const BoxMoves& moves, std::span<Aabb> boxes, std::span<BoundingSphere> spheres,
        std::vector<std::uint64_t>& toggled)
      : cells_(cells),
        moves_(moves),
        boxes_(boxes),
        spheres_(spheres),
        toggled_(toggled),
        measure_(cells.measure()) {}

  /// Finds the cells and asks for them.
  HWY_INLINE void prepare(std::size_t i, Move& move) const {
    move.slot = moves_.slots[i];
    const auto measure = [&](const Aabb& box, Whereabouts& out)
                             HWY_ATTR { out.is_somewhere = measure_.ends(box, out.steps, out.extents); };
    measure(boxes_[move.slot], move.was);
    measure(moves_.boxes[i], move.is);
    move.is_far = !move.was.is_somewhere || !move.is.is_somewhere || !meet(move.was.steps, move.is.steps);
    move.range_count = 0;
    if (move.is_far) return;
    move.hull = hull_of(move.was.steps, move.is.steps);
    for_ranges(move.hull, [&](CellRange range) HWY_ATTR {
      hwy::Prefetch(range.first);
      hwy::Prefetch(range.last);
      if (move.range_count < move.ranges.size()) move.ranges[move.range_count] = range;
      ++move.range_count;
    });
  }

  HWY_INLINE void fetch_boxes(const Move& move) const {
    for (std::size_t k = 0; k < std::min(move.range_count, move.ranges.size()); ++k) {
      constexpr std::size_t kMost = 64, kInLine = 4;
      const std::size_t begin = *move.ranges[k].first;
      const std::size_t end = std::min<std::size_t>(*move.ranges[k].last, begin + kMost);
      for (std::size_t place = begin; place < end; place += kInLine) hwy::Prefetch(cells_.boxes() + place);
    }
  }

  HWY_INLINE bool carry_out(std::size_t i, const Move& move, std::uint64_t reach_version) {
    slot_ = move.slot;
    const Whereabouts &was = move.was, &is = move.is;
    BoundingSphere old_sphere, new_sphere;
    const Aabb old_box = boxes_[slot_];
    boxes_[slot_] = moves_.boxes[i];
    if (!spheres_.empty()) {
      old_sphere = std::exchange(spheres_[slot_], moves_.spheres[i]);
      new_sphere = moves_.spheres[i];
    }
    const Side before{&was, &old_box, &old_sphere}, after{&is, &moves_.boxes[i], &new_sphere};
    std::uint32_t old_cell = 0;
    std::size_t old_place = 0;
    if (was.is_somewhere) {
      old_cell = cells_.cell_of(cells_.measure().level_of(was.extents), was.steps);
      old_place = cells_.take_out(old_cell, slot_);
    }
    if (move.is_far) {
      if (was.is_somewhere) search(was.steps, before, {});
      if (is.is_somewhere) search(is.steps, {}, after);
    } else if (move.range_count <= move.ranges.size() && reach_version == cells_.reach_version()) {
      const Bounds bounds = bounds_of(move.hull);
      for (std::size_t k = 0; k < move.range_count; ++k) search_range(move.ranges[k], bounds, before, after);
    } else {
      search(move.hull, before, after);
    }
    if (!is.is_somewhere) return true;
    MeasuredBox steps = is.steps;
    steps.slot = slot_;
    const std::size_t level = cells_.measure().level_of(is.extents);
    cells_.reach_to(level, is.extents);
    const std::uint32_t cell = cells_.cell_of(level, steps);
    if (!was.is_somewhere || cell != old_cell) return cells_.put_in(cell, steps);
    cells_.put_back(old_place, steps);
    return true;
  }
  std::int64_t tests() const { return tests_; }

 private:
  /// What decides where steps do not.
  struct Side {
    const Whereabouts* place = nullptr;
    const Aabb* box = nullptr;
    const BoundingSphere* sphere = nullptr;
  };

  template <class Visit>
  HWY_INLINE void for_ranges(const MeasuredBox& part, const Visit& visit) const {
    const auto& axes = cells_.measure().axes;
    for (const BoxRows& rows : cells_.levels()) {
      const Span cells = span_of(rows, part.ends[axes[0]], 0), second = span_of(rows, part.ends[axes[1]], 1),
                 third = span_of(rows, part.ends[axes[2]], 2);
      for (std::uint32_t k = third.first; k <= third.last; ++k) {
        const std::size_t row = std::size_t{k * rows.divisions[1] + second.first} * rows.divisions[0];
        const std::uint32_t* begins = cells_.begins() + rows.first_cell + row;
        for (std::uint32_t i = second.first; i <= second.last; ++i, begins += rows.divisions[0])
          visit({begins + cells.first, begins + cells.last + 1});
      }
    }
  }

  void search(const MeasuredBox& part, const Side& was, const Side& is) {
    const Bounds bounds = bounds_of(part);
    for_ranges(part, [&](CellRange range) HWY_ATTR { search_range(range, bounds, was, is); });
  }

  HWY_INLINE void search_range(CellRange range, Bounds bounds, const Side& was, const Side& is) {
    const MeasuredBox* const boxes = cells_.boxes();
    const std::size_t begin = *range.first, end = *range.last, step = boxes_at_once();
    tests_ += static_cast<std::int64_t>(end - begin);
    for (std::size_t j = begin; j < end; j += step) {
      const std::uint32_t in_range = end - j < step ? (1u << 4 * (end - j)) - 1 : 0x1111;
      const std::uint32_t near = whole_boxes_near(boxes + j, bounds) & in_range;
      if (near != 0) toggle(boxes + j, near, was, is);
    }
  }

  /// Of those that are near, the ones that overlap one of the two and not the other.
  HWY_NOINLINE void toggle(const MeasuredBox* boxes, std::uint32_t near, const Side& was, const Side& is) {
    const Overlaps none{0, 0};
    const Overlaps before = was.place != nullptr ? compare(boxes, bounds_of(was.place->steps)) : none;
    const Overlaps after = is.place != nullptr ? compare(boxes, bounds_of(is.place->steps)) : none;
    std::uint32_t unsure = near;
    if (spheres_.empty()) unsure &= (before.perhaps ^ before.sure) | (after.perhaps ^ after.sure);
    std::uint32_t differ = near & ~unsure & (before.sure ^ after.sure);
    for (; unsure != 0; unsure &= unsure - 1) {
      const std::uint32_t other = boxes[std::countr_zero(unsure) / 4].slot;
      if (overlaps(was, other) != overlaps(is, other)) differ |= unsure & -unsure;
    }
    for (; differ != 0; differ &= differ - 1) {
      const std::uint32_t other = boxes[std::countr_zero(differ) / 4].slot;
      toggled_.push_back(std::uint64_t{std::min(slot_, other)} << 32 | std::max(slot_, other));
    }
  }

  bool overlaps(const Side& side, std::uint32_t other) const {
    if (side.place == nullptr) return false;
    return spheres_.empty() ? overlap(*side.box, boxes_[other]) : overlap(*side.sphere, spheres_[other]);
  }

  BoxCells& cells_;
  const BoxMoves& moves_;
  std::span<Aabb> boxes_;
  std::span<BoundingSphere> spheres_;
  std::vector<std::uint64_t>& toggled_;
  Measure measure_;
  std::uint32_t slot_ = 0;
  std::int64_t tests_ = 0;
};

bool move(BoxCells& cells, const BoxMoves& moves, std::span<Aabb> boxes, std::span<BoundingSphere> spheres,
          std::int64_t& tests, std::vector<std::uint64_t>& toggled) {
  constexpr std::size_t kBatch = 16;
  Mover mover(cells, moves, boxes, spheres, toggled);
  std::array<Move, kBatch> batch;
  bool has_room = true;
  for (std::size_t begin = 0; has_room && begin < moves.slots.size(); begin += kBatch) {
    // What one needs is asked for while others are worked on.
    const std::size_t count = std::min(kBatch, moves.slots.size() - begin);
    const std::uint64_t reach_version = cells.reach_version();
    for (std::size_t i = 0; i < count; ++i) mover.prepare(begin + i, batch[i]);
    for (std::size_t i = 0; i < count; ++i) mover.fetch_boxes(batch[i]);
    for (std::size_t i = 0; has_room && i < count; ++i)
      has_room = mover.tests() < tests && mover.carry_out(begin + i, batch[i], reach_version);
  }
  tests -= mover.tests();
  return has_room;
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace supple
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace supple {

HWY_EXPORT(move);

bool move_boxes(BoxCells& cells, const BoxMoves& moves, std::span<Aabb> boxes,
                std::span<BoundingSphere> spheres, std::int64_t& tests, std::vector<std::uint64_t>& toggled) {
  return HWY_DYNAMIC_DISPATCH(move)(cells, moves, boxes, spheres, tests, toggled);
}

}  // namespace supple
#endif
