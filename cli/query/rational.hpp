#pragma once

#include <boost/multiprecision/cpp_int.hpp>
#include <optional>
#include <string_view>

namespace supple::cli {

using Integer = boost::multiprecision::cpp_int;
using Rational = boost::multiprecision::cpp_rational;

/// Reads a whole number of any size in decimal digits, with an optional sign; nothing when the text is not
/// one.
std::optional<Integer> parse_integer(std::string_view text);

/// The double that is equal to `value`; nothing when there is none.
std::optional<double> exact_double(const Rational& value);

/// The same for a quotient as text, without integers of unlimited size. It returns nothing unless both are
/// whole numbers up to 2^53, the second is not 0, and the quotient is a double. Nearly all published
/// coordinates are of this kind.
std::optional<double> exact_small_quotient(std::string_view numerator, std::string_view denominator);

}  // namespace supple::cli
