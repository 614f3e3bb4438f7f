#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace supple::viewer {

/// What a JSON text holds.
struct JsonValue {
  enum class Kind : std::uint8_t { null, boolean, integer, number, text, list, object };

  Kind kind = Kind::null;
  bool truth = false;
  std::int64_t integer = 0;  ///< of a whole number of that range
  double number = 0;         ///< of an integer too
  std::string text{};
  std::vector<JsonValue> elements{};  ///< of a list, or the values of an object
  std::vector<std::string> names{};   ///< of the values of an object

  bool is_number() const { return kind == Kind::integer || kind == Kind::number; }
  /// A whole number that may name something: from 0 to 2^32 - 1.
  bool is_id() const { return kind == Kind::integer && integer >= 0 && integer <= 0xffffffff; }
  /// Of an object, the first value of that name; null when there is none.
  const JsonValue* find(std::string_view name) const;
};

/// Nothing when the text is no JSON, or nested deeper than any command is; `error` is then the byte at which
/// that shows.
std::optional<JsonValue> parse_json(std::string_view text, std::size_t& error);

}  // namespace supple::viewer
