// A crate falls onto a floor and slides, as a game would compute it: each pair of bodies has a manifold of at
// most four points, whose ids last from step to step, so that each point starts with its impulse of the step
// before.
#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <map>
#include <vector>

#include "supple/models.hpp"
#include "supple/supple.hpp"
#include "supple/use_manifolds.hpp"

using supple::Vec3d;

namespace {

constexpr double dt = 1.0 / 120, mass = 2, inertia = 0.5, gravity = -9.81, friction = 0.3, margin = 0.005;
constexpr int solver_rounds = 8;

/// A rigid crate with the same inertia around all axes.
struct Crate {
  Vec3d center{0, 1.2, 0}, velocity{1.5, 0, 0.3}, spin{};
  std::array<double, 4> turn{0.1, 0.05, 0.15, 1};  // quaternion x, y, z, w

  Vec3d velocity_at(const Vec3d& point) const { return velocity + cross(spin, point - center); }
  void push(const Vec3d& impulse, const Vec3d& point) {
    velocity += impulse / mass;
    spin += cross(point - center, impulse) / inertia;
  }
  /// The change of velocity at a point, along a direction, by an impulse of 1 in this direction.
  double response(const Vec3d& point, const Vec3d& direction) const {
    const Vec3d lever = cross(point - center, direction);
    return 1 / mass + dot(lever, lever) / inertia;
  }
  void step() {
    center += dt * velocity;
    const auto [x, y, z, w] = turn;
    const Vec3d s = 0.5 * dt * spin;
    turn = {x + s.x * w + s.y * z - s.z * y, y + s.y * w + s.z * x - s.x * z, z + s.z * w + s.x * y - s.y * x,
            w - s.x * x - s.y * y - s.z * z};
  }
};

/// What a point of a manifold remembers.
struct Impulses {
  double normal = 0;
  Vec3d friction{};
};

}  // namespace

int main() {
  supple::use_manifolds();
  supple::Scene scene(
      {.contacts = supple::ContactKinds::proximity | supple::ContactKinds::penetration, .manifolds = true});
  const supple::ObjectId box = scene.add(supple::make_box({1, 1, 1}, 4), {.name = "crate", .margin = margin});
  supple::TriangleMesh ground = supple::make_box({20, 1, 20}, 8);
  for (Vec3d& p : ground.positions) p.y -= 0.5;
  scene.add(ground, {.name = "floor", .is_static = true, .margin = margin});

  Crate crate;
  std::map<std::uint64_t, Impulses> before;  // by id of the point
  for (int step = 0; step <= 240; ++step) {
    const auto& [x, y, z, w] = crate.turn;
    scene.set_transform(box, supple::RigidTransform::from_quaternion(x, y, z, w, crate.center));
    const supple::DetectResult& result = scene.detect();
    crate.velocity.y += dt * gravity;

    std::map<std::uint64_t, Impulses> now;
    for (int round = 0; round <= solver_rounds; ++round) {
      for (const supple::Manifold& manifold : result.manifolds) {  // the crate is a, the floor is b
        for (const supple::ManifoldPoint& point : result.points_of(manifold)) {
          const auto [impulses, is_new] = now.try_emplace(point.id);
          Impulses& sum = impulses->second;
          if (is_new) {  // warm start
            if (const auto last = before.find(point.id); last != before.end()) sum = last->second;
            crate.push(sum.normal * manifold.normal + sum.friction, point.position);
            continue;
          }
          // A point may approach as far as it is apart, and leaves slowly when it is inside.
          const double wanted =
              point.depth > 0 ? 0.2 * std::max(0.0, point.depth - margin) / dt : point.depth / dt;
          const double approach = dot(crate.velocity_at(point.position), manifold.normal) - wanted;
          const double normal =
              std::max(0.0, sum.normal - approach / crate.response(point.position, manifold.normal));
          crate.push((normal - sum.normal) * manifold.normal, point.position);
          sum.normal = normal;
          Vec3d sliding = crate.velocity_at(point.position);
          sliding -= dot(sliding, manifold.normal) * manifold.normal;
          const double speed = norm(sliding);
          if (speed == 0) continue;
          Vec3d drag = sum.friction - sliding / crate.response(point.position, sliding / speed);
          if (norm(drag) > friction * sum.normal) drag *= friction * sum.normal / norm(drag);
          crate.push(drag - sum.friction, point.position);
          sum.friction = drag;
        }
      }
    }
    std::size_t stayed = 0;
    for (const supple::ManifoldPoint& point : result.manifold_points)
      stayed += point.lasting == supple::Lasting::stay ? 1 : 0;
    if (step % 24 == 0)
      std::printf(
          "step %3d: center (%.3f, %.3f, %.3f), %zu contacts and %zu near pairs, %zu points, %zu stay\n",
          step, crate.center.x, crate.center.y, crate.center.z, result.contacts.size(),
          result.proximity_pairs.size(), result.manifold_points.size(), stayed);
    before = std::move(now);
    crate.step();
  }
}
