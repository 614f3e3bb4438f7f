#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/parallel.hpp"
#include "motion/network/spring_network.hpp"
#include "supple/motion.hpp"
#include "supple/types.hpp"

namespace supple {

/// Sums the volumes of closed parts run by run, in an order that does not depend on the number of threads.
class VolumeSum {
 public:
  explicit VolumeSum(const SpringNetwork& network);

  void compute(const SpringNetwork& network, std::span<const Vec3d> positions, const Parallel& parallel);

  double of_part(std::size_t part) const { return of_parts_[part]; }
  /// V - V0, in cubic metres
  double growth(const SpringNetwork& network, std::size_t part) const {
    return of_parts_[part] - network.parts[part].rest_volume;
  }

 private:
  std::vector<double> of_runs_, of_parts_;
};

/// Sums the forces of all elements at each vertex, in an order that does not depend on the number of threads.
class ForceSum {
 public:
  explicit ForceSum(const SpringNetwork& network);

  void compute(const SpringNetwork& network, const MassSpringOptions& options,
               std::span<const Vec3d> positions, std::span<const Vec3d> velocities, const Parallel& parallel);

  /// The last computed sum at a vertex, in newtons.
  Vec3d on_vertex(const SpringNetwork& network, std::uint32_t vertex) const {
    Vec3d sum = in_block_[vertex];
    for (std::uint32_t s = network.first_slot[vertex]; s < network.first_slot[vertex + 1]; ++s) {
      sum = sum + crossing_[s];
    }
    return sum;
  }

 private:
  std::vector<Vec3d> in_block_;  // for each vertex, the sum over elements inside its block
  std::vector<Vec3d> crossing_;  // one force per slot
  VolumeSum volumes_;
  std::vector<double> pressures_;  // one per closed part
};

}  // namespace supple
