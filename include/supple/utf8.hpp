#pragma once

#include <string>
#include <string_view>

namespace supple {

/// Replaces every byte that is not part of valid UTF-8 by U+FFFD, because names of files, and names in files,
/// may be any bytes.
std::string valid_utf8(std::string_view text);

/// Text for messages and tables: valid UTF-8 in one line. Line breaks and other control characters become
/// `replacement`. Blanks at the end are left out.
std::string one_line(std::string_view text, char replacement = ' ');

}  // namespace supple
