#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "simulation/deforming_forces.hpp"
#include "simulation/random.hpp"
#include "supple/motion.hpp"
#include "supple/simulation.hpp"

namespace supple {

/// Makes the mass-spring body of a motion; vertices held by handles are fixed. `threads` applies when the
/// options leave it open. Throws `Error` with the name of a member that is out of range.
MassSpringBody make_body(const TriangleMesh& rest, const MassSpringMotion& motion, std::uint32_t threads);

/// A mass-spring body with everything that acts on it besides its own forces: deforming forces, the initial
/// drift, handles, and the border.
class MovingBody {
 public:
  /// `rest` is the result of `make_body` for the same motion.
  MovingBody(MassSpringBody rest, const MassSpringMotion& motion, double time_step, Random random);

  MassSpringBody body;

  /// Adds changes to the average velocity over the step just taken, and to the velocity after it; one entry
  /// per vertex.
  void change_velocities(std::span<const Vec3d> of_average, std::span<const Vec3d> after);
  /// Call after a step that will not be undone. Updates velocities and forces for the next step.
  void end_step(const std::optional<Border>& border);

 private:
  double seconds() const { return static_cast<double>(steps_) * time_step_; }
  void reflect_at(const Border& border);
  void reflect_from_side(int axis, double outward, double velocity);
  void send_off_in_time();
  void change_forces();
  void pull_handles();

  double time_step_;
  std::uint64_t steps_ = 0;
  Vec3d drift_;
  double deform_seconds_;
  bool is_in_place_ = true;
  DeformingForces forces_;
  std::vector<MassSpringMotion::Handle> handles_;
  bool handles_rest_ = false;
  std::vector<Vec3d> positions_, velocities_;  // scratch memory
};

}  // namespace supple
