#pragma once

#include <string>
#include <string_view>

namespace supple {

/// Replaces the control characters of `text`, so that messages are one line for any name of a file or mesh.
std::string one_line(std::string text);

/// Quotes `text` for a message: at most 40 bytes, with control characters replaced.
std::string in_quotes(std::string_view text);

}  // namespace supple
