#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "contact/distance/element_distance.hpp"

namespace supple {

/// What was decided for some of the last pairs of elements, by their points. So where many elements are at
/// one place, exact arithmetic decides once for all of them.
template <class Answer>
class RecentElements {
 public:
  /// Forgets everything. O(1).
  void clear() { ++version_; }
  /// Null when the answer is not known.
  const Answer* find(const ElementPoints& elements) const {
    if (entries_.empty()) return nullptr;
    const std::size_t place = place_of(elements);
    for (const Entry* const entry : {&entries_[place], &entries_[place ^ 1]}) {
      if (entry->version == version_ && entry->elements.points == elements.points &&
          entry->elements.count_a == elements.count_a && entry->elements.count_b == elements.count_b)
        return &entry->answer;
    }
    return nullptr;
  }
  void store(const ElementPoints& elements, const Answer& answer) {
    if (entries_.empty()) entries_.resize(size);
    const std::size_t place = place_of(elements);
    entries_[place ^ 1] = entries_[place];  // so that two that alternate are both kept
    entries_[place] = {elements, answer, version_};
  }

 private:
  static constexpr std::size_t size = 256;
  struct Entry {
    ElementPoints elements;
    Answer answer{};
    std::uint64_t version = 0;
  };

  static std::size_t place_of(const ElementPoints& elements) {
    std::uint64_t hash = elements.count_b;
    for (const Vec3d& p : elements.points) {
      for (int axis = 0; axis < 3; ++axis)
        hash = (hash ^ std::bit_cast<std::uint64_t>(p[axis])) * 0x9e3779b97f4a7c15u;
    }
    static_assert(size == 256);
    return static_cast<std::size_t>(hash >> 56);
  }

  std::uint64_t version_ = 1;
  std::vector<Entry> entries_;
};

}  // namespace supple
