#pragma once

#include <filesystem>
#include <span>
#include <string_view>

#include "supple/formats.hpp"

namespace supple {

/// The extensions of the formats with a reader in this library, beside those of `load_mesh`.
std::span<const std::string_view> own_extensions();

/// Whether a reader of this library reads the file. It depends on the extension, and for .mesh on the
/// content, because Ogre's meshes have this extension, too.
bool has_own_reader(const std::filesystem::path& path);

/// Reads such a file.
MeshFile read_own_format(const std::filesystem::path& path);

}  // namespace supple
