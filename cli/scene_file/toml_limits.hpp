#pragma once

#include <filesystem>
#include <string_view>

namespace supple::cli {

/// Checks what the TOML parser cannot: before it parses, the text must have only characters that TOML allows
/// outside of strings and comments, brackets that match, and neither deep lists and tables nor keys of many
/// parts, which would overflow the stack. Throws `Error` with file and line.
void check_toml_limits(std::string_view text, const std::filesystem::path& path);

/// Files beyond this size are not read, bytes.
inline constexpr std::size_t most_toml_bytes = std::size_t{64} << 20;

}  // namespace supple::cli
