#include "motion/backward_euler.hpp"

// The same operations in the same order on every machine.
#define EIGEN_DONT_VECTORIZE
#define EIGEN_DONT_PARALLELIZE
#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "motion/element_forces.hpp"
#include "motion/force_sum.hpp"

namespace supple {
namespace {

using Matrix = Eigen::SparseMatrix<double, Eigen::ColMajor, int>;
using Vector = Eigen::VectorXd;

/// Newton's method ends at a change this much smaller than its first.
constexpr double tolerance = 1e-3;

constexpr std::uint32_t no_row = ~std::uint32_t{0};
constexpr std::uint32_t no_part = ~std::uint32_t{0};

/// Rows and columns of one vertex against another's.
using Block = std::array<std::array<double, 3>, 3>;

/// p qᵀ · factor
Block product(Vec3d p, Vec3d q, double factor) {
  Block block;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) block[i][j] = factor * p[i] * q[j];
  }
  return block;
}

void add_diagonal(Block& block, double value) {
  for (int i = 0; i < 3; ++i) block[i][i] += value;
}

}  // namespace

/// Rows are the coordinates of free vertices, three each, in the order of the mesh. Only the lower half is
/// stored.
class BackwardEuler::System {
 public:
  System(const SpringNetwork& network, std::span<const VertexKind> kinds, const MassSpringOptions& options);
  void solve(const ImplicitStep& step, std::span<Vec3d> velocities);

 private:
  void lay_out(const SpringNetwork& network);
  void find_directions(const ImplicitStep& step);
  void give_up(const ImplicitStep& step, std::span<Vec3d> velocities) const;
  void solve_linear();
  Vector solve_sparse(const Vector& right);
  void add_volumes(const ImplicitStep& step);
  void keep_volumes(const ImplicitStep& step);
  bool go_down(const ImplicitStep& step, std::span<Vec3d> velocities, double& lowest);
  double potential(const ImplicitStep& step, std::span<const Vec3d> velocities);
  void linearise(const ImplicitStep& step, std::span<const Vec3d> velocities);
  void add_springs(const ImplicitStep& step, const std::vector<SpringElement>& springs,
                   std::span<const Vec3d> directions, double stiffness);
  void add_area(const ImplicitStep& step, const AreaElement& element);
  void add_block(std::uint32_t p, std::uint32_t q, const Block& block);
  void add_gradient(std::uint32_t vertex, Vec3d value);
  Vec3d change_of(std::uint32_t vertex) const;
  Vec3d mean_of_free(std::span<const Vec3d> values) const;
  void keep_momentum(const ImplicitStep& step, std::span<Vec3d> velocities) const;

  MassSpringOptions options_;
  std::vector<VertexKind> kinds_;
  std::vector<std::uint32_t> row_of_;       // of each vertex; no_row where it is not free
  std::vector<std::uint32_t> first_below_;  // of each row vertex, in below_; one more at the end
  std::vector<std::uint32_t> below_;        // row vertices of blocks below the diagonal, column by column
  Matrix matrix_;
  Vector gradient_, change_;
  Eigen::ConjugateGradient<Matrix, Eigen::Lower> conjugate_gradient_;
  Eigen::SimplicialLDLT<Matrix, Eigen::Lower> cholesky_;
  bool is_analyzed_ = false, is_factorized_ = false;
  VolumeSum volumes_;
  std::vector<std::uint32_t> part_of_rows_;                  // of each row vertex; empty without volumes
  Vector volume_gradient_;                                   // ∂V/∂x of the part that a vertex belongs to
  std::vector<double> along_change_, along_response_;        // of each part; scratch
  std::vector<Vec3d> edge_directions_, bending_directions_;  // at the start of the step
  std::vector<Vec3d> positions_, tried_;
};

BackwardEuler::System::System(const SpringNetwork& network, std::span<const VertexKind> kinds,
                              const MassSpringOptions& options)
    : options_(options),
      kinds_(kinds.begin(), kinds.end()),
      row_of_(kinds.size(), no_row),
      volumes_(network) {
  std::uint32_t rows = 0;
  for (std::uint32_t v = 0; v < kinds.size(); ++v) {
    if (kinds[v] == VertexKind::free) row_of_[v] = rows++;
  }
  first_below_.assign(std::size_t{rows} + 1, 0);
  lay_out(network);
  gradient_.resize(3 * static_cast<Eigen::Index>(rows));
  edge_directions_.resize(network.edges.elements.size());
  bending_directions_.resize(network.bending.elements.size());
  if (!network.parts.empty()) {
    part_of_rows_.assign(rows, no_part);
    for (const VolumeElement& element : network.volumes.elements) {
      for (const std::uint32_t v : element.corners) {
        if (row_of_[v] != no_row) part_of_rows_[row_of_[v]] = element.part;
      }
    }
    volume_gradient_.resize(gradient_.size());
    along_change_.resize(network.parts.size());
    along_response_.resize(network.parts.size());
  }
  positions_.resize(kinds.size());
  tried_.resize(kinds.size());
}

void BackwardEuler::System::lay_out(const SpringNetwork& network) {
  std::vector<std::array<std::uint32_t, 2>> blocks;  // column, row
  for (const auto* springs : {&network.edges.elements, &network.bending.elements}) {
    for (const SpringElement& spring : *springs) {
      const std::uint32_t a = row_of_[spring.a], b = row_of_[spring.b];
      if (a != no_row && b != no_row) blocks.push_back({std::min(a, b), std::max(a, b)});
    }
  }
  std::sort(blocks.begin(), blocks.end());
  for (const auto& [column, row] : blocks) {
    ++first_below_[column + 1];
    below_.push_back(row);
  }
  const std::size_t rows = first_below_.size() - 1;
  for (std::size_t r = 0; r < rows; ++r) first_below_[r + 1] += first_below_[r];

  const auto size = static_cast<Eigen::Index>(3 * rows);
  matrix_.resize(size, size);
  matrix_.resizeNonZeros(static_cast<Eigen::Index>(6 * rows + 9 * below_.size()));
  int place = 0;
  for (std::size_t column = 0; column < rows; ++column) {
    for (int c = 0; c < 3; ++c) {
      matrix_.outerIndexPtr()[3 * column + c] = place;
      for (int r = c; r < 3; ++r) matrix_.innerIndexPtr()[place++] = static_cast<int>(3 * column) + r;
      for (std::uint32_t i = first_below_[column]; i < first_below_[column + 1]; ++i) {
        for (int r = 0; r < 3; ++r) matrix_.innerIndexPtr()[place++] = static_cast<int>(3 * below_[i]) + r;
      }
    }
  }
  matrix_.outerIndexPtr()[size] = place;
}

void BackwardEuler::System::solve(const ImplicitStep& step, std::span<Vec3d> velocities) {
  find_directions(step);
  // Newton's method starts from what would fly on or from what would keep its shape, whichever is lower.
  std::copy(step.velocities.begin(), step.velocities.end(), velocities.begin());
  double lowest = potential(step, velocities);
  const Vec3d mean = mean_of_free(step.velocities);
  for (std::size_t v = 0; v < kinds_.size(); ++v) {
    tried_[v] = kinds_[v] == VertexKind::free ? mean : step.velocities[v];
  }
  if (const double rigid = potential(step, tried_); rigid < lowest) {
    lowest = rigid;
    std::copy(tried_.begin(), tried_.end(), velocities.begin());
  }
  if (gradient_.size() == 0) return;
  if (!std::isfinite(lowest)) return give_up(step, velocities);

  double first_change = 0;
  for (int iteration = 0; iteration < max_newton_iterations; ++iteration) {
    linearise(step, velocities);
    // The matrix is at least the masses, so that this bounds the change.
    if (gradient_.norm() <= tolerance * options_.vertex_mass * first_change) break;
    solve_linear();
    keep_volumes(step);
    if (!go_down(step, velocities, lowest)) break;
    const double change = change_.cwiseAbs().maxCoeff();
    if (iteration == 0) first_change = change;
    if (!(change > tolerance * first_change)) break;
  }
  keep_momentum(step, velocities);
}

/// Forces or stretch that are not finite show in the velocities, so that the step is refused.
void BackwardEuler::System::give_up(const ImplicitStep& step, std::span<Vec3d> velocities) const {
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

/// Conjugate gradients take about ten times the root of the condition number, each a product with the matrix;
/// Cholesky's factors take as long as three roots of the number of vertices of these, measured on sheets.
Vector BackwardEuler::System::solve_sparse(const Vector& right) {
  double largest = 0;
  for (Eigen::Index row = 0; row < matrix_.cols(); ++row) {
    largest = std::max(largest, matrix_.valuePtr()[matrix_.outerIndexPtr()[row]]);
  }
  const auto vertices = static_cast<double>(first_below_.size() - 1);
  if (!is_factorized_ && 100 * largest <= 9 * vertices * options_.vertex_mass) {
    conjugate_gradient_.setTolerance(1e-8);
    conjugate_gradient_.compute(matrix_);
    Vector solution = conjugate_gradient_.solve(right);
    if (conjugate_gradient_.info() == Eigen::Success) return solution;
  }
  if (!is_analyzed_) cholesky_.analyzePattern(matrix_);
  if (!is_factorized_) cholesky_.factorize(matrix_);
  is_analyzed_ = is_factorized_ = true;
  return cholesky_.solve(right);
}

void BackwardEuler::System::solve_linear() {
  is_factorized_ = false;
  change_ = solve_sparse(gradient_);
}

/// A closed part's volume adds κ g gᵀ to the matrix, g being ∂V/∂x and κ = h² k / |V0|, which is positive
/// semidefinite and dense. The inverse of the sum follows from that of the sparse matrix by the formula of
/// Sherman and Morrison. Nothing else joins two parts, so one solution serves all of them.
void BackwardEuler::System::keep_volumes(const ImplicitStep& step) {
  if (part_of_rows_.empty()) return;
  const Vector response = solve_sparse(volume_gradient_);
  std::fill(along_change_.begin(), along_change_.end(), 0.0);
  std::fill(along_response_.begin(), along_response_.end(), 0.0);
  for (std::size_t row = 0; row < part_of_rows_.size(); ++row) {
    if (part_of_rows_[row] == no_part) continue;
    const auto gradient = volume_gradient_.segment<3>(static_cast<Eigen::Index>(3 * row));
    along_change_[part_of_rows_[row]] += gradient.dot(change_.segment<3>(static_cast<Eigen::Index>(3 * row)));
    along_response_[part_of_rows_[row]] +=
        gradient.dot(response.segment<3>(static_cast<Eigen::Index>(3 * row)));
  }
  for (std::size_t row = 0; row < part_of_rows_.size(); ++row) {
    const std::uint32_t part = part_of_rows_[row];
    if (part == no_part) continue;
    const double stiffness =
        step.seconds * step.seconds * options_.volume_stiffness * step.network.parts[part].inverse_scale;
    const double factor = stiffness * along_change_[part] / (1 + stiffness * along_response_[part]);
    const auto at = static_cast<Eigen::Index>(3 * row);
    change_.segment<3>(at) -= factor * response.segment<3>(at);
  }
}

void BackwardEuler::System::add_volumes(const ImplicitStep& step) {
  if (part_of_rows_.empty()) return;
  volumes_.compute(step.network, positions_, Parallel(1));
  volume_gradient_.setZero();
  for (const VolumeElement& element : step.network.volumes.elements) {
    const Triangle& t = element.corners;
    const Vec3d third = area_vector(positions_[t[0]], positions_[t[1]], positions_[t[2]]) * (1.0 / 3);
    const double pressure = -options_.volume_stiffness * volumes_.growth(step.network, element.part) *
                            step.network.parts[element.part].inverse_scale;
    for (const std::uint32_t v : t) {
      if (row_of_[v] == no_row) continue;
      add_gradient(v, third * (pressure * step.seconds));
      for (int axis = 0; axis < 3; ++axis) volume_gradient_[3 * row_of_[v] + axis] += third[axis];
    }
  }
}

/// Goes along the change as far as the potential becomes lower by a part of what its slope promises (Armijo's
/// rule).
bool BackwardEuler::System::go_down(const ImplicitStep& step, std::span<Vec3d> velocities, double& lowest) {
  const double slope = change_.dot(gradient_), rounding = 1e-13 * std::abs(lowest);
  double part = 1;
  for (int halving = 0; halving < 30; ++halving, part *= 0.5) {
    for (std::uint32_t v = 0; v < kinds_.size(); ++v) tried_[v] = velocities[v] + change_of(v) * part;
    const double value = potential(step, tried_);
    if (!(value <= lowest - 1e-4 * part * slope + rounding)) continue;
    lowest = value;
    std::copy(tried_.begin(), tried_.end(), velocities.begin());
    return true;
  }
  return false;
}

void BackwardEuler::System::find_directions(const ImplicitStep& step) {
  const auto find = [&](const std::vector<SpringElement>& springs, std::vector<Vec3d>& directions) {
    for (std::size_t i = 0; i < springs.size(); ++i) {
      const Vec3d d = step.positions[springs[i].b] - step.positions[springs[i].a];
      const double length = supple::length(d);
      directions[i] = length > 0 ? d * (1 / length) : Vec3d{};
    }
  };
  find(step.network.edges.elements, edge_directions_);
  find(step.network.bending.elements, bending_directions_);
}

double BackwardEuler::System::potential(const ImplicitStep& step, std::span<const Vec3d> velocities) {
  const double h = step.seconds;
  double sum = 0;
  for (std::uint32_t v = 0; v < kinds_.size(); ++v) {
    positions_[v] = step.positions[v] + velocities[v] * h;
    if (kinds_[v] != VertexKind::free) continue;
    const Vec3d change = velocities[v] - step.velocities[v], wind = velocities[v] - step.air_velocity;
    Vec3d load = options_.gravity * options_.vertex_mass;
    if (!step.external_forces.empty()) load = load + step.external_forces[v];
    sum += 0.5 * options_.vertex_mass * dot(change, change) +
           0.5 * h * options_.air_friction * dot(wind, wind) - h * dot(load, change);
  }
  const auto add_springs = [&](const std::vector<SpringElement>& springs, std::span<const Vec3d> directions,
                               double stiffness) {
    for (std::size_t i = 0; i < springs.size(); ++i) {
      const auto& [a, b, rest_length] = springs[i];
      const double stretch = length(positions_[b] - positions_[a]) - rest_length;
      const double rate = dot(velocities[b] - velocities[a], directions[i]);
      sum += 0.5 * stiffness * stretch * stretch + 0.5 * h * options_.damping * rate * rate;
    }
  };
  add_springs(step.network.edges.elements, edge_directions_, options_.stiffness);
  add_springs(step.network.bending.elements, bending_directions_, options_.bending_stiffness);
  for (const AreaElement& element : step.network.areas.elements) {
    const Triangle& t = element.corners;
    const double growth =
        triangle_area(positions_[t[0]], positions_[t[1]], positions_[t[2]]) - element.rest_area;
    sum += 0.5 * options_.area_stiffness * growth * growth * element.inverse_scale;
  }
  volumes_.compute(step.network, positions_, Parallel(1));
  for (std::size_t part = 0; part < step.network.parts.size(); ++part) {
    const double growth = volumes_.growth(step.network, part);
    sum += 0.5 * options_.volume_stiffness * growth * growth * step.network.parts[part].inverse_scale;
  }
  return sum;
}

/// The negative gradient of the potential, and its second derivative without what may be negative.
void BackwardEuler::System::linearise(const ImplicitStep& step, std::span<const Vec3d> velocities) {
  const double h = step.seconds;
  std::fill(matrix_.valuePtr(), matrix_.valuePtr() + matrix_.nonZeros(), 0.0);
  gradient_.setZero();
  for (std::uint32_t v = 0; v < kinds_.size(); ++v) {
    positions_[v] = step.positions[v] + velocities[v] * h;
    tried_[v] = velocities[v];
    if (kinds_[v] != VertexKind::free) continue;
    Vec3d load = options_.gravity * options_.vertex_mass;
    if (!step.external_forces.empty()) load = load + step.external_forces[v];
    add_gradient(v, load * h - (velocities[v] - step.velocities[v]) * options_.vertex_mass -
                        (velocities[v] - step.air_velocity) * (h * options_.air_friction));
    const double diagonal = options_.vertex_mass + h * options_.air_friction;
    Block block{};
    add_diagonal(block, diagonal);
    add_block(v, v, block);
  }
  add_springs(step, step.network.edges.elements, edge_directions_, options_.stiffness);
  add_springs(step, step.network.bending.elements, bending_directions_, options_.bending_stiffness);
  for (const AreaElement& element : step.network.areas.elements) add_area(step, element);
  add_volumes(step);
}

void BackwardEuler::System::add_springs(const ImplicitStep& step, const std::vector<SpringElement>& springs,
                                        std::span<const Vec3d> directions, double stiffness) {
  const double h = step.seconds;
  for (std::size_t i = 0; i < springs.size(); ++i) {
    const auto& [a, b, rest_length] = springs[i];
    const Vec3d d = positions_[b] - positions_[a];
    const double length = supple::length(d);
    const double rate = dot(tried_[b] - tried_[a], directions[i]);
    const Vec3d pull =
        spring_force(d, {}, stiffness, 0, rest_length) * h + directions[i] * (h * options_.damping * rate);
    add_gradient(a, pull);
    add_gradient(b, Vec3d{} - pull);
    // A spring that is compressed would push its ends out of line; that is what may be negative.
    const Vec3d n = length > 0 ? d * (1 / length) : Vec3d{};
    const double across = length > 0 ? std::max(0.0, 1 - rest_length / length) : 1;
    Block block = product(n, n, h * h * stiffness * (1 - across));
    add_diagonal(block, h * h * stiffness * across);
    const Block damping = product(directions[i], directions[i], h * options_.damping);
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c < 3; ++c) block[r][c] += damping[r][c];
    }
    add_block(a, a, block);
    add_block(b, b, block);
    for (auto& row : block) {
      for (double& value : row) value = -value;
    }
    add_block(b, a, block);
  }
}

void BackwardEuler::System::add_area(const ImplicitStep& step, const AreaElement& element) {
  const Triangle& t = element.corners;
  const auto forces =
      area_forces(element, options_.area_stiffness, positions_[t[0]], positions_[t[1]], positions_[t[2]]);
  const AreaGradient gradient = area_gradient(positions_[t[0]], positions_[t[1]], positions_[t[2]]);
  const double stiffness = options_.area_stiffness * element.inverse_scale * step.seconds * step.seconds;
  for (int i = 0; i < 3; ++i) {
    add_gradient(t[i], forces[i] * step.seconds);
    for (int j = 0; j <= i; ++j) {
      add_block(t[i], t[j], product(gradient.of_corner[i], gradient.of_corner[j], stiffness));
    }
  }
}

/// Adds to the rows of p and the columns of q.
void BackwardEuler::System::add_block(std::uint32_t p, std::uint32_t q, const Block& block) {
  const std::uint32_t row = std::max(row_of_[p], row_of_[q]), column = std::min(row_of_[p], row_of_[q]);
  if (row == no_row) return;
  const auto first = below_.begin() + first_below_[column], last = below_.begin() + first_below_[column + 1];
  const bool transposed = row != row_of_[p];
  const auto rank = row == column ? 0 : 1 + (std::lower_bound(first, last, row) - first);
  for (int c = 0; c < 3; ++c) {
    double* const values = matrix_.valuePtr() + matrix_.outerIndexPtr()[3 * column + c];
    if (rank == 0) {
      for (int r = c; r < 3; ++r) values[r - c] += block[r][c];
    } else {
      for (int r = 0; r < 3; ++r) values[3 * rank - c + r] += transposed ? block[c][r] : block[r][c];
    }
  }
}

void BackwardEuler::System::add_gradient(std::uint32_t vertex, Vec3d value) {
  if (row_of_[vertex] == no_row) return;
  for (int axis = 0; axis < 3; ++axis) gradient_[3 * row_of_[vertex] + axis] += value[axis];
}

Vec3d BackwardEuler::System::change_of(std::uint32_t vertex) const {
  if (row_of_[vertex] == no_row) return {};
  const double* const values = change_.data() + 3 * row_of_[vertex];
  return {values[0], values[1], values[2]};
}

Vec3d BackwardEuler::System::mean_of_free(std::span<const Vec3d> values) const {
  Vec3d sum;
  for (std::size_t v = 0; v < kinds_.size(); ++v) {
    if (kinds_[v] == VertexKind::free) sum = sum + values[v];
  }
  return sum * (1 / static_cast<double>(std::max<std::size_t>(1, first_below_.size() - 1)));
}

/// What springs pull sums to zero. So the mean velocity is known, and takes out what rounding and the
/// tolerance of Newton's method, times stiffness, have left in it.
void BackwardEuler::System::keep_momentum(const ImplicitStep& step, std::span<Vec3d> velocities) const {
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

BackwardEuler::BackwardEuler(const SpringNetwork& network, std::span<const VertexKind> kinds,
                             const MassSpringOptions& options)
    : system_(std::make_unique<System>(network, kinds, options)) {}
BackwardEuler::~BackwardEuler() = default;

void BackwardEuler::solve(const ImplicitStep& step, std::span<Vec3d> velocities_after) {
  system_->solve(step, velocities_after);
}

}  // namespace supple
