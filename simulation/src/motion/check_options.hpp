#pragma once

#include "supple/mesh.hpp"
#include "supple/motion.hpp"

namespace supple {

/// Throws `Error` with the mesh, the option, its value and its range when an option is out of range.
void check_options(const MassSpringOptions& options, const TriangleMesh& mesh);

}  // namespace supple
