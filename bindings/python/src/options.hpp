#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/stl/string.h>

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <type_traits>

#include "supple/description.hpp"
#include "supple/error.hpp"
#include "supple/option_descriptions.hpp"

// Options as keywords: a keyword is the name of a member or its key for users (description.hpp).

namespace supple::python {

namespace nb = nanobind;

/// The error for a value that cannot be converted.
[[noreturn]] void fail_value(const char* where, const char* key, nb::handle value, const std::string& wanted);

template <class Value>
struct IsOptional : std::false_type {};
template <class Value>
struct IsOptional<std::optional<Value>> : std::true_type {};

/// The member's value from a Python object: a word or a number of an enumeration, several words of a set, a
/// number, a text, a truth value, three numbers of a vector, four of a cube, or None for no value.
template <class Value, class Field>
Value value_of(nb::handle from, const Field& field, const char* where) {
  const auto wrong = [&](const std::string& wanted) { fail_value(where, field.key, from, wanted); };
  if constexpr (IsOptional<Value>::value) {
    if (from.is_none()) return std::nullopt;
    return value_of<typename Value::value_type>(from, field, where);
  } else if constexpr (std::is_same_v<Value, bool>) {
    bool value = false;
    std::string word;
    if (nb::try_cast(from, value)) return value;
    if (field.has_truth_words()) {
      if (nb::try_cast(from, word) && word == field.truth_words[0]) return false;
      if (nb::try_cast(from, word) && word == field.truth_words[1]) return true;
      wrong(std::string("True, False, ") + field.truth_words[0] + " or " + field.truth_words[1]);
    }
    wrong("True or False");
  } else if constexpr (WordedSet<Value>) {
    std::string text;
    std::uint8_t number = 0;
    if (nb::try_cast(from, text)) {
      if (const auto value = value_of_set<Value>(text)) return *value;
    } else if (nb::try_cast(from, number)) {
      if (word_of(static_cast<Value>(number)) != nullptr) return static_cast<Value>(number);
    } else if (nb::isinstance<nb::iterable>(from)) {
      for (const nb::handle part : nb::borrow<nb::iterable>(from)) {
        std::string word;
        if (nb::try_cast(part, number) && word_of(static_cast<Value>(number)) != nullptr)
          word = word_of(static_cast<Value>(number));
        else if (!nb::try_cast(part, word))
          wrong(list_of_set_words<Value>());
        text += (text.empty() ? "" : ",") + word;
      }
      if (const auto value = value_of_set<Value>(text.empty() ? set_words<Value>[0] : text)) return *value;
    }
    wrong(list_of_set_words<Value>());
  } else if constexpr (Worded<Value>) {
    std::string word;
    std::uint8_t number = 0;
    if (nb::try_cast(from, word)) {
      if (const auto value = value_of_word<Value>(word)) return *value;
    } else if (nb::try_cast(from, number) && word_of(static_cast<Value>(number)) != nullptr) {
      return static_cast<Value>(number);
    }
    wrong(list_of_words<Value>());
  } else if constexpr (std::unsigned_integral<Value>) {
    std::uint64_t value = 0;
    bool truth = false;
    if (!nb::try_cast(from, truth) && nb::try_cast(from, value) && field.range.allows(value))
      return static_cast<Value>(value);
    wrong(text_of(field.range, true));
  } else if constexpr (std::is_same_v<Value, double>) {
    double value = 0;
    bool truth = false;
    if (!nb::try_cast(from, truth) && nb::try_cast(from, value) && field.range.allows(value)) return value;
    wrong(text_of(field.range, false));
  } else if constexpr (std::is_same_v<Value, std::string>) {
    std::string value;
    if (nb::try_cast(from, value)) return value;
    wrong("a text");
  } else if constexpr (std::is_same_v<Value, Vec3d>) {
    Vec3d value;
    if (nb::isinstance<nb::sequence>(from) && nb::len(from) == 3 && nb::try_cast(from[0], value.x) &&
        nb::try_cast(from[1], value.y) && nb::try_cast(from[2], value.z))
      return value;
    wrong("three numbers");
  } else if constexpr (std::is_same_v<Value, RootCube>) {
    RootCube value;
    if (nb::isinstance<nb::sequence>(from) && nb::len(from) == 4 && nb::try_cast(from[0], value.corner.x) &&
        nb::try_cast(from[1], value.corner.y) && nb::try_cast(from[2], value.corner.z) &&
        nb::try_cast(from[3], value.edge) && is_valid(value))
      return value;
    wrong(range_of_root_cube);
  } else {
    wrong("set by an argument of its own");
  }
  return {};  // not reached
}

/// Sets one member; returns whether the structure has it. Members of nested structures are set by their keys,
/// or by a dict for the nested structure.
template <Described Struct>
bool set_option(Struct& options, const std::string& keyword, nb::handle value, const char* where);

template <Described Struct>
void set_options(Struct& options, const nb::dict& keywords, const char* where) {
  for (const auto [key, value] : keywords) {
    const auto keyword = nb::cast<std::string>(key);
    if (!set_option(options, keyword, value, where))
      throw nb::type_error((std::string(where) + ": there is no option '" + keyword + "'; supple.options('" +
                            Description<Struct>::name + "') lists all")
                               .c_str());
  }
  check(options, where);
}

template <Described Struct>
bool set_option(Struct& options, const std::string& keyword, nb::handle value, const char* where) {
  bool is_set = false;
  for_each_field<Struct>([&]<class Value>(const Field<Struct, Value>& field) {
    if (is_set) return;
    if constexpr (Described<Value>) {
      if (keyword == field.name && nb::isinstance<nb::dict>(value)) {
        set_options(options.*field.member, nb::borrow<nb::dict>(value), where);
        is_set = true;
      }
    } else if (keyword == field.name || keyword == field.key) {
      options.*field.member = value_of<Value>(value, field, where);
      is_set = true;
    }
  });
  // Members of nested structures: by their keys, which are unique, or by names that are.
  const auto set_leaf = [&](const auto& is_meant) {
    for_each_leaf(
        [&](const auto& field, auto& member) {
          if (is_set || !is_meant(field)) return;
          member = value_of<std::remove_cvref_t<decltype(member)>>(value, field, where);
          is_set = true;
        },
        options);
  };
  std::size_t same_name = 0;
  for_each_leaf([&](const auto& field, const auto&) { same_name += keyword == field.name ? 1 : 0; }, options);
  if (!is_set) set_leaf([&](const auto& field) { return keyword == field.key; });
  if (!is_set && same_name == 1) set_leaf([&](const auto& field) { return keyword == field.name; });
  return is_set;
}

/// The options of a structure that are numbers or words, by key.
template <class Struct>
nb::dict dict_of_options(const Struct& options) {
  nb::dict dict;
  for_each_leaf(
      [&]<class Field>(const Field& field, const auto& value) {
        using Value = std::remove_cvref_t<decltype(value)>;
        if constexpr (Worded<Value>) {
          dict[field.key] = word_of(value);
        } else if constexpr (std::is_arithmetic_v<Value>) {
          dict[field.key] = value;
        }
      },
      options);
  return dict;
}

/// The options of a structure: a list of (keyword, type in words, default in words, documentation, unit).
template <Described Struct>
nb::list list_options() {
  nb::list list;
  const Struct defaults{};
  for_each_leaf(
      [&]<class Field>(const Field& field, const auto& member) {
        using Value = std::remove_cvref_t<decltype(member)>;
        std::string values, preset;
        if constexpr (WordedSet<Value>) {
          values = list_of_set_words<Value>();
          preset = word_of(member);
        } else if constexpr (Worded<Value>) {
          values = list_of_words<Value>();
          preset = word_of(member);
        } else if constexpr (std::is_same_v<Value, bool>) {
          values = "True or False";
          preset = member ? "True" : "False";
        } else if constexpr (std::unsigned_integral<Value>) {
          values = text_of(field.range, true);
          preset = std::to_string(member);
        } else if constexpr (std::is_same_v<Value, double>) {
          values = text_of(field.range, false);
          preset = text_of(member);
        } else {
          values = std::is_same_v<Value, std::string> ? "a text" : "see the documentation";
        }
        list.append(nb::make_tuple(field.key, values, preset, field.doc, field.unit));
      },
      defaults);
  return list;
}

}  // namespace supple::python
