#pragma once

#include <span>
#include <vector>

#include "core/random.hpp"
#include "supple/motion.hpp"
#include "supple/types.hpp"

namespace supple {

/// Random forces that bend a body at rest without moving it: smooth waves about as long as the body, so that
/// neighbours get similar forces. For each connected piece, the sum and the torque are zero up to rounding,
/// so pieces do not separate. `size` is the root mean square in newtons. Vertices that are not finite get no
/// force.
std::vector<Vec3d> deforming_forces(std::span<const Vec3d> rest,
                                    std::span<const MassSpringBody::Spring> springs, double size,
                                    Random& random);

}  // namespace supple
