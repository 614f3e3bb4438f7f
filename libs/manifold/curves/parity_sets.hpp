#pragma once

#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

namespace supple {

/// Disjoint sets of items, each of which is equal or opposite to the others of its set (union-find). Keeps
/// its memory.
class ParitySets {
 public:
  void start(std::size_t count) {
    parent_.resize(count);
    std::iota(parent_.begin(), parent_.end(), 0u);
    is_opposite_.assign(count, 0);
  }

  struct Place {
    std::uint32_t root = 0;    ///< the smallest item of the set
    bool is_opposite = false;  ///< to the root
  };
  Place find(std::uint32_t item) {
    bool is_opposite = false;
    while (parent_[item] != item) {
      // Halves the path: the item becomes a child of its grandparent. A root is equal to itself.
      const std::uint32_t parent = parent_[item];
      is_opposite_[item] ^= is_opposite_[parent];
      parent_[item] = parent_[parent];
      is_opposite ^= is_opposite_[item] != 0;
      item = parent_[item];
    }
    return {item, is_opposite};
  }

  /// Returns false when that contradicts what is known.
  bool join(std::uint32_t a, std::uint32_t b, bool are_opposite) {
    Place of_a = find(a), of_b = find(b);
    const bool roots_are_opposite = (of_a.is_opposite != of_b.is_opposite) != are_opposite;
    if (of_a.root == of_b.root) return !roots_are_opposite;
    if (of_b.root < of_a.root) std::swap(of_a, of_b);
    parent_[of_b.root] = of_a.root;
    is_opposite_[of_b.root] = roots_are_opposite ? 1 : 0;
    return true;
  }

 private:
  std::vector<std::uint32_t> parent_;
  std::vector<std::uint8_t> is_opposite_;  // to the parent
};

}  // namespace supple
