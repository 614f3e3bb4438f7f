#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "messages/json_value.hpp"
#include "supple/description.hpp"
#include "supple/types.hpp"

namespace supple::viewer {

/// The largest id that an object, a vertex or a triangle can have.
constexpr std::int64_t largest_id = std::numeric_limits<std::uint32_t>::max();

/// Reads the members of a command. Keeps the first error as a message for the user; values returned after an
/// error have no meaning. A missing optional member is not an error.
class Arguments {
 public:
  Arguments(const JsonValue& object, std::string command) : object_(object), command_(std::move(command)) {}

  bool has(const char* name) { return find(name) != nullptr; }
  std::optional<bool> boolean(const char* name);
  std::optional<std::int64_t> integer(const char* name, std::int64_t low, std::int64_t high);
  std::optional<double> number(const char* name, double low, double high);
  std::optional<std::int64_t> integer(const char* name, const ValueRange& range);
  std::optional<double> number(const char* name, const ValueRange& range);
  /// A whole number of up to 64 bits as a text of digits: numbers of JavaScript are exact only up to 2^53.
  std::optional<std::uint64_t> digits(const char* name);
  std::optional<bool> one_of_two(const char* name, const std::array<const char*, 2>& words_of_truth);
  std::optional<Vec3d> point(const char* name);
  /// Three coordinates and an edge, or null for no cube.
  std::optional<std::optional<RootCube>> cube(const char* name);
  /// An object and one of its triangles. Checks only that both are whole numbers.
  std::optional<std::array<std::uint32_t, 2>> pair(const char* name);
  std::optional<std::vector<std::uint32_t>> numbers(const char* name);
  /// One of the words of the enumeration.
  template <Worded Enumeration>
  std::optional<Enumeration> one_of(const char* name) {
    const JsonValue* const value = find(name);
    if (value == nullptr) return std::nullopt;
    std::optional<Enumeration> found;
    if (value->kind == JsonValue::Kind::text) found = value_of_word<Enumeration>(value->text);
    if (!found) must_be(name, "one of " + list_of_words<Enumeration>());
    return found;
  }
  /// Reads an option by its key, within the range of its description: words, whole numbers or truth values.
  /// Returns whether the option is given. The value stays unchanged when it is missing or invalid.
  template <class Struct, class Value>
  bool option(const Field<Struct, Value>& field, Value& value) {
    std::optional<Value> given;
    if constexpr (Worded<Value>) {
      given = one_of<Value>(field.key);
    } else if constexpr (std::is_same_v<Value, bool>) {
      given = field.has_truth_words() ? one_of_two(field.key, field.truth_words) : boolean(field.key);
    } else if constexpr (std::is_same_v<Value, double>) {
      given = number(field.key, field.range);
    } else if constexpr (std::is_same_v<Value, std::optional<RootCube>>) {
      given = cube(field.key);
    } else {
      if (const auto whole = integer(field.key, field.range)) given = static_cast<Value>(*whole);
    }
    if (given) value = *given;
    return given.has_value();
  }
  /// The value of a member that has members of its own; null when it is missing.
  const JsonValue* member(const char* name) { return find(name); }

  /// Reports an error when the member is missing.
  template <class Value>
  Value required(const char* name, std::optional<Value> value) {
    if (!value && error_.empty()) error_ = command_ + ": " + name + " is missing";
    return value.value_or(Value{});
  }
  void must_be(const char* name, const std::string& what);
  void fail(std::string error);

  /// False after an error, and when the command has members that were not read.
  bool check();
  const std::string& error() const { return error_; }  ///< empty without an error

 private:
  const JsonValue* find(const char* name);

  const JsonValue& object_;
  std::string command_;
  std::vector<std::string_view> known_;
  std::string error_;
};

}  // namespace supple::viewer
