#include "core/quotes.hpp"

namespace supple {

std::string in_quotes(std::string_view text) {
  constexpr std::size_t longest = 40;
  std::size_t shown = text.size();
  if (shown > longest) {
    shown = longest;
    // Not the first bytes of a character.
    while (shown > longest - 4 && (text[shown] & 0xc0) == 0x80) --shown;
  }
  std::string result = "'";
  result += one_line(text.substr(0, shown), '?');
  result += shown < text.size() ? "...'" : "'";
  return result;
}

}  // namespace supple
