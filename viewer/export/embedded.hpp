#pragma once

#include <cstddef>
#include <span>
#include <string_view>

namespace supple::viewer {

// The page (one HTML file) and the WebAssembly module with the library and its sessions. Both are part of
// the program, and empty in a build without SUPPLE_BUILD_VIEWER.
std::string_view embedded_page();
std::span<const std::byte> embedded_module();

}  // namespace supple::viewer
