#include "mesh/quotes.hpp"

#include <algorithm>

namespace supple {

std::string one_line(std::string text) {
  std::ranges::replace_if(
      text, [](unsigned char c) { return c < 32 || c == 127; }, '?');
  return text;
}

std::string in_quotes(std::string_view text) {
  constexpr std::size_t longest = 40;
  std::string result = "'";
  result += one_line(std::string(text.substr(0, longest)));
  return result + (text.size() > longest ? "...'" : "'");
}

}  // namespace supple
