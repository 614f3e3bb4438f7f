#pragma once

#include <string>
#include <string_view>

namespace supple {

/// `text` between single quotes for a message: at most 40 bytes of it, control characters replaced.
std::string in_quotes(std::string_view text);

}  // namespace supple
