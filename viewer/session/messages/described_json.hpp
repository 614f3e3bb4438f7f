#pragma once

#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "supple/description.hpp"

namespace supple::viewer {

/// Writes the value of an option or a statistic.
template <class Json, class Struct, class Value>
void write_value(Json& json, const Field<Struct, Value>& field, const Value& value) {
  if constexpr (Worded<Value>) {
    json.value(word_of(value));
  } else if constexpr (std::is_same_v<Value, std::vector<std::uint64_t>>) {
    json.begin_array();
    for (const std::uint64_t number : value) json.value(number);
    json.end_array();
  } else {
    if constexpr (std::is_same_v<Value, bool>) {
      if (field.has_truth_words()) return json.value(field.truth_words[value ? 1 : 0]);
    }
    json.value(value);
  }
}

/// Writes one member per option or statistic, named by its key.
template <class Json, Described Struct>
void write_members(Json& json, const Struct& described) {
  for_each_leaf(
      [&](const auto& field, const auto& value) {
        json.key(field.key);
        write_value(json, field, value);
      },
      described);
}

}  // namespace supple::viewer
