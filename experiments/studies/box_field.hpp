#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "supple/broad_phase.hpp"
#include "supple/types.hpp"

namespace supple::experiments {

/// Moving boxes with a density that does not depend on their number: one box per eight units of volume, with
/// sides of 0.5 to 1, so that each overlaps 0.4 others on average. They move straight by up to 0.05 per step
/// along each axis, and the sides of their cube reflect them. The boxes are the same on every machine.
class BoxField {
 public:
  /// One of each `stride` boxes moves.
  BoxField(std::size_t count, std::uint64_t seed, std::size_t stride = 1);

  const std::vector<Aabb>& boxes() const { return boxes_; }
  void move();
  RootCube cube() const { return {{0, 0, 0}, side_}; }  ///< of the field

 private:
  float side_;
  std::size_t stride_;
  std::vector<Aabb> boxes_;
  std::vector<Vec3f> velocities_;
};

/// The broad phase of 2007 with one thread. The root is the cube of the field, and level-allowed that of the
/// preset; `grows`: it is that of regions about as large as the boxes.
BroadPhaseOptions broad_phase_of_2007(const BoxField& field, bool grows = false);

}  // namespace supple::experiments
