#pragma once

#include <filesystem>
#include <string>

namespace supple {

/// The path as messages show it.
std::string shown(const std::filesystem::path& path);

/// With its dot; empty when there is none.
std::string lower_case_extension(const std::filesystem::path& path);

/// Fails with "cannot open ..." and the system's reason when the file cannot be read or is a directory.
void check_readable(const std::filesystem::path& path);

/// All bytes of a file. Fails as `check_readable` does.
std::string read_file(const std::filesystem::path& path);

/// Makes or replaces a file. Fails with "cannot write ..." when that is not allowed or the disk is full.
void write_file(const std::filesystem::path& path, const std::string& bytes);

}  // namespace supple
