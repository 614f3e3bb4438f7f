#pragma once

#include "supple/mesh.hpp"
#include "supple/motion.hpp"

namespace supple {

/// Throws `Error` naming mesh, option, value and range when an option is out of its range.
void check_options(const MassSpringOptions& options, const TriangleMesh& mesh);

}  // namespace supple
