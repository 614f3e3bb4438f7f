#include "scene_file/toml_limits.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cstddef>
#include <string>

#include "supple/error.hpp"

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
    throw Error(fmt::format("{}:{}: not valid TOML: {}", path.string(), line, what));
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

}  // namespace supple::cli
