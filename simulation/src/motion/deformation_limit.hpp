#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/parallel.hpp"
#include "motion/network/spring_network.hpp"

namespace supple {

/// Keeps edge lengths between (1 - max_strain) and (1 + max_strain) times the rest length (Provot 1995) by
/// moving vertices after a step.
///
/// The two ends move in inverse proportion to their masses. The displacement in a step of h seconds, divided
/// by h, is added to the velocity, so x - h v does not change. Ends move along the edge direction of x - h
/// v, so the sum of x × m v does not change either. Momentum and angular momentum are therefore conserved
/// unless vertices are fixed.
///
/// Edges of one color share no vertex and move in parallel, color after color, so the order of threads does
/// not matter. Rounds repeat until every edge is within `tolerance` times its rest length of its bounds, or
/// `max_rounds` is reached.
class DeformationLimit {
 public:
  static constexpr int max_rounds = 50;
  static constexpr double tolerance = 1e-4;

  /// `inverse_masses` has one entry per vertex; 0 means that the vertex does not move.
  DeformationLimit(const SpringNetwork& network, std::span<const double> inverse_masses, double max_strain);

  /// Returns true when a vertex moved.
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
  std::vector<std::uint32_t> by_color_;     // edges, sorted by color
  std::vector<std::uint32_t> first_color_;  // offset of each color in by_color_, and the end
};

}  // namespace supple
