#include "query/rational.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <string>
#include <system_error>

namespace supple::cli {

std::optional<Integer> parse_integer(std::string_view text) {
  const bool negative = text.starts_with('-');
  if (negative || text.starts_with('+')) text.remove_prefix(1);
  if (text.empty() || text.find_first_not_of("0123456789") != std::string_view::npos) return std::nullopt;
  // A leading zero would make it an octal number.
  text.remove_prefix(std::min(text.find_first_not_of('0'), text.size() - 1));
  Integer value{std::string(text)};
  if (negative) value = -value;
  return value;
}

std::optional<double> exact_double(const Rational& value) {
  const auto nearest = value.convert_to<double>();
  return std::isfinite(nearest) && Rational(nearest) == value ? std::optional(nearest) : std::nullopt;
}

std::optional<double> exact_small_quotient(std::string_view numerator, std::string_view denominator) {
  constexpr std::int64_t most = std::int64_t{1} << 53;
  const auto parse = [](std::string_view text, std::int64_t& value) {
    const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), value);
    return fault == std::errc{} && end == text.data() + text.size() && -most <= value && value <= most;
  };
  std::int64_t top = 0, bottom = 0;
  if (!parse(numerator, top) || !parse(denominator, bottom) || bottom == 0) return std::nullopt;
  if (top == 0) return 0.0;
  const double n = static_cast<double>(top), d = static_cast<double>(bottom), quotient = n / d;
  // The remainder of a division is a double, so the fused product computes it exactly.
  if (std::fma(quotient, d, -n) != 0) return std::nullopt;
  return quotient;
}

}  // namespace supple::cli
