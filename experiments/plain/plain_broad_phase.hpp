#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "supple/types.hpp"

namespace supple::experiments {

/// A broad phase as a program of 2007 had it: scalar code for SSE2, compiled by -O2 without vectors. Its
/// files have these options in CMakeLists.txt.
class PlainBroadPhase {
 public:
  virtual ~PlainBroadPhase() = default;
  /// The number of pairs of boxes that overlap. Each call has as many boxes as the first.
  virtual std::size_t step(const std::vector<Aabb>& boxes) = 0;
  std::uint64_t tests() const { return tests_; }  ///< of boxes, or exchanges, in the last step

 protected:
  std::uint64_t tests_ = 0;
};

std::unique_ptr<PlainBroadPhase> plain_brute_force();
/// Sorts along the x axis in each step.
std::unique_ptr<PlainBroadPhase> plain_sweep();
/// Keeps sorted lists on three axes from step to step, and pairs until their ends change places ([Bar92]).
std::unique_ptr<PlainBroadPhase> plain_three_lists();
/// The octree of Figure 2 over a cube: levels 0 and 1 always exist, and a region with two boxes or more
/// expands down to `level_allowed`. A pair counts in the first region that both boxes are in.
std::unique_ptr<PlainBroadPhase> plain_octree(const Vec3d& corner, double edge, std::uint32_t level_allowed);

/// Boxes and the spheres that enclose them, in arrays of numbers.
struct VolumeArrays {
  std::array<std::vector<float>, 3> low, high, center;
  std::vector<float> radius;
};
/// The number of volumes that overlap volume i, tested one by one; of boxes, the first comparison that fails
/// ends a test, or all are made.
std::uint32_t plain_overlapping_boxes(const VolumeArrays& volumes, std::size_t i);
std::uint32_t plain_overlapping_boxes_without_branches(const VolumeArrays& volumes, std::size_t i);
std::uint32_t plain_overlapping_spheres(const VolumeArrays& volumes, std::size_t i);

}  // namespace supple::experiments
