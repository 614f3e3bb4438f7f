#include "workloads/shared_data.hpp"
#include "supple/mesh_file.hpp"

#include <cstdlib>
#include <filesystem>

namespace supple::benchmarks {

std::filesystem::path shared_data() {
  if (const char* const folder = std::getenv("SUPPLE_DATA")) return folder;
  return SUPPLE_BENCHMARK_DATA;
}

std::optional<TriangleMesh> load_shared(const std::filesystem::path& relative) {
  const std::filesystem::path path = shared_data() / relative;
  if (!std::filesystem::exists(path)) return std::nullopt;
  return load_mesh(path);
}

}  // namespace supple::benchmarks
