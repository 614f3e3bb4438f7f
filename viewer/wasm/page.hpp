#pragma once

#include <string_view>

namespace supple::viewer {

/// Tells the page what is wrong, which throws there: the module is of no use from then on. Takes no memory.
[[noreturn]] void fail_in_page(std::string_view message);

}  // namespace supple::viewer
