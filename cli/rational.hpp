#pragma once

#include <boost/multiprecision/cpp_int.hpp>
#include <optional>
#include <string_view>

namespace supple::cli {

using Integer = boost::multiprecision::cpp_int;
using Rational = boost::multiprecision::cpp_rational;

/// A whole number of any size in decimal digits, a sign before them if need be; nothing when it is none.
std::optional<Integer> parse_integer(std::string_view text);

/// The double that is exactly `value`; nothing when there is none.
std::optional<double> exact_double(const Rational& value);

/// The same of a quotient as text, without integers of any size: nothing for all but two whole numbers up to
/// 2^53, the second not 0, whose quotient is a double. Nearly all published coordinates are such.
std::optional<double> exact_small_quotient(std::string_view numerator, std::string_view denominator);

}  // namespace supple::cli
