#include <string>

#include "core/error.hpp"
#include "mesh/quotes.hpp"
#include "supple/mesh.hpp"

namespace supple {

void check_mesh(const TriangleMesh& mesh) {
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    for (const std::uint32_t id : mesh.triangles[i]) {
      if (id < mesh.positions.size()) continue;
      fail("mesh " + in_quotes(mesh.name) + ": triangle " + std::to_string(i) + " uses vertex " +
           std::to_string(id) + "; the mesh has " + std::to_string(mesh.positions.size()) +
           " vertices, counted from 0");
    }
  }
}

}  // namespace supple
