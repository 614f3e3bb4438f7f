#include "files/number_text.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <string>

#include "support/random.hpp"

namespace supple::number_text_test {

std::uint64_t bits(double value) {
  return std::bit_cast<std::uint64_t>(value);
}

// The parsed number, or NaN if the text is not exactly one number. No text in these tests means NaN.
double parsed(const std::string& text) {
  double value = std::nan("");
  const char* end = parse_double(text.data(), text.data() + text.size(), value);
  return end == text.data() + text.size() ? value : std::nan("");
}

TEST(ParseDouble, AgreesWithTheStandardLibrary) {
  for (const char* text : {"0",
                           "-0",
                           "+0",
                           "1",
                           "+1",
                           "1.",
                           ".5",
                           "-.5e1",
                           "0.1",
                           "1e22",
                           "1e23",
                           "8.5e-324",
                           "5e-324",
                           "3e-324",
                           "2e-324",
                           "-2e-324",
                           "2.2250738585072011e-308",
                           "2.2250738585072014e-308",
                           "1.7976931348623157e308",
                           "1.7976931348623159e308",
                           "9007199254740993",
                           "1e400",
                           "-1e400",
                           "+1e400",
                           "1e-400",
                           "-1e-400",
                           "0e99999",
                           "0.0e-99999",
                           "1e99999999999999999999999",
                           "1e-99999999999999999999999",
                           "0.00000000000000000000000000000000000000000000001e400",
                           "123456789012345678901234567890e300",
                           "inf",
                           "-inf",
                           "+inf",
                           "INF",
                           "Infinity",
                           "-infinity"}) {
    EXPECT_EQ(bits(parsed(text)), bits(std::strtod(text, nullptr))) << text;
  }
}

TEST(ParseDouble, WhatMicrosoftPrints) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(parsed("1.#INF"), infinity);
  EXPECT_EQ(parsed("-1.#INF000"), -infinity);
  for (const std::string text : {"1.#QNAN", "-1.#IND", "1.#SNAN0", "+1.#QNAN000", "nan(ind)", "-nan(snan)"}) {
    double value = 0;
    EXPECT_EQ(parse_double(text.data(), text.data() + text.size(), value), text.data() + text.size()) << text;
    EXPECT_TRUE(std::isnan(value)) << text;
  }
  for (const std::string text : {"1.#", "1.#inf", "1.#IN", "2.#INF", "1#INF"}) {
    double value = 0;
    EXPECT_EQ(*parse_double(text.data(), text.data() + text.size(), value), '#') << text;
    EXPECT_EQ(value, text[0] - '0');
  }
}

TEST(ParseDouble, LongDigitStringsBeyondTheRange) {
  const std::string zeros(400, '0');
  for (const std::string& text : {"1" + zeros, "-1" + zeros + ".5", "0." + zeros + "1", "-." + zeros + "1",
                                  "0." + zeros + "1e401", "1" + zeros + "e-400", "1" + zeros + "e-1000"}) {
    EXPECT_EQ(bits(parsed(text)), bits(std::strtod(text.c_str(), nullptr))) << text;
  }
}

TEST(ParseDouble, NotANumberKeepsItsSign) {
  for (const std::string text : {"nan", "NaN", "+nan", "-nan"}) {
    double value = 0;
    EXPECT_EQ(parse_double(text.data(), text.data() + text.size(), value), text.data() + text.size()) << text;
    EXPECT_TRUE(std::isnan(value)) << text;
    EXPECT_EQ(std::signbit(value), text[0] == '-') << text;
  }
}

TEST(ParseDouble, RefusesWhatIsNoNumber) {
  for (const std::string text : {"", "+", "-", ".", "e5", "abc", "+-1", "-+1", "++1", " 1", ",5"}) {
    double value = 0;
    EXPECT_EQ(parse_double(text.data(), text.data() + text.size(), value), nullptr) << text;
  }
}

TEST(ParseDouble, StopsWhereTheNumberEnds) {
  const std::string text = "1.5/2";
  double value = 0;
  EXPECT_EQ(parse_double(text.data(), text.data() + text.size(), value), text.data() + 3);
  EXPECT_EQ(value, 1.5);
  EXPECT_EQ(parse_double(text.data(), text.data() + 2, value), text.data() + 2);
  EXPECT_EQ(value, 1.0);
}

TEST(AppendDouble, ReadsBackToTheSameBits) {
  RandomNumbers random(1);
  for (int i = 0; i < 100000; ++i) {
    const double value = std::bit_cast<double>(random.bits());
    if (std::isnan(value)) continue;
    std::string text;
    append_number(text, value);
    ASSERT_EQ(bits(parsed(text)), bits(value)) << text;
    ASSERT_EQ(bits(std::strtod(text.c_str(), nullptr)), bits(value)) << text;
  }
}

TEST(ParseInteger, SignsAndLimits) {
  const auto integer = [](const std::string& text) {
    std::int64_t value = -77;
    const char* end = parse_integer(text.data(), text.data() + text.size(), value);
    return end == text.data() + text.size() ? value : -77;
  };
  EXPECT_EQ(integer("12"), 12);
  EXPECT_EQ(integer("-12"), -12);
  EXPECT_EQ(integer("+12"), 12);
  EXPECT_EQ(integer("9223372036854775807"), 9223372036854775807);
  EXPECT_EQ(integer("9223372036854775808"), -77);
  EXPECT_EQ(integer("+-1"), -77);
  EXPECT_EQ(integer("x"), -77);
  EXPECT_EQ(integer(""), -77);
}

}  // namespace supple::number_text_test
