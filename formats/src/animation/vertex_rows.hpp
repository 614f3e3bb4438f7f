#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace supple {

/// Gives equal rows of numbers one id, numbered by first use. -0 equals +0. A row with a NaN equals no row,
/// not even itself.
class VertexRows {
 public:
  explicit VertexRows(std::size_t width) : width_(width) {}

  std::size_t size() const { return count_; }
  std::span<const double> row(std::size_t id) const { return {rows_.data() + id * width_, width_}; }

  std::uint32_t id_of(std::span<const double> values) {
    if (2 * (count_ + 1) > slots_.size()) grow();
    const auto id = static_cast<std::uint32_t>(count_);
    std::uint32_t* slot = has_nan(values) ? nullptr : &slots_[slot_of(values)];
    if (slot != nullptr && *slot != empty_slot) return *slot;
    if (slot != nullptr) *slot = id;
    rows_.insert(rows_.end(), values.begin(), values.end());
    ++count_;
    return id;
  }

 private:
  static constexpr std::uint32_t empty_slot = std::numeric_limits<std::uint32_t>::max();

  static bool has_nan(std::span<const double> values) {
    for (const double value : values) {
      if (std::isnan(value)) return true;
    }
    return false;
  }

  bool is_equal(std::size_t id, std::span<const double> values) const {
    for (std::size_t i = 0; i < width_; ++i) {
      if (rows_[id * width_ + i] != values[i]) return false;
    }
    return true;
  }

  /// The slot of the row, or the slot for it when it is new, by linear probing. The table is never iterated,
  /// so the hash does not affect any order.
  std::size_t slot_of(std::span<const double> values) const {
    const std::size_t mask = slots_.size() - 1;
    std::size_t slot = hash(values) & mask;
    while (slots_[slot] != empty_slot && !is_equal(slots_[slot], values)) slot = (slot + 1) & mask;
    return slot;
  }

  static std::size_t hash(std::span<const double> values) {
    std::uint64_t bits = 0;
    for (const double value : values) {
      // Adding zero turns -0 into +0: they compare equal, so they must have the same hash.
      bits = (bits ^ std::bit_cast<std::uint64_t>(value + 0.0)) * 0x9e3779b97f4a7c15u;
      bits ^= bits >> 32;
    }
    return static_cast<std::size_t>(bits);
  }

  void grow() {
    slots_.assign(slots_.empty() ? 64 : 2 * slots_.size(), empty_slot);
    for (std::uint32_t id = 0; id < count_; ++id) {
      if (!has_nan(row(id))) slots_[slot_of(row(id))] = id;
    }
  }

  std::size_t width_, count_ = 0;
  std::vector<double> rows_;
  std::vector<std::uint32_t> slots_;  // the size is a power of two, and at most half of the slots are used
};

}  // namespace supple
