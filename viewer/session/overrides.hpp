#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>

#include "supple/description.hpp"

namespace supple::viewer {

/// Some given options of a structure, which replace the options of another structure.
template <Described Options>
class Overrides {
 public:
  explicit Overrides(const Options& defaults = {}) : values_(defaults) {}

  /// Calls `read(field, value)` for each option; it returns true when it wrote the value.
  template <class Read>
  void read(Read read) {
    std::size_t place = 0;
    for_each_leaf(
        [&](const auto& field, auto& value) {
          if (read(field, value)) given_ |= bit(place);
          ++place;
        },
        values_);
  }
  /// Calls `add(field, default_value, set)` for each option; `set(value)` sets it. The overrides must not
  /// move while `set` may be called.
  template <class Add>
  void for_each_setter(Add add) {
    std::size_t place = 0;
    for_each_leaf(
        [&](const auto& field, auto& value) {
          add(field, std::as_const(value), [this, at = place, &value](const auto& chosen) {
            value = chosen;
            given_ |= bit(at);
          });
          ++place;
        },
        values_);
  }
  void apply_to(Options& options) const {
    std::size_t place = 0;
    for_each_leaf(
        [&](const auto&, const auto& given, auto& value) {
          if ((given_ & bit(place++)) != 0) value = given;
        },
        values_, options);
  }

 private:
  static_assert(count_leaves<Options>() <= 64);
  static constexpr std::uint64_t bit(std::size_t place) { return std::uint64_t{1} << place; }

  Options values_;
  std::uint64_t given_ = 0;
};

}  // namespace supple::viewer
