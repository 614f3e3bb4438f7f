#include "files/number_text.hpp"

#include <algorithm>
#include <limits>
#include <string_view>
#include <system_error>

namespace supple {
namespace {

// Skips a '+' unless another sign follows it: "+-1" is not a number.
const char* skip_plus(const char* first, const char* last) {
  const bool lone_plus = last - first >= 2 && first[0] == '+' && first[1] != '-' && first[1] != '+';
  return lone_plus ? first + 1 : first;
}

// Whether a decimal number out of the range of double is too large; otherwise it is too small.
bool is_too_large(std::string_view number) {
  const std::size_t exponent_mark = number.find_first_of("eE");
  const std::string_view mantissa = number.substr(0, exponent_mark);
  const std::size_t point = std::min(mantissa.find('.'), mantissa.size());
  const std::size_t leading = mantissa.find_first_of("123456789");
  std::int64_t exponent = 0;
  if (exponent_mark != std::string_view::npos) {
    const std::string_view digits = number.substr(exponent_mark + 1);
    if (parse_integer(digits.data(), digits.data() + digits.size(), exponent) == nullptr) {
      return digits[0] != '-';
    }
  }
  return exponent > static_cast<std::int64_t>(leading) - static_cast<std::int64_t>(point);
}

// Infinities and NaN as older Microsoft libraries print them, such as 1.#INF and -1.#IND000. Null when it is
// none of them.
const char* parse_microsoft(const char* first, const char* last, double& value) {
  std::string_view rest(first, last);
  const bool is_negative = rest.starts_with('-');
  if (is_negative) rest.remove_prefix(1);
  if (!rest.starts_with("1.#")) return nullptr;
  rest.remove_prefix(3);
  for (const std::string_view word : {"INF", "IND", "QNAN", "SNAN"}) {
    if (!rest.starts_with(word)) continue;
    const double magnitude =
        word == "INF" ? std::numeric_limits<double>::infinity() : std::numeric_limits<double>::quiet_NaN();
    value = is_negative ? -magnitude : magnitude;
    rest.remove_prefix(std::min(rest.find_first_not_of("0123456789", word.size()), rest.size()));
    return rest.data();
  }
  return nullptr;
}

}  // namespace

const char* parse_double(const char* first, const char* last, double& value) {
  first = skip_plus(first, last);
  const auto [end, error] = std::from_chars(first, last, value);
  if (error == std::errc::invalid_argument) return nullptr;
  if (end != last && *end == '#') {
    if (const char* special = parse_microsoft(first, last, value)) return special;
  }
  if (error == std::errc::result_out_of_range) {
    const double magnitude = is_too_large({first, end}) ? std::numeric_limits<double>::infinity() : 0.0;
    value = *first == '-' ? -magnitude : magnitude;
  }
  return end;
}

const char* parse_integer(const char* first, const char* last, std::int64_t& value) {
  first = skip_plus(first, last);
  const auto [end, error] = std::from_chars(first, last, value);
  return error == std::errc() ? end : nullptr;
}

}  // namespace supple
