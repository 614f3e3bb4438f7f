#pragma once

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <string>

namespace supple::cli {

/// Opens a file of text, or a pipe of the shell such as <(command). Throws `Error` for folders, devices and
/// named pipes, which may never end, and when the file cannot be opened.
std::ifstream open_input(const std::filesystem::path& path);

/// Reads such a file, at most `most` bytes.
std::string read_text(const std::filesystem::path& path, std::size_t most = ~std::size_t{0});

}  // namespace supple::cli
