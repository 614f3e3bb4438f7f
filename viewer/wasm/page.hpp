#pragma once

#include <string_view>

namespace supple::viewer {

/// Reports an error to the page, where it throws. The module is unusable afterwards. Allocates no memory.
[[noreturn]] void fail_in_page(std::string_view message);

}  // namespace supple::viewer
