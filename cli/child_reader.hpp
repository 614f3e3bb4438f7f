#pragma once

#include <filesystem>

#include "supple/mesh.hpp"

namespace supple::cli {

/// As `load_any_mesh`, in a child process. So a file that makes Assimp crash is an `Error`, and not the end
/// of this program.
TriangleMesh load_in_child(const std::filesystem::path& path);

}  // namespace supple::cli
