#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/parallel.hpp"
#include "motion/spring_network.hpp"

namespace supple {

/// Keeps the lengths of edges between (1 - max_strain) and (1 + max_strain) of that at rest, after Provot
/// 1995, by moving their ends after a step.
///
/// An end moves against its mass. What it moves in a step of h seconds is added to its velocity over h, so
/// that x - h v stays what it was; ends move along the direction that x - h v have, in which case the sum of
/// x × m v stays as well. So momentum and angular momentum are those of before, unless vertices are fixed.
///
/// Edges of one color share no vertex: those move at once, color after color, so that the order of threads
/// does not matter. Rounds go on until no edge is further out than `tolerance` of its rest length, or
/// `max_rounds`.
class DeformationLimit {
 public:
  static constexpr int max_rounds = 50;
  static constexpr double tolerance = 1e-4;

  /// `inverse_masses` of each vertex; 0 where it does not move.
  DeformationLimit(const SpringNetwork& network, std::span<const double> inverse_masses, double max_strain);

  /// True when anything moved.
  bool apply(std::span<const SpringElement> edges, double seconds, std::span<Vec3d> positions,
             std::span<Vec3d> velocities, const Parallel& parallel) const;

 private:
  bool can_move(const SpringElement& edge) const {
    return inverse_masses_[edge.a] + inverse_masses_[edge.b] > 0;
  }

  bool correct(const SpringElement& edge, double seconds, std::span<Vec3d> positions,
               std::span<Vec3d> velocities) const;

  std::vector<double> inverse_masses_;
  double max_strain_;
  std::vector<std::uint32_t> by_color_;     // edges
  std::vector<std::uint32_t> first_color_;  // in by_color_; one more at the end
};

}  // namespace supple
