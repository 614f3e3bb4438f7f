#include "motion/check_options.hpp"

#include <cmath>
#include <string>

#include "core/error.hpp"
#include "supple/simulation_descriptions.hpp"

namespace supple {

void check_options(const MassSpringOptions& options, const TriangleMesh& mesh) {
  const std::string where = "masses and springs of mesh '" + mesh.name + "'";
  check(options, where);
  if (!std::isfinite(1 / options.vertex_mass))
    fail(where + ": vertex_mass is " + text_of(options.vertex_mass) + "; its reciprocal must be finite");
  for (const std::uint32_t vertex : options.fixed_vertices) {
    if (vertex >= mesh.positions.size())
      fail(where + ": a fixed vertex is " + std::to_string(vertex) + "; it must be below " +
           std::to_string(mesh.positions.size()) + ", the number of vertices");
  }
}

}  // namespace supple
