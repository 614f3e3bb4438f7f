#pragma once

#include <cstddef>
#include <span>
#include <string_view>

namespace supple::viewer {

// The page, one file of HTML, and the library with its sessions as a module of WebAssembly, both part of the
// program; empty in a build without SUPPLE_BUILD_VIEWER.
std::string_view embedded_page();
std::span<const std::byte> embedded_module();

}  // namespace supple::viewer
