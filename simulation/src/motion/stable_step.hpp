#pragma once

#include <span>

#include "motion/spring_network.hpp"
#include "motion/vertex_kind.hpp"
#include "supple/motion.hpp"

namespace supple {

/// The longest step, in seconds, of the integrator of the options about the rest state.
///
/// Blocks of three rows of K / m and C / m, stiffness and damping, bound their spectra by ω² and c after
/// Gershgorin. A mode of frequency ω and damping c is carried on without growth by Verlet while
/// h² ω² / 4 + h c ≤ 1, by symplectic Euler while h² ω² / 4 + h c / 2 ≤ 1.
double stable_explicit_step(const SpringNetwork& network, std::span<const VertexKind> kinds,
                            const MassSpringOptions& options, std::span<const Vec3d> rest);

}  // namespace supple
