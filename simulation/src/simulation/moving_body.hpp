#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/random.hpp"
#include "supple/motion.hpp"
#include "supple/simulation.hpp"

namespace supple {

/// The masses and springs of a motion, those that handles hold fixed. `threads` is for a body whose options
/// leave it open. Throws `Error` naming the member that is out of its range.
MassSpringBody make_body(const TriangleMesh& rest, const MassSpringMotion& motion, std::uint32_t threads);

/// A body of masses and springs, and what happens to it from step to step besides its own forces: deforming
/// forces, the drift that sends it off, handles that pull, and the border.
class MovingBody {
 public:
  /// `rest` is what `make_body` made of the same motion.
  MovingBody(MassSpringBody rest, const MassSpringMotion& motion, double time_step, Random random);

  MassSpringBody body;

  /// Changes of the average velocity over the step just taken, and of the velocity after it, of each vertex.
  void change_velocities(std::span<const Vec3d> of_average, std::span<const Vec3d> after);
  /// After a step that will not be undone: all that changes velocities and forces for the next one.
  void end_step(const std::optional<Border>& border);

 private:
  double seconds() const { return static_cast<double>(steps_) * time_step_; }
  void turn_back_at(const Border& border);
  void turn_back_from_side(int axis, double outward, double velocity);
  void send_off_in_time();
  void pull_handles();

  double time_step_;
  std::uint64_t steps_ = 0;
  Vec3d drift_;
  double deform_seconds_;
  bool is_deforming_ = true;
  std::vector<MassSpringMotion::Handle> handles_;
  bool handles_rest_ = false;
  std::vector<Vec3d> positions_, velocities_;  // scratch
};

}  // namespace supple
