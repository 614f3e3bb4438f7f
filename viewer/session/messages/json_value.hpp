#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace supple::viewer {

/// A parsed JSON value.
struct JsonValue {
  enum class Kind : std::uint8_t { null, boolean, integer, number, text, list, object };

  Kind kind = Kind::null;
  bool truth = false;
  std::int64_t integer = 0;  ///< for whole numbers that fit
  double number = 0;         ///< for whole numbers too
  std::string text{};
  std::vector<JsonValue> elements{};  ///< of an array, or the values of an object
  std::vector<std::string> names{};   ///< of the members of an object

  bool is_number() const { return kind == Kind::integer || kind == Kind::number; }
  /// True for a whole number that can be an id: 0 to 2^32 - 1.
  bool is_id() const { return kind == Kind::integer && integer >= 0 && integer <= 0xffffffff; }
  /// The first member of an object with this name; null when there is none.
  const JsonValue* find(std::string_view name) const;
};

/// Returns nothing when the text is not JSON or is nested deeper than any command; `error` is then the byte
/// offset of the problem.
std::optional<JsonValue> parse_json(std::string_view text, std::size_t& error);

}  // namespace supple::viewer
