#include <hwy/highway.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "contest/baselines/sorted_boxes.hpp"
#include "contest/peers/peers.hpp"

namespace supple::benchmarks {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using Lanes = hn::CappedTag<float, 16>;
using Flags = hn::RebindToUnsigned<Lanes>;

template <class Mask>
std::uint32_t bits_of(const Mask& mask) {
  std::uint8_t bytes[8] = {};
  hn::StoreMaskBits(Lanes(), mask, bytes);
  return bytes[0] + 256u * bytes[1];
}

/// The columns along one axis.
struct Division {
  double low = 0, columns_per_unit = 0;
  std::uint32_t count = 1;

  std::uint32_t column(float x) const {
    const double place = (x - low) * columns_per_unit;
    return place <= 0 ? 0 : std::min(static_cast<std::uint32_t>(place), count - 1);
  }
};

class BaselineGrid : public BoxContestant {
 public:
  void prepare(const MovingBoxes&) override {}
  void frame(const MovingBoxes& field) override {
    const std::span<const Aabb> boxes = field.boxes();
    const BoxSpread spread = spread_of(boxes);
    axis_ = spread.widest_axis;
    divide(spread, boxes.size());
    const auto order = sorter_.sort(boxes, axis_);
    deal_out(boxes, order);
    pairs_.clear();
    for (std::size_t column = 0; column + 1 < starts_.size(); ++column) {
      if (starts_[column + 1] - starts_[column] < 2) continue;
      load_column(starts_[column], starts_[column + 1]);
      sweep(starts_[column + 1] - starts_[column]);
    }
  }
  PairDigest pairs() const override {
    PairDigest digest;
    for (const IndexPair& pair : pairs_) digest.add(pair.a, pair.b);
    return digest;
  }

 private:
  /// Chooses columns so that the sweep compares each box with about one vector of others. A column is not
  /// much narrower than the boxes, because narrow columns would put each box in many of them.
  void divide(const BoxSpread& spread, std::size_t count) {
    constexpr double others_wanted = 8, narrowest_in_extents = 1.5;
    const double length = std::max(spread.high[axis_] - spread.low[axis_], 1e-30);
    const double others = static_cast<double>(count) * spread.mean_extent[axis_] / length;
    const double a_side = std::sqrt(std::max(others / others_wanted, 1.0));
    for (int k = 0; k < 2; ++k) {
      const int axis = (axis_ + 1 + k) % 3;
      const double width = std::max(spread.high[axis] - spread.low[axis], 1e-30);
      const double most = width / (narrowest_in_extents * std::max(spread.mean_extent[axis], 1e-30));
      divisions_[k].count = static_cast<std::uint32_t>(std::clamp(std::min(a_side, most), 1.0, 2048.0));
      divisions_[k].low = spread.low[axis];
      divisions_[k].columns_per_unit = divisions_[k].count / width;
    }
  }

  /// A copy of a box in one of its columns. Bits of `flags` are the axes along which it starts there.
  struct alignas(32) Entry {
    Aabb box;
    std::uint32_t number = 0, flags = 0;
  };

  /// Calls `visit` for each box in sorted order and each of its columns.
  template <class Visit>
  void for_each_column(Visit visit) {
    const int first = (axis_ + 1) % 3, second = (axis_ + 2) % 3;
    for (const Entry& entry : sorted_) {
      const Vec3f &low = entry.box.min, &high = entry.box.max;
      const std::uint32_t u0 = divisions_[0].column(low[first]), u1 = divisions_[0].column(high[first]);
      const std::uint32_t v0 = divisions_[1].column(low[second]), v1 = divisions_[1].column(high[second]);
      for (std::uint32_t u = u0; u <= u1; ++u) {
        for (std::uint32_t v = v0; v <= v1; ++v)
          visit(entry, u * divisions_[1].count + v, (u == u0 ? 1u : 0u) + (v == v0 ? 2u : 0u));
      }
    }
  }

  void deal_out(std::span<const Aabb> boxes, std::span<const std::uint32_t> order) {
    sorted_.resize(boxes.size());
    for (std::size_t i = 0; i < order.size(); ++i) sorted_[i] = {boxes[order[i]], order[i], 0};
    const std::size_t columns = std::size_t{divisions_[0].count} * divisions_[1].count;
    starts_.assign(columns + 1, 0);
    for_each_column([&](const Entry&, std::uint32_t column, std::uint32_t) { ++starts_[column + 1]; });
    for (std::size_t i = 0; i < columns; ++i) starts_[i + 1] += starts_[i];
    entries_.resize(starts_[columns]);
    places_.assign(starts_.begin(), starts_.end());
    for_each_column([&](const Entry& entry, std::uint32_t column, std::uint32_t flags) {
      entries_[places_[column]++] = {entry.box, entry.number, flags};
    });
  }

  void load_column(std::size_t first, std::size_t last) {
    if (column_.number.size() < last - first + 16) {
      column_.resize(2 * (last - first));
      flags_.resize(column_.number.size());
    }
    for (std::size_t i = 0; i < last - first; ++i) {
      const Entry& entry = entries_[first + i];
      for (int k = 0; k < 3; ++k) {
        column_.low[k][i] = entry.box.min[(axis_ + k) % 3];
        column_.high[k][i] = entry.box.max[(axis_ + k) % 3];
      }
      column_.number[i] = entry.number;
      flags_[i] = entry.flags;
    }
  }

  /// A pair counts in the column that contains the lower corner of its intersection: there, along each axis,
  /// one of the two boxes starts.
  void sweep(std::size_t count) {
    const Lanes d;
    const Flags of_flags;
    const std::size_t lanes = hn::Lanes(d);
    const auto both = hn::Set(of_flags, 3u);
    const auto& [x, y, z] = column_.low;
    const auto& [x_end, y_end, z_end] = column_.high;
    for (std::size_t i = 0; i + 1 < count; ++i) {
      const auto end = hn::Set(d, x_end[i]);
      const auto low_y = hn::Set(d, y[i]), high_y = hn::Set(d, y_end[i]);
      const auto low_z = hn::Set(d, z[i]), high_z = hn::Set(d, z_end[i]);
      const auto flags = hn::Set(of_flags, flags_[i]);
      for (std::size_t j = i + 1; j < count; j += lanes) {
        const auto reached = hn::And(hn::Le(hn::LoadU(d, &x[j]), end), hn::FirstN(d, count - j));
        const auto in_y =
            hn::And(hn::Le(hn::LoadU(d, &y[j]), high_y), hn::Ge(hn::LoadU(d, &y_end[j]), low_y));
        const auto in_z =
            hn::And(hn::Le(hn::LoadU(d, &z[j]), high_z), hn::Ge(hn::LoadU(d, &z_end[j]), low_z));
        const auto owned = hn::RebindMask(d, hn::Eq(hn::Or(flags, hn::LoadU(of_flags, &flags_[j])), both));
        for (std::uint32_t bits = bits_of(hn::And(hn::And(reached, owned), hn::And(in_y, in_z))); bits != 0;
             bits &= bits - 1)
          pairs_.push_back(
              {column_.number[i], column_.number[j + static_cast<std::size_t>(std::countr_zero(bits))]});
        if (!hn::AllTrue(d, reached)) break;
      }
    }
  }

  int axis_ = 0;
  std::array<Division, 2> divisions_;
  RadixSorter sorter_;
  std::vector<Entry> sorted_, entries_;  // sorted by lower face, and by column
  std::vector<std::uint32_t> starts_, places_;
  BoxArrays column_;  // the column of the current sweep
  std::vector<std::uint32_t> flags_;
  std::vector<IndexPair> pairs_;
};

}  // namespace

std::unique_ptr<BoxContestant> make_baseline_grid() {
  return std::make_unique<BaselineGrid>();
}

}  // namespace supple::benchmarks
