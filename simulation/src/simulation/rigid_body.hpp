#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "simulation/random.hpp"
#include "supple/scene.hpp"
#include "supple/simulation.hpp"

namespace supple {

/// A rigid object with its motion. Without spin a step takes O(1): neither this class nor the scene reads the
/// vertices, until somebody asks for the positions.
class RigidBody {
 public:
  RigidBody(std::span<const Vec3d> start, const RigidMotion& motion, double time_step, Random random);

  void step();
  /// Moves the object of the scene by the last step.
  void place(Scene& scene, ObjectId id) const;
  /// Places the object of another scene, which has seen none of the steps.
  void place_again(Scene& scene, ObjectId id) const;
  /// Call after a step.
  void reflect_at(const Border& border);
  /// Starts at other positions, with the present velocity and spin.
  void set_positions(std::span<const Vec3d> positions);
  /// Has the same bits as the positions in the scene. O(n) in the first call after a step.
  std::span<const Vec3d> positions() const;

 private:
  bool spins() const { return turns_per_second_ != 0; }

  double time_step_;
  Vec3d velocity_;
  Vec3d axis_;  // unit vector
  double turns_per_second_ = 0;

  std::vector<Vec3d> start_;
  Vec3d center_, low_, high_;  // of the finite vertices at the start
  std::uint64_t steps_ = 0;    // since the start
  Vec3d way_;                  // sum of all steps
  RigidTransform transform_;   // of the start, after all steps
  mutable std::vector<Vec3d> now_;
  mutable bool is_current_ = false;  // `now_` has the present positions
};

}  // namespace supple
