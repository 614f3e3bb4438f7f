#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/parallel.hpp"

namespace supple {

/// The main part of an order: a group, of which there are few, then an id.
struct SortKey {
  std::uint32_t group = 0, id = 0;
};

/// Sorts in linear time, unless very many items have the same key: it counts the items into buckets by ranges
/// of keys, about four in each, and sorts each bucket. Keeps its memory between lists.
class BucketSort {
 public:
  /// Sorts the items by `less`, which compares the keys first. `for_each(visit)` visits the items, each time
  /// in the same order. O(n), O(n log n) at worst.
  template <class Item, class ForEach, class KeyOf, class Less>
  void sort(const ForEach& for_each, const KeyOf& key_of, const Less& less, const Parallel& parallel,
            std::vector<Item>& sorted) {
    std::size_t count = 0;
    std::uint32_t least = ~std::uint32_t{0}, most = 0, last_group = 0;
    for_each([&](const Item& item) {
      const SortKey key = key_of(item);
      ++count;
      least = std::min(least, key.id);
      most = std::max(most, key.id);
      last_group = std::max(last_group, key.group);
    });
    sorted.resize(count);
    if (count == 0) return;
    const std::uint64_t ids = std::uint64_t{most - least} + 1, keys = (std::uint64_t{last_group} + 1) * ids;
    const auto shift = static_cast<int>(std::bit_width(keys)) -
                       std::min(static_cast<int>(std::bit_width(keys)),
                                static_cast<int>(std::bit_width(count / items_of_bucket)));
    const auto bucket_of = [&](const Item& item) {
      const SortKey key = key_of(item);
      return static_cast<std::size_t>((key.group * ids + (key.id - least)) >> shift);
    };
    const auto buckets = static_cast<std::size_t>((keys - 1) >> shift) + 1;
    // Counts of the buckets before, then where each bucket begins, and in the end where it ends.
    ends_.assign(buckets + 1, 0);
    for_each([&](const Item& item) { ++ends_[bucket_of(item) + 1]; });
    for (std::size_t b = 0; b < buckets; ++b) ends_[b + 1] += ends_[b];
    for_each([&](const Item& item) { sorted[ends_[bucket_of(item)]++] = item; });
    parallel.for_ranges(buckets, 256, [&](std::size_t begin, std::size_t end, std::uint32_t) {
      for (std::size_t b = begin; b < end; ++b)
        std::sort(sorted.begin() + (b == 0 ? 0 : ends_[b - 1]), sorted.begin() + ends_[b], less);
    });
  }

 private:
  static constexpr std::size_t items_of_bucket = 4;

  std::vector<std::uint32_t> ends_;
};

}  // namespace supple
