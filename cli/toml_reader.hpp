#pragma once

#include <toml++/toml.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "supple/types.hpp"

namespace supple::cli {

/// Reads the values of one table of a TOML file and remembers which keys were asked for, so that `finish` can
/// reject the others. Every error names file, line and key and says what is allowed.
class TomlReader {
 public:
  /// `where` says what the table describes: `[scene]`, `[[object]] 2`.
  TomlReader(std::filesystem::path file, const toml::table& table, std::string where)
      : file_(std::move(file)), table_(table), where_(std::move(where)) {}

  bool has(const std::string& key) { return node(key) != nullptr; }

  // Each leaves the value as it is when the key is absent.
  void read(const std::string& key, std::string& value);
  void read(const std::string& key, bool& value);
  void read(const std::string& key, double& value);
  void read(const std::string& key, Vec3d& value);
  void read(const std::string& key, std::uint32_t& value, std::uint32_t lowest, std::uint32_t highest);
  void read(const std::string& key, std::uint64_t& value);
  void read_positive(const std::string& key, double& value);
  void read_non_negative(const std::string& key, double& value);
  /// One of a few words.
  template <class Value>
  void read_choice(const std::string& key, Value& value,
                   const std::vector<std::pair<std::string, Value>>& choices);
  /// Three whole numbers.
  void read(const std::string& key, std::array<std::uint32_t, 3>& value, std::uint32_t lowest,
            std::uint32_t highest);
  /// Lowest and highest corner; along each axis the first is below the second.
  void read_box(const std::string& key, std::array<Vec3d, 2>& box, bool may_be_flat);
  /// An array of boxes, each [lowest corner, highest corner]; these may be flat.
  void read(const std::string& key, std::vector<std::array<Vec3d, 2>>& boxes);
  /// The table under a key, or null.
  const toml::table* table(const std::string& key);
  /// The tables of an array; `written` says how the array is written in a scene file.
  std::vector<const toml::table*> tables(const std::string& key, const std::string& written);

  /// Throws for a key that was never asked for.
  void finish() const;
  /// Throws an error about a key that is present, or about the table itself when it is not.
  [[noreturn]] void fail(const std::string& key, const std::string& what) const;

 private:
  const toml::node* node(const std::string& key);
  double number(const toml::node& node, const std::string& key, const char* expected) const;
  Vec3d point(const toml::node& node, const std::string& key, const char* expected) const;
  std::int64_t integer(const std::string& key, std::int64_t lowest, std::int64_t highest);
  std::array<Vec3d, 2> corners(const toml::node& node, const std::string& key, const char* expected,
                               bool may_be_flat) const;
  /// Which of the words a key has; `none_given` when the key is absent.
  std::size_t choice(const std::string& key, const std::vector<std::string>& words);
  static constexpr std::size_t none_given = static_cast<std::size_t>(-1);
  [[noreturn]] void fail_at(const toml::source_region& place, const std::string& key,
                            const std::string& what) const;

  std::filesystem::path file_;
  const toml::table& table_;
  std::string where_;
  std::vector<std::string> known_;
};

template <class Value>
void TomlReader::read_choice(const std::string& key, Value& value,
                             const std::vector<std::pair<std::string, Value>>& choices) {
  std::vector<std::string> words;
  for (const auto& [word, meaning] : choices) words.push_back(word);
  if (const std::size_t chosen = choice(key, words); chosen != none_given) value = choices[chosen].second;
}

}  // namespace supple::cli
