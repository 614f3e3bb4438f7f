#pragma once

#include <span>
#include <vector>

#include "inputs/inputs.hpp"
#include "supple/simulation.hpp"

namespace supple::cli {

/// Whether a body turns by more than 120 degrees about any axis from one frame to the next. The straight
/// paths of its vertices then shrink it to less than half of its width meanwhile, so that continuous
/// contacts are not those of its motion. The turn is that of the rigid motion that fits best; when the body
/// moves in another way, the answer is false. Vertices that are not finite do not count. O(n).
bool turns_too_far(std::span<const Vec3d> from, std::span<const Vec3d> to);

/// The objects of a simulation whose straight paths in a step are not their motion.
class HalfTurns {
 public:
  HalfTurns(const Simulation& simulation, const Input& input);

  /// Call before each step.
  void remember_positions();
  /// The objects that turned too far since `remember_positions`, ascending.
  std::vector<ObjectId> find() const;

 private:
  const Simulation& simulation_;
  std::vector<ObjectId> objects_;
  std::vector<bool> spins_;  // by more than 120 degrees in each step, possibly by whole turns
  std::vector<std::vector<Vec3d>> before_;
};

}  // namespace supple::cli
