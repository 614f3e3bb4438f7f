#pragma once

#include <span>
#include <vector>

#include "core/random.hpp"
#include "supple/motion.hpp"
#include "supple/types.hpp"

namespace supple {

/// Random forces on the vertices of a body at rest that bend it and leave it where it is: waves about as long
/// as the body, so that neighbours are pulled alike. Neither their sum nor their torque is more than
/// rounding, of the body and of each piece of it that no spring joins to the others: pieces stay together.
/// `size` is their root mean square, in newtons. Vertices that are not finite are pulled at by none.
std::vector<Vec3d> deforming_forces(std::span<const Vec3d> rest,
                                    std::span<const MassSpringBody::Spring> springs, double size,
                                    Random& random);

}  // namespace supple
