#pragma once

#include <toml++/toml.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "base/text.hpp"
#include "supple/description.hpp"
#include "supple/types.hpp"

namespace supple::cli {

/// Checks what the TOML parser cannot: before it parses, the text must have only characters that TOML allows
/// outside of strings and comments, brackets that match, and neither deep lists and tables nor keys of many
/// parts, which would overflow the stack. Throws `Error` with file and line.
void check_toml_limits(std::string_view text, const std::filesystem::path& path);

/// Files beyond this size are not read, bytes.
inline constexpr std::size_t most_toml_bytes = std::size_t{64} << 20;

/// Reads the values of one table of a TOML file. It remembers the keys that were read, so that `finish` can
/// reject all others. Every error names the file, the line and the key, and says what is allowed.
class TomlReader {
 public:
  /// `where` names the table in messages: `[scene]`, `[[object]] 2`.
  TomlReader(std::filesystem::path file, const toml::table& table, std::string where)
      : file_(std::move(file)), table_(table), where_(std::move(where)) {}

  bool has(const std::string& key) { return node(key) != nullptr; }

  // Each function leaves the value unchanged when the key is absent.
  void read(const std::string& key, std::string& value);
  void read(const std::string& key, bool& value);
  void read(const std::string& key, double& value);
  void read(const std::string& key, Vec3d& value);
  void read(const std::string& key, std::uint32_t& value, std::uint32_t lowest, std::uint32_t highest);
  void read(const std::string& key, double& value, const ValueRange& range);
  /// Returns the index of the word.
  std::optional<std::size_t> read_word(const std::string& key, std::span<const char* const> choices);
  /// Reads an option by its key, within the range of its description.
  template <class Struct, class Value>
  void read(const Field<Struct, Value>& field, Value& value);
  /// Reads all options of a structure that are numbers, words, points or texts, except those of the machine.
  template <Described Options>
  void read_options(Options& options);
  /// Three whole numbers.
  void read(const std::string& key, std::array<std::uint32_t, 3>& value, std::uint32_t lowest,
            std::uint32_t highest);
  /// Reads a lowest and a highest corner; along each axis the first must be below the second.
  void read_box(const std::string& key, std::array<Vec3d, 2>& box, bool may_be_flat);
  /// Reads a cube as [x, y, z, edge]. Returns false when the value is `word` instead.
  bool read_cube(const std::string& key, const std::string& word, std::optional<RootCube>& cube);
  /// Reads an array of boxes, each [lowest corner, highest corner]. They may be flat.
  void read(const std::string& key, std::vector<std::array<Vec3d, 2>>& boxes);
  /// The table under a key, or null.
  const toml::table* table(const std::string& key);
  /// The tables of an array. `written` is the notation of the array in a scene file, for messages.
  std::vector<const toml::table*> tables(const std::string& key, const std::string& written);

  /// Throws when the table has a key that was not read.
  void finish() const;
  /// Throws an error about a key, or about the table when the key is absent.
  template <class... Args>
  [[noreturn]] void fail(const std::string& key, fmt::format_string<Args...> what, Args&&... args) const {
    const toml::node* node = table_.get(key);
    fail_at(node ? node->source() : table_.source(), node ? key : "", what, std::forward<Args>(args)...);
  }

 private:
  const toml::node* node(const std::string& key);
  /// The value under a key, which must have this type; null when the key is absent.
  template <class Type>
  auto value_of(const std::string& key, const char* expected) {
    const toml::node* const found = node(key);
    const auto* const value = found ? found->as<Type>() : nullptr;
    if (found && !value) fail(key, "must be {}", expected);
    return value;
  }
  const toml::array& array_of(const toml::node& node, const std::string& key, const std::string& expected,
                              std::size_t size) const;
  double number(const toml::node& node, const std::string& key, const char* expected) const;
  Vec3d point(const toml::node& node, const std::string& key, const char* expected) const;
  std::int64_t integer(const std::string& key, const ValueRange& range);
  template <class Whole>
  void read_whole(const std::string& key, Whole& value, const ValueRange& range) {
    if (has(key)) value = static_cast<Whole>(integer(key, range));
  }
  std::array<Vec3d, 2> corners(const toml::node& node, const std::string& key, const char* expected,
                               bool may_be_flat) const;
  template <class... Args>
  [[noreturn]] void fail_at(const toml::source_region& place, const std::string& key,
                            fmt::format_string<Args...> what, Args&&... args) const {
    cli::fail("{}:{}: {}: {}{}{}", file_.string(), place.begin.line, where_, key, key.empty() ? "" : ": ",
              fmt::format(what, std::forward<Args>(args)...));
  }

  std::filesystem::path file_;
  const toml::table& table_;
  std::string where_;
  std::vector<std::string> known_;
};

template <class Struct, class Value>
void TomlReader::read(const Field<Struct, Value>& field, Value& value) {
  if constexpr (WordedSet<Value>) {
    if (!has(field.key)) return;
    std::string given;
    read(field.key, given);
    const std::optional<Value> found = value_of_set<Value>(given);
    if (!found) fail(field.key, "'{}' is not {}", given, list_of_set_words<Value>());
    value = *found;
  } else if constexpr (Worded<Value>) {
    if (const auto place = read_word(field.key, words<Value>)) value = static_cast<Value>(*place);
  } else if constexpr (std::is_same_v<Value, bool>) {
    if (!field.has_truth_words())
      read(field.key, value);
    else if (const auto place = read_word(field.key, field.truth_words))
      value = *place == 1;
  } else if constexpr (std::is_same_v<Value, double>) {
    read(field.key, value, field.range);
  } else if constexpr (std::is_unsigned_v<Value>) {
    read_whole(field.key, value, field.range);
  } else if constexpr (std::is_same_v<Value, std::optional<std::uint64_t>>) {
    if (has(field.key)) read_whole(field.key, value.emplace(), field.range);
  } else if constexpr (std::is_same_v<Value, Vec3d> || std::is_same_v<Value, std::string>) {
    read(field.key, value);
  }
}

template <Described Options>
void TomlReader::read_options(Options& options) {
  for_each_leaf(
      [&](const auto& field, auto& value) {
        if (!field.is_of_machine) read(field, value);
      },
      options);
}

}  // namespace supple::cli
