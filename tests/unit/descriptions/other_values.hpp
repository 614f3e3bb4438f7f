#pragma once

#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "supple/simulation_descriptions.hpp"

namespace supple {

/// Replaces the value by a different one that the description allows.
template <class Struct, class Value>
void set_other(const Field<Struct, Value>& field, Value& value) {
  if constexpr (Worded<Value>) {
    value = static_cast<Value>((static_cast<std::size_t>(value) + 1) % words<Value>.size());
  } else if constexpr (std::is_same_v<Value, bool>) {
    value = !value;
  } else if constexpr (std::is_unsigned_v<Value>) {
    const auto half = static_cast<Value>(value / 2), next = static_cast<Value>(value + 1);
    value = value > 1 && field.range.allows(half) ? half : field.range.allows(next) ? next : Value{4};
  } else if constexpr (std::is_same_v<Value, double>) {
    value = value == 0 || std::isinf(value) ? 0.125 : value / 2;
  } else if constexpr (std::is_same_v<Value, Vec3d>) {
    value = {value.x + 0.25, value.y - 0.5, value.z + 0.125};
  } else if constexpr (std::is_same_v<Value, std::string>) {
    value += "other";
  } else if constexpr (std::is_same_v<Value, std::optional<std::uint64_t>>) {
    value = 7;
  } else if constexpr (std::is_same_v<Value, std::optional<RootCube>>) {
    value = RootCube{{-1.5, 0.1, 3}, 2.7};
  } else if constexpr (std::is_same_v<Value, std::optional<Border>>) {
    value = Border{{{-5, -6, -7}, {8, 9, 10}}};
  } else if constexpr (std::is_same_v<Value, std::optional<ContactResponse>>) {
    value = ContactResponse{.friction = 0.25};
  } else if constexpr (std::is_same_v<Value, std::vector<std::uint32_t>>) {
    value = {1, 2};
  } else {
    static_assert(std::is_same_v<Value, std::vector<MassSpringMotion::Handle>>);
    value = {{.vertices = {3, 4}, .by = {0, 1, 0}, .seconds = 0.5}};
  }
}

/// A structure in which every member differs from its default.
template <Described Struct>
Struct other_values() {
  Struct values{};
  for_each_leaf([](const auto& field, auto& value) { set_other(field, value); }, values);
  return values;
}

/// The keys of all members that differ.
template <Described Struct>
std::vector<std::string> differences_of(const Struct& a, const Struct& b) {
  std::vector<std::string> keys;
  for_each_leaf(
      [&](const auto& field, const auto& x, const auto& y) {
        using Value = std::remove_cvref_t<decltype(x)>;
        bool equal = true;
        if constexpr (std::is_same_v<Value, std::vector<MassSpringMotion::Handle>>) {
          equal = x.size() == y.size();
          for (std::size_t i = 0; equal && i < x.size(); ++i)
            equal = x[i].vertices == y[i].vertices && x[i].by == y[i].by && x[i].seconds == y[i].seconds;
        } else {
          equal = x == y;
        }
        if (!equal) keys.emplace_back(field.key);
      },
      a, b);
  return keys;
}

/// The keys of the options that belong to the machine, which are not stored.
template <Described Struct>
std::vector<std::string> keys_of_machine() {
  std::vector<std::string> keys;
  Struct values{};
  for_each_leaf(
      [&](const auto& field, const auto&) {
        if (field.is_of_machine) keys.emplace_back(field.key);
      },
      values);
  return keys;
}

}  // namespace supple
