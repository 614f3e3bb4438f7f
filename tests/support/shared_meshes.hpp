#pragma once

#include <filesystem>

namespace supple {

/// The folder of real meshes with known results: `SUPPLE_DATA`, or `shared/data` beside the repository. If it
/// does not exist, tests that need it are skipped.
std::filesystem::path shared_meshes();

}  // namespace supple
