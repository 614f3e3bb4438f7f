#include <span>
#include <string>

#include "core/error.hpp"
#include "core/quotes.hpp"
#include "supple/mesh.hpp"

namespace supple {

void check_mesh(const TriangleMesh& mesh) {
  const auto check = [&](const char* what, std::size_t i, std::span<const std::uint32_t> ids) {
    for (const std::uint32_t id : ids) {
      if (id < mesh.positions.size()) continue;
      fail("mesh " + in_quotes(mesh.name) + ": " + what + " " + std::to_string(i) + " uses vertex " +
           std::to_string(id) + "; the mesh has " + std::to_string(mesh.positions.size()) +
           " vertices, counted from 0");
    }
  };
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) check("triangle", i, mesh.triangles[i]);
  for (std::size_t i = 0; i < mesh.edges.size(); ++i) {
    check("edge", i, mesh.edges[i]);
    if (mesh.edges[i][0] == mesh.edges[i][1])
      fail("mesh " + in_quotes(mesh.name) + ": both ends of edge " + std::to_string(i) + " are vertex " +
           std::to_string(mesh.edges[i][0]) + "; list it in points");
  }
  for (std::size_t i = 0; i < mesh.points.size(); ++i) check("point", i, {&mesh.points[i], 1});
}

}  // namespace supple
