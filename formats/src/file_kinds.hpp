#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace supple {

/// The first 4096 bytes of a file; nothing when it cannot be read or is no regular file.
std::string read_start(const std::filesystem::path& path);

/// Whether the first bytes are those of Ogre's .mesh and not of Medit's.
bool is_ogre_mesh(std::string_view start);

/// Fails when the first bytes of the file show a format that does not fit its extension, or that no reader
/// supports: names the format, and says what to do. Does nothing when the format is not recognised.
void check_kind(const std::filesystem::path& path, std::string_view start);

/// Fails for an extension that no reader knows: names the format if it is known, and says what to export.
[[noreturn]] void fail_unsupported(const std::filesystem::path& path, std::string_view start);

/// The name of a format that is not supported, and what to export instead, as two clauses for a message:
/// "Alembic is not supported; export ...". Empty when the extension (lower case, with its dot) is not one of
/// these formats.
std::string advice_on_extension(std::string_view extension);

}  // namespace supple
