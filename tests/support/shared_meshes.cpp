#include "support/shared_meshes.hpp"

#include <cstdlib>

namespace supple {

std::filesystem::path shared_meshes() {
  if (const char* folder = std::getenv("SUPPLE_DATA")) return folder;
  return SUPPLE_SHARED_DATA;
}

}  // namespace supple
