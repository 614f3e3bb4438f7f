#include "simulation/moving_body.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/error.hpp"
#include "simulation/point_bounds.hpp"
#include "supple/simulation_descriptions.hpp"

namespace supple {
namespace {

void check_handles(const MassSpringMotion& motion, const TriangleMesh& mesh) {
  std::vector<std::uint8_t> is_held(mesh.positions.size(), 0);
  for (std::size_t h = 0; h < motion.handles.size(); ++h) {
    const MassSpringMotion::Handle& handle = motion.handles[h];
    const std::string what = "MassSpringMotion::handles[" + std::to_string(h) + "] of " + mesh.name;
    check(handle, what);
    for (const std::uint32_t vertex : handle.vertices) {
      if (vertex >= is_held.size()) {
        fail(what + ": vertex " + std::to_string(vertex) + " is out of range; there are " +
             std::to_string(is_held.size()) + " vertices, numbered from 0");
      }
      if (is_held[vertex] != 0) {
        fail(what + ": vertex " + std::to_string(vertex) +
             " is held twice; list each vertex once in one handle");
      }
      is_held[vertex] = 1;
    }
  }
}

void check_motion(const MassSpringMotion& motion, const TriangleMesh& mesh) {
  check(motion, "motion of " + mesh.name);
  check_handles(motion, mesh);
}

MassSpringOptions springs_of(const MassSpringMotion& motion, std::uint32_t threads) {
  MassSpringOptions springs = motion.springs;
  if (springs.threads == 0) springs.threads = threads;
  std::vector<std::uint32_t>& fixed = springs.fixed_vertices;
  for (const MassSpringMotion::Handle& handle : motion.handles)
    fixed.insert(fixed.end(), handle.vertices.begin(), handle.vertices.end());
  if (!motion.handles.empty()) {
    std::sort(fixed.begin(), fixed.end());
    fixed.erase(std::unique(fixed.begin(), fixed.end()), fixed.end());
  }
  return springs;
}

}  // namespace

MassSpringBody make_body(const TriangleMesh& rest, const MassSpringMotion& motion, std::uint32_t threads) {
  check_motion(motion, rest);
  return MassSpringBody(rest, springs_of(motion, threads));
}

MovingBody::MovingBody(MassSpringBody rest, const MassSpringMotion& motion, double time_step, Random random)
    : body(std::move(rest)),
      time_step_(time_step),
      drift_(motion.velocity + motion.random_speed * random.direction()),
      deform_seconds_(motion.deform_seconds),
      forces_(body.positions(),
              motion.random_force > 0 ? body.springs() : std::vector<MassSpringBody::Spring>{}, motion,
              random),
      handles_(motion.handles) {
  if (!forces_.change() && deform_seconds_ > 0) body.set_external_forces(forces_.constant());
  send_off_in_time();
  change_forces();
  pull_handles();
}

void MovingBody::change_velocities(std::span<const Vec3d> of_average, std::span<const Vec3d> after) {
  positions_.assign(body.positions().begin(), body.positions().end());
  velocities_.assign(body.velocities().begin(), body.velocities().end());
  for (std::size_t i = 0; i < positions_.size(); ++i) {
    positions_[i] = positions_[i] + time_step_ * of_average[i];
    velocities_[i] = velocities_[i] + after[i];
  }
  body.set_positions(positions_);
  body.set_velocities(velocities_);
}

void MovingBody::end_step(const std::optional<Border>& border) {
  ++steps_;
  if (border) reflect_at(*border);
  send_off_in_time();
  change_forces();
  pull_handles();
}

void MovingBody::reflect_at(const Border& border) {
  PointBounds bounds;
  for (const Vec3d& position : body.positions()) bounds.add(position);
  const Vec3d velocity = body.mean_velocity();
  for (int axis = 0; axis < 3; ++axis) {
    if (bounds.low[axis] < border[0][axis]) reflect_from_side(axis, -1, velocity[axis]);
    if (bounds.high[axis] > border[1][axis]) reflect_from_side(axis, 1, velocity[axis]);
  }
}

/// `outward` is the sign of the outward direction. The reflected speed is at least the speed that gravity
/// removes in a step, plus a margin for friction. Otherwise a body that lies on a side would slowly sink
/// into it.
void MovingBody::reflect_from_side(int axis, double outward, double velocity) {
  const double pull = std::max(outward * body.options().gravity[axis] * time_step_, 0.0);
  const double speed = outward * velocity;
  if (!(speed + pull > 0)) return;
  if (speed > 0) body.reflect(axis);
  const double missing = 1.25 * pull - std::fabs(speed);
  if (!(missing > 0)) return;
  const std::span<const Vec3d> before = body.velocities();
  velocities_.assign(before.begin(), before.end());
  for (Vec3d& v : velocities_) v[axis] -= outward * missing;
  for (const std::uint32_t vertex : body.options().fixed_vertices) velocities_[vertex] = before[vertex];
  body.set_velocities(velocities_);
}

void MovingBody::send_off_in_time() {
  constexpr double rounding = 1e-12;
  if (!is_in_place_ || seconds() < deform_seconds_ * (1 - rounding)) return;
  is_in_place_ = false;
  if (deform_seconds_ > 0 && !forces_.change()) body.set_external_forces({});
  if (drift_ != Vec3d{}) body.add_drift(drift_);
}

void MovingBody::change_forces() {
  if (forces_.change()) body.set_external_forces(forces_.at(seconds(), body.positions()));
}

/// Fixed vertices keep the velocity they are given. This sets the velocity that brings each to the position
/// of its handle at the end of the next step.
void MovingBody::pull_handles() {
  if (handles_.empty() || handles_rest_) return;
  velocities_.assign(body.velocities().begin(), body.velocities().end());
  handles_rest_ = true;
  for (const MassSpringMotion::Handle& handle : handles_) {
    const double now = std::min(seconds() / handle.seconds, 1.0);
    const double next = std::min((seconds() + time_step_) / handle.seconds, 1.0);
    const Vec3d velocity = handle.by * ((next - now) / time_step_);
    for (const std::uint32_t vertex : handle.vertices) velocities_[vertex] = velocity;
    if (now < 1) handles_rest_ = false;
  }
  body.set_velocities(velocities_);
}

}  // namespace supple
