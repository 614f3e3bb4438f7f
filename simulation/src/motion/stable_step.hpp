#pragma once

#include <span>

#include "motion/network/spring_network.hpp"
#include "motion/vertex_kind.hpp"
#include "supple/motion.hpp"

namespace supple {

/// The longest stable step, in seconds, of the chosen integrator near the rest state.
///
/// Gershgorin's theorem on the block rows of K / m and C / m (stiffness and damping) bounds their spectra by
/// ω² and c. Verlet does not amplify a mode of frequency ω and damping c while h² ω² / 4 + h c ≤ 1;
/// symplectic Euler while h² ω² / 4 + h c / 2 ≤ 1.
double stable_explicit_step(const SpringNetwork& network, std::span<const VertexKind> kinds,
                            const MassSpringOptions& options, std::span<const Vec3d> rest);

}  // namespace supple
