#pragma once

#include <string>
#include <string_view>

namespace supple::viewer {

/// Replaces every byte that is not part of valid UTF-8 by U+FFFD, because file names may be any bytes.
std::string valid_utf8(std::string_view text);

}  // namespace supple::viewer
