#include "mesh/quotes.hpp"

namespace supple {

std::string in_quotes(std::string_view text) {
  constexpr std::size_t longest = 40;
  std::string result = "'";
  for (const char c : text.substr(0, longest)) {
    const auto code = static_cast<unsigned char>(c);
    result += code < 32 || code == 127 ? '?' : c;
  }
  return result + (text.size() > longest ? "...'" : "'");
}

}  // namespace supple
