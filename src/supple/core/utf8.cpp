#include "supple/utf8.hpp"

#include <algorithm>
#include <cstddef>

namespace supple {
namespace {

/// A character of a text: its code point, and the number of its bytes; 0 when these are not UTF-8.
struct Character {
  char32_t code = 0;
  std::size_t size = 0;
};

Character first_character(std::string_view text) {
  constexpr char32_t smallest[] = {0, 0, 0x80, 0x800, 0x10000};
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned lead = byte(0);
  if (lead < 0x80) return {lead, 1};
  const std::size_t size = lead >= 0xf0 ? 4 : lead >= 0xe0 ? 3 : 2;
  if (lead < 0xc0 || lead >= 0xf8 || text.size() < size) return {};
  char32_t code = lead & (0x7fu >> size);
  for (std::size_t i = 1; i < size; ++i) {
    if ((byte(i) & 0xc0) != 0x80) return {};
    code = code << 6 | (byte(i) & 0x3f);
  }
  const bool is_surrogate = code >= 0xd800 && code < 0xe000;
  if (code < smallest[size] || code > 0x10ffff || is_surrogate) return {};
  return {code, size};
}

/// Control characters, and the line and paragraph separators of Unicode.
bool is_control(char32_t code) {
  return code < 0x20 || (code >= 0x7f && code < 0xa0) || code == 0x2028 || code == 0x2029;
}

/// The text as valid UTF-8; `write(result, character, bytes)` appends a valid character.
template <class Write>
std::string with_valid_characters(std::string_view text, const Write& write) {
  std::string valid;
  valid.reserve(text.size());
  while (!text.empty()) {
    const Character character = first_character(text);
    if (character.size == 0)
      valid += "\xef\xbf\xbd";  // U+FFFD
    else
      write(valid, character.code, text.substr(0, character.size));
    text.remove_prefix(std::max<std::size_t>(character.size, 1));
  }
  return valid;
}

}  // namespace

std::string valid_utf8(std::string_view text) {
  return with_valid_characters(text,
                               [](std::string& valid, char32_t, std::string_view bytes) { valid += bytes; });
}

std::string one_line(std::string_view text, char replacement) {
  std::string line =
      with_valid_characters(text, [replacement](std::string& valid, char32_t code, std::string_view bytes) {
        if (is_control(code))
          valid += replacement;
        else
          valid += bytes;
      });
  line.erase(line.find_last_not_of(' ') + 1);
  return line;
}

}  // namespace supple
