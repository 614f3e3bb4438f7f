#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/parallel.hpp"
#include "motion/implicit/sparse_factor.hpp"
#include "motion/implicit/step_equations.hpp"
#include "motion/implicit/symmetric_block.hpp"
#include "motion/network/spring_network.hpp"
#include "motion/vertex_kind.hpp"
#include "supple/motion.hpp"

namespace supple {

/// Computes the velocities at the end of a step of backward Euler, m (v1 - v0) = h f(x0 + h v1, v1), by
/// Newton's method. Each iteration must lower the potential of `StepEquations`, so energy stays bounded for
/// any stiffness and step.
///
/// Conjugate gradients with a block diagonal preconditioner solve the linear systems, only as accurately as
/// Newton's method needs. When they take longer than a factorisation would, sparse Cholesky factors solve the
/// systems instead. The result of a step depends only on its arguments, not on earlier steps.
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
  std::optional<SparseFactor> factor_;  // created on first use
  double factor_worth_ = 0;    // number of conjugate gradient iterations that take as long as a factorisation
  bool needs_factor_ = false;  // the rest of this step uses the factorisation
  int iterations_ = 0;         // conjugate gradient iterations in this step
  std::vector<Vec3d> descent_, change_, tried_;
  std::vector<SymmetricBlock> diagonal_, inverse_diagonal_;
  std::vector<Vec3d> residual_, conditioned_, direction_, product_;
  std::vector<Vec3d> of_rows_;  // one entry per free vertex
  std::vector<double> chunk_sums_;
};

}  // namespace supple
