#pragma once

#include <string>
#include <string_view>

#include "supple/utf8.hpp"

namespace supple {

/// Quotes `text` for a message: at most 40 bytes, as valid UTF-8 with control characters replaced.
std::string in_quotes(std::string_view text);

}  // namespace supple
