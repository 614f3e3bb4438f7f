#pragma once

#include <string>
#include <string_view>

namespace supple {

/// `text` with its control characters replaced, so that a message stays on one line.
std::string one_line(std::string text);

/// `text` between single quotes for a message: at most 40 bytes of it, control characters replaced.
std::string in_quotes(std::string_view text);

}  // namespace supple
