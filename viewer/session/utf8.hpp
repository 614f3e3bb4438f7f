#pragma once

#include <string>
#include <string_view>

namespace supple::viewer {

/// The text with every byte that is not part of valid UTF-8 made U+FFFD: file names need not be text at all.
std::string valid_utf8(std::string_view text);

}  // namespace supple::viewer
