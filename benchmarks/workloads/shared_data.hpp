#pragma once

#include <filesystem>
#include <optional>

#include "supple/mesh.hpp"

namespace supple::benchmarks {

/// The folder of real meshes, which are not part of the project: the environment variable SUPPLE_DATA, or
/// ../shared/data beside the source tree. It may not exist.
std::filesystem::path shared_data();

/// Returns nothing when the folder does not contain the file.
std::optional<TriangleMesh> load_shared(const std::filesystem::path& relative);

}  // namespace supple::benchmarks
