#pragma once

#include <filesystem>

#include "supple/formats.hpp"

namespace supple::cli {

/// As `read_mesh_file`, in a child process. So a file that makes Assimp crash is an `Error`, and not the end
/// of this program.
MeshFile read_in_child(const std::filesystem::path& path);

}  // namespace supple::cli
