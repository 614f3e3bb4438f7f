#pragma once

#include <string>
#include <string_view>

namespace supple {

/// Quotes `text` for a message: at most 40 bytes, with control characters replaced.
std::string in_quotes(std::string_view text);

}  // namespace supple
