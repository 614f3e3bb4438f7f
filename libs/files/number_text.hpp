#pragma once

#include <charconv>
#include <cstdint>
#include <string>

namespace supple {

/// Reads the decimal number at the start of [first, last), correctly rounded, in any locale. Also accepts a
/// leading '+', and `inf`, `infinity` and `nan` in any case, and what Microsoft's older libraries print for
/// them (`1.#INF`, `-1.#IND`). A number that is too large becomes an infinity,
/// and a number that is too small becomes a zero, with its sign. Returns the end of the number, or null when
/// no number starts there.
const char* parse_double(const char* first, const char* last, double& value);

/// Reads the decimal integer at the start of [first, last), with an optional sign. Returns the end of the
/// integer, or null when no integer starts there or it needs more than 64 bits.
const char* parse_integer(const char* first, const char* last, std::int64_t& value);

/// Appends the shortest digits that `parse_double` reads back to the same value (without the payload of a
/// NaN), or an integer.
template <class Number>
void append_number(std::string& text, Number value) {
  char digits[32];
  text.append(digits, std::to_chars(digits, digits + sizeof digits, value).ptr);
}

/// Appends numbers with blanks between them, and the end of the line.
template <class... Numbers>
void append_line(std::string& text, Numbers... numbers) {
  ((append_number(text, numbers), text += ' '), ...);
  text.back() = '\n';
}

}  // namespace supple
