#include "simulation/rigid_body.hpp"

#include <array>
#include <cmath>

#include "geometry/vector.hpp"
#include "simulation/point_bounds.hpp"
#include "supple/trigonometry.hpp"

namespace supple {
namespace {

/// Row by row, after Rodrigues: cos I + sin [axis]× + (1 - cos) axis axisᵀ.
std::array<double, 9> rotation_about(Vec3d axis, double turns) {
  const double sine = sin_turns(turns), cosine = cos_turns(turns), rest = 1 - cosine;
  const auto& [x, y, z] = axis;
  return {cosine + rest * x * x,   rest * x * y - sine * z, rest * x * z + sine * y,
          rest * y * x + sine * z, cosine + rest * y * y,   rest * y * z - sine * x,
          rest * z * x - sine * y, rest * z * y + sine * x, cosine + rest * z * z};
}

/// The product as `Scene::set_transform` computes it.
Vec3d rotated(const std::array<double, 9>& r, Vec3d p) {
  return {r[0] * p.x + r[1] * p.y + r[2] * p.z, r[3] * p.x + r[4] * p.y + r[5] * p.z,
          r[6] * p.x + r[7] * p.y + r[8] * p.z};
}

}  // namespace

RigidBody::RigidBody(std::span<const Vec3d> start, const RigidMotion& motion, double time_step, Random random)
    : time_step_(time_step), velocity_(motion.velocity + motion.random_speed * random.direction()) {
  const Vec3d spin = motion.spin + motion.random_spin * random.direction();
  const double degrees_per_second = norm(spin);
  if (degrees_per_second > 0) {
    axis_ = spin / degrees_per_second;
    turns_per_second_ = degrees_per_second / 360;
  }
  set_positions(start);
}

void RigidBody::set_positions(std::span<const Vec3d> positions) {
  start_.assign(positions.begin(), positions.end());
  steps_ = 0;
  way_ = {};
  transform_ = {};
  is_current_ = false;
  PointBounds bounds;
  Vec3d sum;
  double count = 0;
  for (const Vec3d& p : start_) {
    if (!is_finite(p)) continue;
    bounds.add(p);
    sum += p;
    ++count;
  }
  low_ = bounds.low;
  high_ = bounds.high;
  center_ = count > 0 ? sum / count : Vec3d{};
}

void RigidBody::step() {
  ++steps_;
  way_ += time_step_ * velocity_;
  is_current_ = false;
  transform_.translation = way_;
  if (!spins()) return;
  const double turns = turns_per_second_ * (static_cast<double>(steps_) * time_step_);
  transform_.rotation = rotation_about(axis_, turns - std::floor(turns));
  transform_.translation += center_ - rotated(transform_.rotation, center_);
}

/// The sum of all offsets in the scene has the bits of `way_`.
void RigidBody::place(Scene& scene, ObjectId id) const {
  if (spins())
    scene.set_transform(id, transform_);
  else
    scene.translate(id, time_step_ * velocity_);
}

void RigidBody::place_again(Scene& scene, ObjectId id) const {
  scene.set_positions(id, std::span<const Vec3d>(start_));
  scene.set_transform(id, transform_);
}

void RigidBody::reflect_at(const Border& border) {
  PointBounds bounds{low_ + way_, high_ + way_};
  if (spins()) {
    bounds = {};
    for (const Vec3d& p : positions()) {
      if (is_finite(p)) bounds.add(p);
    }
  }
  for (int axis = 0; axis < 3; ++axis) {
    const bool is_below = bounds.low[axis]<border[0][axis], is_above = bounds.high[axis]> border[1][axis];
    double& v = velocity_[axis];
    if ((is_below && v < 0) || (is_above && v > 0)) v = -v;
  }
}

std::span<const Vec3d> RigidBody::positions() const {
  if (is_current_) return now_;
  now_ = start_;
  for (Vec3d& p : now_) {
    if (spins() && steps_ > 0) p = rotated(transform_.rotation, p);
    if (transform_.translation != Vec3d{}) p += transform_.translation;
  }
  is_current_ = true;
  return now_;
}

}  // namespace supple
