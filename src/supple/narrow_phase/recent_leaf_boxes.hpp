#pragma once

#include <cstdint>
#include <vector>

#include "narrow_phase/overlap_kernels.hpp"

namespace supple {

/// The boxes of the leaves that a search looked at last: searches that follow each other often look at the
/// same leaves. They fit into the second-level cache.
class RecentLeafBoxes {
 public:
  /// Call before searches of other objects, or of objects that moved.
  void clear() {
    for (Recent& recent : recent_) recent.object = none;
  }
  /// The boxes of a block of a leaf; `object` is a number of the caller. Valid until the next call.
  const LeafBoxes& boxes_of(std::uint32_t object, const LeafArrays& arrays, std::uint32_t leaf,
                            std::uint32_t begin, std::uint32_t end) {
    constexpr std::size_t size = 64;
    if (recent_.empty()) recent_.resize(size);
    Recent& recent = recent_[(begin / leaf_block + leaf) % size];
    if (recent.object != object || recent.begin != begin) {
      load_leaf_boxes(arrays, leaf, begin, end, recent.boxes);
      recent.object = object;
      recent.begin = begin;
    }
    return recent.boxes;
  }

 private:
  static constexpr std::uint32_t none = ~std::uint32_t{0};
  struct Recent {
    std::uint32_t object = none, begin = 0;
    LeafBoxes boxes;
  };

  std::vector<Recent> recent_;
};

}  // namespace supple
