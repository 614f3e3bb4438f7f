#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/parallel.hpp"
#include "motion/sparse_factor.hpp"
#include "motion/spring_network.hpp"
#include "motion/step_equations.hpp"
#include "motion/symmetric_block.hpp"
#include "motion/vertex_kind.hpp"
#include "supple/motion.hpp"

namespace supple {

/// Velocities at the end of a step of backward Euler, m (v1 - v0) = h f(x0 + h v1, v1): Newton's method, each
/// of whose iterations must lower the potential of `StepEquations`, so that energy stays bounded at any
/// stiffness and step.
///
/// Its linear systems are solved by conjugate gradients, no further than Newton's method has use for. They
/// are preconditioned by the blocks on the diagonal; where that takes longer than a factorisation would, the
/// systems are solved by Cholesky's factors. What a step gives depends on what it
/// is given alone, on no step before.
class BackwardEuler {
 public:
  static constexpr int max_newton_iterations = 6;

  BackwardEuler(const SpringNetwork& network, std::span<const VertexKind> kinds,
                const MassSpringOptions& options);

  void solve(const ImplicitStep& step, std::span<Vec3d> velocities_after, const Parallel& parallel);

 private:
  double choose_start(const ImplicitStep& step, std::span<Vec3d> velocities, const Parallel& parallel);
  void give_up(const ImplicitStep& step, std::span<Vec3d> velocities) const;
  void solve_linear(const Parallel& parallel);
  double expected_iterations() const;
  bool conjugate_gradients(const Parallel& parallel);
  double precondition(const Parallel& parallel);
  void solve_by_factor();
  void solve_factored(std::span<const Vec3d> right, std::span<Vec3d> solution);
  bool go_down(std::span<Vec3d> velocities, double& lowest, const Parallel& parallel);
  double product_of(std::span<const Vec3d> p, std::span<const Vec3d> q, const Parallel& parallel);
  Vec3d mean_of_free(std::span<const Vec3d> values) const;
  void keep_momentum(const ImplicitStep& step, std::span<Vec3d> velocities) const;

  MassSpringOptions options_;
  std::vector<VertexKind> kinds_;
  StepEquations equations_;
  std::optional<SparseFactor> factor_;  // once it was needed
  double factor_worth_ = 0;             // iterations of conjugate gradients that take as long
  bool needs_factor_ = false;           // from here on in this step
  int iterations_ = 0;                  // of conjugate gradients, in this step
  std::vector<Vec3d> descent_, change_, tried_;
  std::vector<SymmetricBlock> diagonal_, inverse_diagonal_;
  std::vector<Vec3d> residual_, conditioned_, direction_, product_;
  std::vector<Vec3d> of_rows_;  // of free vertices alone
  std::vector<double> chunk_sums_;
};

}  // namespace supple
