#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/parallel.hpp"
#include "motion/force_sum.hpp"
#include "motion/implicit/sparse_factor.hpp"
#include "motion/implicit/symmetric_block.hpp"
#include "motion/network/spring_network.hpp"
#include "motion/vertex_kind.hpp"
#include "supple/motion.hpp"

namespace supple {

/// The state at the start of a step and the forces during it.
struct ImplicitStep {
  const SpringNetwork& network;
  std::span<const Vec3d> positions, velocities;
  std::span<const Vec3d> external_forces;  ///< empty when there are none
  Vec3d air_velocity;
  double seconds = 0;
};

/// The potential whose stationary points are the velocities at the end of a step of backward Euler,
///
///     m |v - v0|² / 2 + energy(x0 + h v) + dissipation,
///
/// its gradient, and its Hessian without the terms that may be negative (Baraff & Witkin 1998).
///
/// Vectors have one entry per vertex; entries of vertices that are not free are 0. Each element is evaluated
/// once; then each vertex sums the results of its elements in their order. So the bits are the same for any
/// number of threads. No allocation after construction.
///
/// The volume of a closed part adds κ g gᵀ to the Hessian, with g = ∂V/∂x and κ = h² k / |V0|. This term is
/// dense, so only the rest, the sparse part, is factorised.
class StepEquations {
 public:
  StepEquations(const SpringNetwork& network, std::span<const VertexKind> kinds,
                const MassSpringOptions& options);

  std::uint32_t free_count() const { return free_count_; }
  double smallest_diagonal() const { return diagonal_of_mass_; }

  /// Damping directions are those at the start of the step. `step` must outlive the calls that follow.
  void begin(const ImplicitStep& step, const Parallel& parallel);
  /// Evaluates all elements at `velocities` and returns the potential.
  double visit(std::span<const Vec3d> velocities, const Parallel& parallel);
  /// The negative gradient, and the diagonal blocks of the sparse part, at the point of the last `visit`.
  void gather(std::span<const Vec3d> velocities, std::span<Vec3d> descent, std::span<SymmetricBlock> diagonal,
              const Parallel& parallel);
  /// The Hessian at the point of the last `visit`, times x. Returns xᵀ times the product.
  double multiply(std::span<const Vec3d> x, std::span<Vec3d> product, const Parallel& parallel);

  /// Has the pattern of the sparse part. Rows are free vertices in the order of the mesh.
  SparseFactor make_factor() const;
  void fill(std::span<const SymmetricBlock> diagonal, SparseFactor& factor) const;
  bool has_volumes() const { return !part_of_.empty(); }
  /// For each vertex, g of its part at the point of the last `gather`.
  std::span<const Vec3d> volume_gradient() const { return volume_gradient_; }
  /// Turns a solution of the sparse system into a solution of the full system by the Sherman-Morrison
  /// formula. `response` is the solution of the sparse system for `volume_gradient`. Only this term couples
  /// closed parts, so one response serves all of them.
  void keep_volumes(std::span<const Vec3d> response, std::span<Vec3d> solution);

 private:
  struct AreaState {
    std::array<Vec3d, 3> of_corner;
    double push = 0, weight = 0;
  };
  /// A spring at a vertex and the vertex at its other end.
  struct End {
    std::uint32_t spring = 0, other = 0;
  };
  struct Corner {
    std::uint32_t area = 0, corner = 0;
  };

  void connect(const SpringNetwork& network);
  double visit_springs(const std::vector<SpringElement>& springs, std::size_t first_state, double stiffness,
                       std::span<const Vec3d> velocities, const Parallel& parallel);
  double visit_areas(const Parallel& parallel);
  double visit_vertices(std::span<const Vec3d> velocities, const Parallel& parallel);
  template <class Sum>
  double sum_of_chunks(std::size_t count, const Parallel& parallel, Sum sum) const;
  double visit_volumes(const Parallel& parallel);
  void find_volume_gradient();
  double volume_stiffness(std::size_t part) const;  // κ
  void sum_of_parts(std::span<const Vec3d> x, std::span<double> along) const;
  Vec3d load(std::uint32_t vertex) const;

  MassSpringOptions options_;
  std::vector<VertexKind> kinds_;
  std::uint32_t free_count_ = 0;
  const ImplicitStep* step_ = nullptr;
  double diagonal_of_mass_ = 0;
  std::vector<End> ends_;
  std::vector<std::uint32_t> first_end_;  // offset of each vertex, and the end
  std::vector<Corner> corners_;
  std::vector<std::uint32_t> first_corner_;
  std::vector<Triangle> triangles_;  // the corners of each area element
  std::vector<std::array<std::uint32_t, 2>> spring_ends_;

  std::vector<Vec3d> positions_;
  std::vector<Vec3d> directions_;       // one per spring
  std::vector<Vec3d> pulls_;            // force of each spring on its first end, divided by h
  std::vector<SymmetricBlock> blocks_;  // one per spring
  std::vector<AreaState> areas_;
  std::vector<double> along_areas_;
  VolumeSum volumes_;
  std::vector<std::uint32_t> part_of_;  // the part of each vertex; empty without volumes
  std::vector<Vec3d> volume_gradient_;
  std::vector<double> along_parts_, along_response_;
  mutable std::vector<double> chunk_sums_;
  std::vector<std::array<std::uint32_t, 2>> pairs_;  // pairs of rows that share a block
  std::vector<std::uint32_t> pair_of_spring_;
  std::vector<std::array<std::uint32_t, 3>> pairs_of_area_;
  std::vector<std::uint32_t> row_of_;
};

}  // namespace supple
