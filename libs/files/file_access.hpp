#pragma once

#include <filesystem>
#include <string>

namespace supple {

/// The path for messages.
std::string shown(const std::filesystem::path& path);

/// The extension with its dot, in lower case; empty when there is none.
std::string lower_case_extension(const std::filesystem::path& path);

/// Fails with "cannot open ..." and the reason when the file cannot be read, or is a directory, a pipe or a
/// device.
void check_readable(const std::filesystem::path& path);

/// Reads all bytes of a file. Fails as `check_readable` does.
std::string read_file(const std::filesystem::path& path);

/// Creates or replaces a file. Fails with "cannot write ..." when that is not allowed or the disk is full.
void write_file(const std::filesystem::path& path, const std::string& bytes);

}  // namespace supple
