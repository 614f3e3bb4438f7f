#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace supple {

/// Many short lists of object slots in one flat array. Each list is in a run whose capacity is a power of
/// two. Released runs are reused, so lists that change from step to step allocate no memory.
class SlotLists {
 public:
  struct List {
    std::size_t first = 0;
    std::uint32_t count = 0;
    std::uint8_t capacity_log2 = no_run;
  };

  std::span<const std::uint32_t> view(const List& list) const {
    return {slots_.data() + list.first, list.count};
  }

  /// Gives an empty list a run for `count` slots. All views become invalid.
  void reserve(List& list, std::uint32_t count) {
    release(list);
    if (count == 0) return;
    list.capacity_log2 = std::max(smallest_run, static_cast<std::uint8_t>(std::bit_width(count - 1)));
    std::vector<std::size_t>& free = free_[list.capacity_log2];
    if (free.empty()) {
      list.first = slots_.size();
      slots_.resize(slots_.size() + (std::size_t{1} << list.capacity_log2));
    } else {
      list.first = free.back();
      free.pop_back();
    }
  }

  void push(List& list, std::uint32_t slot) {
    if (list.capacity_log2 == no_run || list.count >> list.capacity_log2 != 0) grow(list);
    slots_[list.first + list.count++] = slot;
  }

  /// Replaces the slot by the last slot of the list. O(count).
  void erase(List& list, std::uint32_t slot) {
    const auto begin = slots_.begin() + static_cast<std::ptrdiff_t>(list.first);
    const auto last = begin + list.count - 1;
    *std::find(begin, last, slot) = *last;
    --list.count;
  }

  void release(List& list) {
    if (list.capacity_log2 != no_run) free_[list.capacity_log2].push_back(list.first);
    list = {};
  }

  void clear() {
    slots_.clear();
    for (std::vector<std::size_t>& free : free_) free.clear();
  }

  // For checks: the capacities of all lists and of free runs add up to `size`.
  std::size_t capacity(const List& list) const {
    return list.capacity_log2 == no_run ? 0 : std::size_t{1} << list.capacity_log2;
  }
  std::size_t free_capacity() const {
    std::size_t total = 0;
    for (std::size_t k = 0; k < free_.size(); ++k) total += free_[k].size() << k;
    return total;
  }
  std::size_t size() const { return slots_.size(); }

 private:
  static constexpr std::uint8_t no_run = 255;
  static constexpr std::uint8_t smallest_run = 2;

  void grow(List& list) {
    List larger;
    reserve(larger, list.count + 1);
    std::copy_n(slots_.begin() + static_cast<std::ptrdiff_t>(list.first), list.count,
                slots_.begin() + static_cast<std::ptrdiff_t>(larger.first));
    larger.count = list.count;
    release(list);
    list = larger;
  }

  std::vector<std::uint32_t> slots_;
  std::array<std::vector<std::size_t>, 33> free_;
};

}  // namespace supple
