#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "supple/broad_phase.hpp"
#include "supple/types.hpp"

namespace supple {

/// Most lanes a kernel takes at once; arrays are readable this far past their last box.
inline constexpr std::size_t kMaxLanes = 16;

/// Boxes as structure of arrays, for kernels that test one against many.
struct BoxLanes {
  std::array<std::vector<float>, 3> min, max;
  std::vector<std::uint32_t> slots;  ///< object of each lane
  /// Per lane, bit per axis: the box begins in this part of space. A pair is reported where it begins along
  /// all three axes; 7 everywhere when there is but one part.
  std::vector<std::uint32_t> begins;
  std::size_t count = 0;

  /// Room for `new_count` boxes, all to be set. The lanes behind them hold NaN, which overlaps nothing.
  void resize(std::size_t new_count) {
    count = new_count;
    if (slots.size() < count + kMaxLanes) {
      const std::size_t size = count + count / 2 + kMaxLanes;
      for (std::vector<float>& ends : min) ends.resize(size);
      for (std::vector<float>& ends : max) ends.resize(size);
      slots.resize(size);
      begins.resize(size);
    }
    for (std::size_t i = count; i < count + kMaxLanes; ++i)
      min[0][i] = std::numeric_limits<float>::quiet_NaN();
  }

  /// `first_axis` becomes axis 0 of the lanes, the others follow in turn.
  void set(std::size_t lane, std::uint32_t slot, const Aabb& box, std::uint32_t begins_here = 7,
           int first_axis = 0) {
    for (std::size_t k = 0; k < 3; ++k) {
      const int axis = first_axis + static_cast<int>(k) < 3 ? first_axis + static_cast<int>(k)
                                                            : first_axis + static_cast<int>(k) - 3;
      min[k][lane] = box.min[axis];
      max[k][lane] = box.max[axis];
    }
    slots[lane] = slot;
    begins[lane] = begins_here;
  }
};

/// Pairs in the order they were found. Keeps its memory when cleared.
class PairBuffer {
 public:
  std::size_t size() const { return size_; }
  IndexPair* data() { return storage_.data(); }
  const IndexPair* data() const { return storage_.data(); }
  void clear() { size_ = 0; }
  void truncate(std::size_t size) { size_ = size; }

  /// Where up to `count` further pairs may be written; `commit` says how many were.
  IndexPair* room(std::size_t count) {
    if (size_ + count > storage_.size()) storage_.resize(2 * storage_.size() + count + 256);
    return storage_.data() + size_;
  }
  void commit(std::size_t count) { size_ += count; }
  void push(IndexPair pair) {
    *room(1) = pair;
    ++size_;
  }

 private:
  std::vector<IndexPair> storage_;
  std::size_t size_ = 0;
};

}  // namespace supple
