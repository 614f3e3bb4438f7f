#include <hwy/highway.h>

#include <bit>

#include "contest/baselines/sorted_boxes.hpp"
#include "contest/peers/peers.hpp"

namespace supple::benchmarks {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using Lanes = hn::CappedTag<float, 16>;

template <class Mask>
std::uint32_t bits_of(const Mask& mask) {
  std::uint8_t bytes[8] = {};
  hn::StoreMaskBits(Lanes(), mask, bytes);
  return bytes[0] + 256u * bytes[1];
}

class BaselineSweep : public BoxContestant {
 public:
  void prepare(const MovingBoxes&) override {}
  void frame(const MovingBoxes& field) override {
    const std::span<const Aabb> boxes = field.boxes();
    const int axis = spread_of(boxes).widest_axis;
    const auto order = sorter_.sort(boxes, axis);
    sorted_.resize(boxes.size());
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      const Aabb& box = boxes[order[i]];
      for (int k = 0; k < 3; ++k) {
        sorted_.low[k][i] = box.min[(axis + k) % 3];
        sorted_.high[k][i] = box.max[(axis + k) % 3];
      }
      sorted_.number[i] = order[i];
    }
    pairs_.clear();
    sweep(boxes.size());
  }
  PairDigest pairs() const override {
    PairDigest digest;
    for (const IndexPair& pair : pairs_) digest.add(pair.a, pair.b);
    return digest;
  }

 private:
  void sweep(std::size_t count) {
    const Lanes d;
    const std::size_t lanes = hn::Lanes(d);
    const auto& [x, y, z] = sorted_.low;
    const auto& [x_end, y_end, z_end] = sorted_.high;
    for (std::size_t i = 0; i + 1 < count; ++i) {
      const auto end = hn::Set(d, x_end[i]);
      const auto low_y = hn::Set(d, y[i]), high_y = hn::Set(d, y_end[i]);
      const auto low_z = hn::Set(d, z[i]), high_z = hn::Set(d, z_end[i]);
      for (std::size_t j = i + 1; j < count; j += lanes) {
        const auto reached = hn::And(hn::Le(hn::LoadU(d, &x[j]), end), hn::FirstN(d, count - j));
        const auto in_y =
            hn::And(hn::Le(hn::LoadU(d, &y[j]), high_y), hn::Ge(hn::LoadU(d, &y_end[j]), low_y));
        const auto in_z =
            hn::And(hn::Le(hn::LoadU(d, &z[j]), high_z), hn::Ge(hn::LoadU(d, &z_end[j]), low_z));
        for (std::uint32_t bits = bits_of(hn::And(reached, hn::And(in_y, in_z))); bits != 0; bits &= bits - 1)
          pairs_.push_back(
              {sorted_.number[i], sorted_.number[j + static_cast<std::size_t>(std::countr_zero(bits))]});
        if (!hn::AllTrue(d, reached)) break;
      }
    }
  }

  RadixSorter sorter_;
  BoxArrays sorted_;
  std::vector<IndexPair> pairs_;
};

}  // namespace

std::unique_ptr<BoxContestant> make_baseline_sweep() {
  return std::make_unique<BaselineSweep>();
}

}  // namespace supple::benchmarks
