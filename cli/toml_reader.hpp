#pragma once

#include <toml++/toml.h>

#include <cstdint>
#include <filesystem>
#include <string>
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
  /// An array of as many points as `points` has.
  void read_points(const std::string& key, Vec3d* points, std::size_t count);
  /// The table under a key, or null.
  const toml::table* table(const std::string& key);
  /// The tables of `[[key]]`.
  std::vector<const toml::table*> tables(const std::string& key);

  /// Throws for a key that was never asked for.
  void finish() const;
  /// Throws an error about a key that is present, or about the table itself when it is not.
  [[noreturn]] void fail(const std::string& key, const std::string& what) const;

 private:
  const toml::node* node(const std::string& key);
  double number(const toml::node& node, const std::string& key, const char* expected) const;
  Vec3d point(const toml::node& node, const std::string& key, const char* expected) const;
  std::int64_t integer(const std::string& key, std::int64_t lowest, std::int64_t highest);
  [[noreturn]] void fail_at(const toml::source_region& place, const std::string& key,
                            const std::string& what) const;

  std::filesystem::path file_;
  const toml::table& table_;
  std::string where_;
  std::vector<std::string> known_;
};

}  // namespace supple::cli
