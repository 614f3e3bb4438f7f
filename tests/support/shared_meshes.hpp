#pragma once

#include <filesystem>

namespace supple {

/// The folder of real meshes with known answers: `SUPPLE_DATA`, or else `shared/data` beside the repository.
/// It may not exist; tests that need it then report that they are skipped.
std::filesystem::path shared_meshes();

}  // namespace supple
