#pragma once

#include <cstddef>
#include <type_traits>

#include "supple/result.hpp"
#include "supple/result_descriptions.hpp"

namespace supple::viewer {

// The numbers of a step that frames have: the members of `StepStats` in their order. `motion_seconds` comes
// before them.
inline constexpr std::size_t statistic_count = count_leaves<StepStats>();

/// Calls `function(name, value)` for each. A word is the number of its place in the enumeration.
template <class Function>
void for_each_statistic(const StepStats& stats, Function function) {
  for_each_leaf(
      [&](const auto& field, const auto& value) { function(field.key, static_cast<double>(value)); }, stats);
}

}  // namespace supple::viewer
