#pragma once

#include <cstddef>
#include <type_traits>

#include "supple/result.hpp"
#include "supple/result_descriptions.hpp"

namespace supple::viewer {

// Each frame contains `motion_seconds` and then the members of `StepStats` in their order.
inline constexpr std::size_t statistic_count = count_leaves<StepStats>();

/// Calls `function(name, value)` for each member. The value of an enumeration is its number.
template <class Function>
void for_each_statistic(const StepStats& stats, Function function) {
  for_each_leaf(
      [&](const auto& field, const auto& value) { function(field.key, static_cast<double>(value)); }, stats);
}

}  // namespace supple::viewer
