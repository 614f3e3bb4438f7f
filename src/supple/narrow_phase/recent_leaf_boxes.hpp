#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "narrow_phase/overlap_kernels.hpp"

namespace supple {

/// The boxes of the leaves that a search looked at last: searches that follow each other often look at the
/// same leaves. Takes 1.6 MB for objects with many leaves.
class RecentLeafBoxes {
 public:
  /// Call before searches of other objects, or of objects that moved.
  void clear() { keys_.assign(keys_.size(), Key{}); }
  /// The boxes of a block of a leaf; `object` is a number of the caller. Valid until the next call.
  const LeafBoxes& boxes_of(std::uint32_t object, const LeafArrays& arrays, std::uint32_t leaf,
                            std::uint32_t begin, std::uint32_t end) {
    constexpr std::size_t size = 1024;
    const std::size_t place = (begin / leaf_block + leaf) % size;
    if (place >= keys_.size()) {
      boxes_.resize(std::bit_ceil(place + 1));
      keys_.resize(boxes_.size());
    }
    const Key key{object, begin};
    if (keys_[place] != key) {
      load_leaf_boxes(arrays, leaf, begin, end, boxes_[place]);
      keys_[place] = key;
    }
    return boxes_[place];
  }

 private:
  struct Key {
    std::uint32_t object = ~std::uint32_t{0}, begin = 0;
    constexpr bool operator==(const Key&) const = default;
  };

  std::vector<Key> keys_;
  std::vector<LeafBoxes> boxes_;
};

}  // namespace supple
