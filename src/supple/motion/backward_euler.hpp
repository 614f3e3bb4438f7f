#pragma once

#include <memory>
#include <span>

#include "motion/spring_network.hpp"
#include "motion/vertex_kind.hpp"
#include "supple/motion.hpp"

namespace supple {

/// Where a step starts, and what acts during it.
struct ImplicitStep {
  const SpringNetwork& network;
  std::span<const Vec3d> positions, velocities;
  std::span<const Vec3d> external_forces;  ///< empty: none
  Vec3d air_velocity;
  double seconds = 0;
};

/// Velocities at the end of a step of backward Euler, m (v1 - v0) = h f(x0 + h v1, v1): Newton's method with
/// the Jacobians of Baraff & Witkin 1998, made positive semidefinite by leaving out what compression takes
/// away.
///
/// Each iteration must lower the potential whose stationary points are the solutions, m |v - v0|² / 2 +
/// energy
/// (+ dissipation), so that energy stays bounded at any stiffness and step. The damping of springs acts along
/// their directions at the start.
class BackwardEuler {
 public:
  static constexpr int max_newton_iterations = 6;

  BackwardEuler(const SpringNetwork& network, std::span<const VertexKind> kinds,
                const MassSpringOptions& options);
  ~BackwardEuler();

  void solve(const ImplicitStep& step, std::span<Vec3d> velocities_after);

 private:
  class System;
  std::unique_ptr<System> system_;
};

}  // namespace supple
