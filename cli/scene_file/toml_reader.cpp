#include "scene_file/toml_reader.hpp"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/text.hpp"
#include "supple/error.hpp"

namespace supple::cli {

const toml::node* TomlReader::node(const std::string& key) {
  if (std::find(known_.begin(), known_.end(), key) == known_.end()) known_.push_back(key);
  return table_.get(key);
}

void TomlReader::fail_at(const toml::source_region& place, const std::string& key,
                         const std::string& what) const {
  throw Error(one_line(fmt::format("{}:{}: {}: {}{}{}", file_.string(), place.begin.line, where_, key,
                                   key.empty() ? "" : ": ", what)));
}

void TomlReader::fail(const std::string& key, const std::string& what) const {
  const toml::node* node = table_.get(key);
  fail_at(node ? node->source() : table_.source(), node ? key : "", what);
}

double TomlReader::number(const toml::node& node, const std::string& key, const char* expected) const {
  if (const auto* value = node.as_floating_point(); value && std::isfinite(value->get())) return value->get();
  if (const auto* value = node.as_integer()) return static_cast<double>(value->get());
  fail_at(node.source(), key, fmt::format("must be {}", expected));
}

Vec3d TomlReader::point(const toml::node& node, const std::string& key, const char* expected) const {
  const toml::array* array = node.as_array();
  if (!array || array->size() != 3) fail_at(node.source(), key, fmt::format("must be {}", expected));
  return {number((*array)[0], key, expected), number((*array)[1], key, expected),
          number((*array)[2], key, expected)};
}

std::int64_t TomlReader::integer(const std::string& key, const ValueRange& range) {
  const toml::node& found = *node(key);
  const auto* value = found.as_integer();
  if (!value || value->get() < 0 || !range.allows(static_cast<std::uint64_t>(value->get())))
    fail_at(found.source(), key, "must be " + text_of(range, true));
  return value->get();
}

void TomlReader::read(const std::string& key, std::string& value) {
  const toml::node* found = node(key);
  if (!found) return;
  if (!found->is_string()) fail_at(found->source(), key, "must be a string in quotes");
  value = found->as_string()->get();
  if (value.find('\0') != std::string::npos)
    fail_at(found->source(), key, "has a character of code 0, which no name can have");
}

void TomlReader::read(const std::string& key, bool& value) {
  const toml::node* found = node(key);
  if (!found) return;
  if (!found->is_boolean()) fail_at(found->source(), key, "must be true or false");
  value = found->as_boolean()->get();
}

void TomlReader::read(const std::string& key, double& value) {
  if (const toml::node* found = node(key)) value = number(*found, key, "a finite number");
}

void TomlReader::read(const std::string& key, double& value, const ValueRange& range) {
  const toml::node* found = node(key);
  if (!found) return;
  const std::string expected = text_of(range, false);
  value = number(*found, key, expected.c_str());
  if (!range.allows(value)) fail(key, "must be " + expected);
}

std::optional<std::size_t> TomlReader::read_word(const std::string& key,
                                                 std::span<const char* const> choices) {
  if (!has(key)) return std::nullopt;
  std::string given;
  read(key, given);
  const auto found = std::find(choices.begin(), choices.end(), given);
  if (found == choices.end())
    fail(key, fmt::format("'{}' is not one of {}", given, fmt::join(choices, ", ")));
  return static_cast<std::size_t>(found - choices.begin());
}

void TomlReader::read(const std::string& key, std::array<std::uint32_t, 3>& value, std::uint32_t lowest,
                      std::uint32_t highest) {
  const toml::node* found = node(key);
  if (!found) return;
  const std::string expected = fmt::format("must be three whole numbers from {} to {}", lowest, highest);
  const toml::array* array = found->as_array();
  if (!array || array->size() != value.size()) fail_at(found->source(), key, expected);
  for (std::size_t i = 0; i < value.size(); ++i) {
    const auto* number = (*array)[i].as_integer();
    if (!number || number->get() < lowest || number->get() > highest)
      fail_at((*array)[i].source(), key, expected);
    value[i] = static_cast<std::uint32_t>(number->get());
  }
}

void TomlReader::read(const std::string& key, Vec3d& value) {
  if (const toml::node* found = node(key)) value = point(*found, key, "three finite numbers, [x, y, z]");
}

void TomlReader::read(const std::string& key, std::uint32_t& value, std::uint32_t lowest,
                      std::uint32_t highest) {
  read_whole(key, value, ValueRange::from(lowest, highest));
}

std::array<Vec3d, 2> TomlReader::corners(const toml::node& node, const std::string& key, const char* expected,
                                         bool may_be_flat) const {
  const toml::array* array = node.as_array();
  if (!array || array->size() != 2) fail_at(node.source(), key, fmt::format("must be {}", expected));
  const std::array<Vec3d, 2> box{point((*array)[0], key, expected), point((*array)[1], key, expected)};
  for (int axis = 0; axis < 3; ++axis) {
    if (box[0][axis] < box[1][axis] || (may_be_flat && box[0][axis] == box[1][axis])) continue;
    fail_at(node.source(), key,
            fmt::format("each coordinate of the first corner must {} the second's",
                        may_be_flat ? "not be above" : "be below"));
  }
  return box;
}

void TomlReader::read_box(const std::string& key, std::array<Vec3d, 2>& box, bool may_be_flat) {
  if (const toml::node* found = node(key))
    box = corners(*found, key, "two corners, [[x, y, z], [x, y, z]], the lowest first", may_be_flat);
}

bool TomlReader::read_cube(const std::string& key, const std::string& word, std::optional<RootCube>& cube) {
  const toml::node* found = node(key);
  if (!found) return true;
  if (found->is_string() && found->as_string()->get() == word) return false;
  const std::string expected = fmt::format("[x, y, z, edge], {}, or \"{}\"", range_of_root_cube, word);
  const toml::array* array = found->as_array();
  if (!array || array->size() != 4) fail(key, "must be " + expected);
  std::array<double, 4> numbers{};
  for (std::size_t i = 0; i < 4; ++i) numbers[i] = number((*array)[i], key, expected.c_str());
  cube = RootCube{{numbers[0], numbers[1], numbers[2]}, numbers[3]};
  if (!is_valid(*cube)) fail(key, "must be " + expected);
  return true;
}

void TomlReader::read(const std::string& key, std::vector<std::array<Vec3d, 2>>& boxes) {
  constexpr const char* expected = "an array of boxes, each [[x, y, z], [x, y, z]], the lowest corner first";
  const toml::node* found = node(key);
  if (!found) return;
  if (!found->is_array()) fail_at(found->source(), key, fmt::format("must be {}", expected));
  for (const toml::node& one : *found->as_array()) boxes.push_back(corners(one, key, expected, true));
}

const toml::table* TomlReader::table(const std::string& key) {
  const toml::node* found = node(key);
  if (found && !found->is_table()) fail_at(found->source(), key, "must be a table");
  return found ? found->as_table() : nullptr;
}

std::vector<const toml::table*> TomlReader::tables(const std::string& key, const std::string& written) {
  const toml::node* found = node(key);
  std::vector<const toml::table*> tables;
  if (!found) return tables;
  if (!found->is_array_of_tables())
    fail_at(found->source(), key, fmt::format("must be written {}, once for each", written));
  for (const toml::node& table : *found->as_array()) tables.push_back(table.as_table());
  return tables;
}

void TomlReader::finish() const {
  for (const auto& [key, value] : table_) {
    if (std::find(known_.begin(), known_.end(), key.str()) != known_.end()) continue;
    const auto nearest = nearest_of(std::string(key.str()), known_);
    fail_at(key.source(), std::string(key.str()),
            fmt::format("unknown key{}; allowed here: {}",
                        nearest ? fmt::format(", did you mean {}?", *nearest) : "", fmt::join(known_, ", ")));
  }
}

}  // namespace supple::cli
