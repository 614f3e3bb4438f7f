#pragma once

#include <filesystem>
#include <optional>

#include "supple/mesh.hpp"

namespace supple::benchmarks {

/// The folder of real meshes that is not part of the project: SUPPLE_DATA of the environment, else
/// ../shared/data beside the source tree. It need not exist.
std::filesystem::path shared_data();

/// Nothing when the folder has no such file.
std::optional<TriangleMesh> load_shared(const std::filesystem::path& relative);

}  // namespace supple::benchmarks
