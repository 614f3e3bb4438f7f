#include "scene_file/toml_reader.hpp"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace supple::cli {
namespace {

constexpr std::string_view bare_characters =
    "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+.,:=[]{} \t\r\n";
constexpr std::size_t most_levels = 64;
constexpr int most_parts = 64;

/// The end of the string that starts at `begin` with a quote, behind its last quote, or the end of the text.
/// A string of one line ends with its line.
std::size_t end_of_string(std::string_view text, std::size_t begin) {
  const char quote = text[begin];
  const bool is_long = text.substr(begin, 3) == std::string(3, quote);
  std::size_t i = begin + (is_long ? 3 : 1);
  for (; i < text.size(); ++i) {
    if (quote == '"' && text[i] == '\\') {
      ++i;
    } else if (is_long ? text.substr(i, 3) == std::string(3, quote) : text[i] == quote) {
      return i + (is_long ? 3 : 1);
    } else if (!is_long && text[i] == '\n') {
      return i;
    }
  }
  return text.size();
}

/// Whether the brackets at the beginning of `text` are followed by a key, as those of a table are.
bool names_a_table(std::string_view text) {
  text.remove_prefix(text.starts_with("[[") ? 2 : 1);
  text.remove_prefix(std::min(text.find_first_not_of(" \t"), text.size()));
  constexpr std::string_view no_key = "+.,:=[]{} \t\r\n#";
  return !text.empty() && no_key.find(text[0]) == std::string_view::npos;
}

}  // namespace

void check_toml_limits(std::string_view text, const std::filesystem::path& path) {
  int line = 1, parts = 1;
  std::string open;    // the brackets that are not closed yet
  bool begins = true;  // a line outside of all brackets
  const auto fail = [&](const std::string& what) {
    cli::fail("{}:{}: not valid TOML: {}", path.string(), line, what);
  };
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  for (std::size_t i = 0; i < text.size();) {
    const char c = text[i];
    if (c == '#') {
      i = std::min(text.find('\n', i), text.size());
      continue;
    }
    if (c == '"' || c == '\'') {
      const std::size_t end = end_of_string(text, i);
      for (const char of_string : text.substr(i, end - i)) line += of_string == '\n' ? 1 : 0;
      i = end;
      begins = false;
      continue;
    }
    if (bare_characters.find(c) == std::string_view::npos)
      fail(fmt::format("byte {:#04x} outside of a string; put names with such letters in quotes",
                       static_cast<unsigned char>(c)));
    if (c == '\n') ++line;
    if (begins && c == '[' && !names_a_table(text.substr(i))) fail("a table needs a name: [name]");
    if (c == '[' || c == '{') open.push_back(c);
    if (c == ']' || c == '}') {
      if (open.empty() || open.back() != (c == ']' ? '[' : '{'))
        fail(fmt::format("'{}' closes nothing that is open", c));
      open.pop_back();
    }
    parts = c == '.' ? parts + 1 : std::string_view("=,[]{}\n").find(c) != std::string_view::npos ? 1 : parts;
    if (open.size() > most_levels) fail(fmt::format("lists and tables of more than {} levels", most_levels));
    if (parts > most_parts) fail(fmt::format("a key of more than {} parts", most_parts));
    begins = open.empty() && (c == '\n' || (begins && (c == ' ' || c == '\t' || c == '\r')));
    ++i;
  }
}

const toml::node* TomlReader::node(const std::string& key) {
  if (std::find(known_.begin(), known_.end(), key) == known_.end()) known_.push_back(key);
  return table_.get(key);
}

double TomlReader::number(const toml::node& node, const std::string& key, const char* expected) const {
  if (const auto* value = node.as_floating_point(); value && std::isfinite(value->get())) return value->get();
  if (const auto* value = node.as_integer()) return static_cast<double>(value->get());
  fail_at(node.source(), key, "must be {}", expected);
}

const toml::array& TomlReader::array_of(const toml::node& node, const std::string& key,
                                        const std::string& expected, std::size_t size) const {
  const toml::array* array = node.as_array();
  if (!array || array->size() != size) fail_at(node.source(), key, "must be {}", expected);
  return *array;
}

Vec3d TomlReader::point(const toml::node& node, const std::string& key, const char* expected) const {
  const toml::array& array = array_of(node, key, expected, 3);
  return {number(array[0], key, expected), number(array[1], key, expected), number(array[2], key, expected)};
}

std::int64_t TomlReader::integer(const std::string& key, const ValueRange& range) {
  const toml::node& found = *node(key);
  const auto* value = found.as_integer();
  if (!value || value->get() < 0 || !range.allows(static_cast<std::uint64_t>(value->get())))
    fail_at(found.source(), key, "must be {}", text_of(range, true));
  return value->get();
}

void TomlReader::read(const std::string& key, std::string& value) {
  const auto* found = value_of<std::string>(key, "a string in quotes");
  if (!found) return;
  value = found->get();
  if (value.find('\0') != std::string::npos) fail(key, "has a character of code 0, which no name can have");
}

void TomlReader::read(const std::string& key, bool& value) {
  if (const auto* found = value_of<bool>(key, "true or false")) value = found->get();
}

void TomlReader::read(const std::string& key, double& value) {
  if (const toml::node* found = node(key)) value = number(*found, key, "a finite number");
}

void TomlReader::read(const std::string& key, double& value, const ValueRange& range) {
  const toml::node* found = node(key);
  if (!found) return;
  const std::string expected = text_of(range, false);
  value = number(*found, key, expected.c_str());
  if (!range.allows(value)) fail(key, "must be {}", expected);
}

std::optional<std::size_t> TomlReader::read_word(const std::string& key,
                                                 std::span<const char* const> choices) {
  if (!has(key)) return std::nullopt;
  std::string given;
  read(key, given);
  const auto found = std::find(choices.begin(), choices.end(), given);
  if (found == choices.end()) fail(key, "'{}' is not one of {}", given, fmt::join(choices, ", "));
  return static_cast<std::size_t>(found - choices.begin());
}

void TomlReader::read(const std::string& key, std::array<std::uint32_t, 3>& value, std::uint32_t lowest,
                      std::uint32_t highest) {
  const toml::node* found = node(key);
  if (!found) return;
  const std::string expected = fmt::format("three whole numbers from {} to {}", lowest, highest);
  const toml::array& array = array_of(*found, key, expected, value.size());
  for (std::size_t i = 0; i < value.size(); ++i) {
    const auto* number = array[i].as_integer();
    if (!number || number->get() < lowest || number->get() > highest)
      fail_at(array[i].source(), key, "must be {}", expected);
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
  const toml::array& array = array_of(node, key, expected, 2);
  const std::array<Vec3d, 2> box{point(array[0], key, expected), point(array[1], key, expected)};
  for (int axis = 0; axis < 3; ++axis) {
    if (box[0][axis] < box[1][axis] || (may_be_flat && box[0][axis] == box[1][axis])) continue;
    fail_at(node.source(), key, "each coordinate of the first corner must {} the second's",
            may_be_flat ? "not be above" : "be below");
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
  const toml::array& array = array_of(*found, key, expected, 4);
  std::array<double, 4> numbers{};
  for (std::size_t i = 0; i < 4; ++i) numbers[i] = number(array[i], key, expected.c_str());
  cube = RootCube{{numbers[0], numbers[1], numbers[2]}, numbers[3]};
  if (!is_valid(*cube)) fail(key, "must be {}", expected);
  return true;
}

void TomlReader::read(const std::string& key, std::vector<std::array<Vec3d, 2>>& boxes) {
  constexpr const char* expected = "an array of boxes, each [[x, y, z], [x, y, z]], the lowest corner first";
  const auto* found = value_of<toml::array>(key, expected);
  if (!found) return;
  for (const toml::node& one : *found) boxes.push_back(corners(one, key, expected, true));
}

const toml::table* TomlReader::table(const std::string& key) {
  return value_of<toml::table>(key, "a table");
}

std::vector<const toml::table*> TomlReader::tables(const std::string& key, const std::string& written) {
  const toml::node* found = node(key);
  std::vector<const toml::table*> tables;
  if (!found) return tables;
  if (!found->is_array_of_tables())
    fail_at(found->source(), key, "must be written {}, once for each", written);
  for (const toml::node& table : *found->as_array()) tables.push_back(table.as_table());
  return tables;
}

void TomlReader::finish() const {
  for (const auto& [key, value] : table_) {
    if (std::find(known_.begin(), known_.end(), key.str()) != known_.end()) continue;
    const auto nearest = nearest_of(std::string(key.str()), known_);
    fail_at(key.source(), std::string(key.str()), "unknown key{}; allowed here: {}",
            nearest ? fmt::format(", did you mean {}?", *nearest) : "", fmt::join(known_, ", "));
  }
}

}  // namespace supple::cli
