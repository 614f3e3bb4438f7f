#pragma once

#include <cstdlib>
#include <filesystem>

namespace supple {

/// The folder of real meshes with known answers; it may not exist, which tests skip on.
inline std::filesystem::path shared_meshes() {
  if (const char* folder = std::getenv("SUPPLE_DATA")) return folder;
  const auto repository =
      std::filesystem::path(__FILE__).parent_path().parent_path().parent_path().parent_path();
  return repository.parent_path() / "shared" / "data";
}

}  // namespace supple
