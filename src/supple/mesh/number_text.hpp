#pragma once

#include <cstdint>
#include <string>

namespace supple {

/// Reads the decimal number at the start of [first, last), correctly rounded, whatever the locale. Also takes
/// a leading '+', `inf`, `infinity` and `nan` in any case; too large a number is an infinity and too small a
/// one a zero, with its sign. Returns the end of what was read, or null when no number starts there.
const char* parse_double(const char* first, const char* last, double& value);

/// Reads the decimal integer at the start of [first, last), with an optional sign. Returns the end of what
/// was read, or null when no integer starts there or it needs more than 64 bits.
const char* parse_integer(const char* first, const char* last, std::int64_t& value);

/// Appends the shortest digits from which `parse_double` makes the same value again (the payload of a NaN
/// is not kept).
void append_double(std::string& text, double value);

void append_integer(std::string& text, std::uint64_t value);

}  // namespace supple
