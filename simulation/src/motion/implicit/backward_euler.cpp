#include "motion/implicit/backward_euler.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/vector.hpp"
#include "motion/implicit/vector_sums.hpp"

namespace supple {
namespace {

/// Newton's method stops when the change falls to this fraction of the first change.
constexpr double tolerance = 1e-3;

/// Conjugate gradients stop when the residual falls to this fraction of the first residual. The remaining
/// error is smaller than that of Newton's method, whose Hessian omits terms that may be negative.
constexpr double forcing = 0.02;
/// ln(2 / forcing). The logarithm of the C library differs between machines.
constexpr double log_of_accuracy = 4.605170185988092;

}  // namespace

BackwardEuler::BackwardEuler(const SpringNetwork& network, std::span<const VertexKind> kinds,
                             const MassSpringOptions& options)
    : options_(options), kinds_(kinds.begin(), kinds.end()), equations_(network, kinds, options) {
  for (auto* vector : {&descent_, &change_, &tried_, &residual_, &conditioned_, &direction_, &product_})
    vector->resize(kinds.size());
  diagonal_.resize(kinds.size());
  inverse_diagonal_.resize(kinds.size());
  of_rows_.resize(equations_.free_count());
  // Measured on sheets. On other meshes a factorisation may take longer, but it always terminates.
  factor_worth_ = 30 + 6 * std::sqrt(static_cast<double>(equations_.free_count()));
  chunk_sums_.resize(chunk_count(kinds.size()));
}

void BackwardEuler::solve(const ImplicitStep& step, std::span<Vec3d> velocities, const Parallel& parallel) {
  equations_.begin(step, parallel);
  needs_factor_ = false;
  iterations_ = 0;
  double lowest = choose_start(step, velocities, parallel);
  if (equations_.free_count() == 0) return;
  if (!std::isfinite(lowest)) return give_up(step, velocities);

  double first_change = 0;
  for (int iteration = 0; iteration < max_newton_iterations; ++iteration) {
    equations_.gather(velocities, descent_, diagonal_, parallel);
    // The matrix is at least the mass matrix, so this norm bounds the change.
    const double norm = std::sqrt(product_of(descent_, descent_, parallel));
    if (norm <= tolerance * options_.vertex_mass * first_change) break;
    solve_linear(parallel);
    if (!go_down(velocities, lowest, parallel)) break;
    double change = 0;
    for (const Vec3d& v : change_) change = std::max(change, largest_magnitude(v));
    if (iteration == 0) first_change = change;
    if (!(change > tolerance * first_change)) break;
  }
  keep_momentum(step, velocities);
}

/// Newton's method starts from constant velocity or from rigid motion, whichever has the lower potential.
double BackwardEuler::choose_start(const ImplicitStep& step, std::span<Vec3d> velocities,
                                   const Parallel& parallel) {
  const Vec3d mean = mean_of_free(step.velocities);
  for (std::size_t v = 0; v < kinds_.size(); ++v) {
    velocities[v] = kinds_[v] == VertexKind::free ? mean : step.velocities[v];
  }
  const double rigid = equations_.visit(velocities, parallel);
  const double flying_on = equations_.visit(step.velocities, parallel);
  if (rigid < flying_on) return equations_.visit(velocities, parallel);
  std::copy(step.velocities.begin(), step.velocities.end(), velocities.begin());
  return flying_on;
}

/// Sets velocities to NaN, so that the caller rejects the step: at free vertices whose external force is not
/// finite, or at all free vertices when there are none.
void BackwardEuler::give_up(const ImplicitStep& step, std::span<Vec3d> velocities) const {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  bool any = false;
  for (std::uint32_t v = 0; v < kinds_.size(); ++v) {
    if (kinds_[v] != VertexKind::free || step.external_forces.empty() || is_finite(step.external_forces[v]))
      continue;
    velocities[v] = {nan, nan, nan};
    any = true;
  }
  for (std::uint32_t v = 0; v < kinds_.size() && !any; ++v) {
    if (kinds_[v] == VertexKind::free) velocities[v] = {nan, nan, nan};
  }
}

void BackwardEuler::solve_linear(const Parallel& parallel) {
  const double smallest = equations_.smallest_diagonal();
  for_chunks(kinds_.size(), parallel, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      change_[v] = {};
      residual_[v] = descent_[v];
      if (kinds_[v] == VertexKind::free) inverse_diagonal_[v] = diagonal_[v].inverse(smallest);
    }
  });
  if (!needs_factor_) needs_factor_ = expected_iterations() > 8 * factor_worth_;
  if (!needs_factor_) {
    needs_factor_ = !conjugate_gradients(parallel);
    if (!needs_factor_) return;
  }
  solve_by_factor();
}

/// Conjugate gradient iterations, estimated from a bound on the eigenvalues of the matrix after the diagonal
/// blocks are scaled to identities.
double BackwardEuler::expected_iterations() const {
  double largest = 0;
  for (std::size_t v = 0; v < kinds_.size(); ++v) {
    if (kinds_[v] == VertexKind::free)
      largest = std::max({largest, diagonal_[v].xx, diagonal_[v].yy, diagonal_[v].zz});
  }
  return 0.5 * log_of_accuracy * std::sqrt(largest / equations_.smallest_diagonal());
}

/// Solves from scratch, because a direct solver cannot use the partial result of conjugate gradients.
void BackwardEuler::solve_by_factor() {
  if (!factor_) factor_.emplace(equations_.make_factor());
  equations_.fill(diagonal_, *factor_);
  factor_->factorise();
  solve_factored(descent_, change_);
  if (!equations_.has_volumes()) return;
  solve_factored(equations_.volume_gradient(), product_);
  equations_.keep_volumes(product_, change_);
}

void BackwardEuler::solve_factored(std::span<const Vec3d> right, std::span<Vec3d> solution) {
  std::size_t row = 0;
  for (std::size_t v = 0; v < kinds_.size(); ++v) {
    if (kinds_[v] == VertexKind::free) of_rows_[row++] = right[v];
  }
  factor_->solve(of_rows_, of_rows_);
  row = 0;
  for (std::size_t v = 0; v < kinds_.size(); ++v) {
    solution[v] = kinds_[v] == VertexKind::free ? of_rows_[row++] : Vec3d{};
  }
}

/// Returns false when all solves of this step together take longer than a factorisation.
bool BackwardEuler::conjugate_gradients(const Parallel& parallel) {
  double square = precondition(parallel);
  const double enough = forcing * forcing * square;
  std::copy(conditioned_.begin(), conditioned_.end(), direction_.begin());
  while (square > enough) {
    if (++iterations_ > factor_worth_) return false;
    const double curvature = equations_.multiply(direction_, product_, parallel);
    if (!(curvature > 0)) break;
    const double length = square / curvature;
    for_chunks(kinds_.size(), parallel, [&](std::size_t begin, std::size_t end) {
      for (std::size_t v = begin; v < end; ++v) {
        change_[v] = change_[v] + direction_[v] * length;
        residual_[v] = residual_[v] - product_[v] * length;
      }
    });
    const double before = square;
    square = precondition(parallel);
    const double part = square / before;
    for_chunks(kinds_.size(), parallel, [&](std::size_t begin, std::size_t end) {
      for (std::size_t v = begin; v < end; ++v) direction_[v] = conditioned_[v] + direction_[v] * part;
    });
  }
  return true;
}

double BackwardEuler::precondition(const Parallel& parallel) {
  return sum_of_chunks(kinds_.size(), parallel, chunk_sums_, [&](std::size_t begin, std::size_t end) {
    double sum = 0;
    for (std::size_t v = begin; v < end; ++v) {
      conditioned_[v] = inverse_diagonal_[v] * residual_[v];
      sum += dot(conditioned_[v], residual_[v]);
    }
    return sum;
  });
}

double BackwardEuler::product_of(std::span<const Vec3d> p, std::span<const Vec3d> q,
                                 const Parallel& parallel) {
  return sum_of_chunks(kinds_.size(), parallel, chunk_sums_, [&](std::size_t begin, std::size_t end) {
    double sum = 0;
    for (std::size_t v = begin; v < end; ++v) sum += dot(p[v], q[v]);
    return sum;
  });
}

/// Line search along the change until the potential decreases by a fraction of what the slope predicts
/// (Armijo's rule).
bool BackwardEuler::go_down(std::span<Vec3d> velocities, double& lowest, const Parallel& parallel) {
  const double slope = product_of(change_, descent_, parallel), rounding = 1e-13 * std::abs(lowest);
  double part = 1;
  for (int halving = 0; halving < 30; ++halving, part *= 0.5) {
    for (std::uint32_t v = 0; v < kinds_.size(); ++v) tried_[v] = velocities[v] + change_[v] * part;
    const double value = equations_.visit(tried_, parallel);
    if (!(value <= lowest - 1e-4 * part * slope + rounding)) continue;
    lowest = value;
    std::copy(tried_.begin(), tried_.end(), velocities.begin());
    return true;
  }
  return false;
}

Vec3d BackwardEuler::mean_of_free(std::span<const Vec3d> values) const {
  Vec3d sum;
  for (std::size_t v = 0; v < kinds_.size(); ++v) {
    if (kinds_[v] == VertexKind::free) sum = sum + values[v];
  }
  return sum * (1.0 / std::max(1u, equations_.free_count()));
}

/// Sets the mean velocity to its exact value, which is known because spring forces sum to zero. This removes
/// the errors of rounding and of Newton's tolerance, which stiffness amplifies.
void BackwardEuler::keep_momentum(const ImplicitStep& step, std::span<Vec3d> velocities) const {
  for (const VertexKind kind : kinds_) {
    if (kind == VertexKind::fixed) return;
  }
  const double h = step.seconds, mass = options_.vertex_mass, friction = options_.air_friction;
  Vec3d load = options_.gravity * mass;
  if (!step.external_forces.empty()) load = load + mean_of_free(step.external_forces);
  const Vec3d wanted = (mean_of_free(step.velocities) * mass + (load + step.air_velocity * friction) * h) *
                       (1 / (mass + h * friction));
  const Vec3d error = wanted - mean_of_free(velocities);
  for (std::size_t v = 0; v < kinds_.size(); ++v) {
    if (kinds_[v] == VertexKind::free) velocities[v] = velocities[v] + error;
  }
}

}  // namespace supple
