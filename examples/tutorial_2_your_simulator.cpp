// Tutorial, part 2: a soft ball falls onto a floor. The simulator is this file; Supple only finds the
// contacts.
#include <cstdio>
#include <vector>

#include "supple/models.hpp"
#include "supple/supple.hpp"

using supple::Vec3d;

int main() {
  const supple::TriangleMesh shape = supple::make_icosphere(6);
  std::vector<Vec3d> positions = shape.positions;
  std::vector<Vec3d> velocities(positions.size());
  for (Vec3d& p : positions) p.y += 2;

  supple::Scene scene;
  const supple::ObjectId ball = scene.add(shape, {.name = "ball"});
  supple::TriangleMesh floor = supple::make_box({8, 1, 8}, 4);
  for (Vec3d& p : floor.positions) p.y -= 0.5;  // its top is at y = 0
  scene.add(floor, {.name = "floor", .is_static = true});

  constexpr double time_step = 0.02, gravity = -9.81, stiffness = 1000, damping = 0.2;
  for (int step = 0; step < 120; ++step) {
    // 1. Your motion. Here every vertex is pulled to its place in the undeformed ball.
    Vec3d center{};
    for (const Vec3d& p : positions) center = center + p;
    center = center * (1.0 / static_cast<double>(positions.size()));
    for (std::size_t i = 0; i < positions.size(); ++i) {
      const Vec3d pull = (center + shape.positions[i] - positions[i]) * stiffness;
      velocities[i] = velocities[i] * (1 - damping * time_step) + (pull + Vec3d{0, gravity, 0}) * time_step;
      positions[i] = positions[i] + velocities[i] * time_step;
    }

    // 2. Detection.
    scene.set_positions(ball, positions);
    const supple::DetectResult& result = scene.detect();
    if (!result.contact_events.begin.empty()) std::printf("step %d: the ball touches the floor\n", step);
    if (!result.contact_events.end.empty()) std::printf("step %d: the ball leaves the floor\n", step);

    // 3. Your response. Here the floor stops every vertex that went below it.
    if (result.contacts.empty()) continue;
    for (std::size_t i = 0; i < positions.size(); ++i) {
      if (positions[i].y >= 0) continue;
      positions[i].y = 0;
      velocities[i].y = 0;
    }
  }
  double lowest = positions[0].y;
  for (const Vec3d& p : positions) lowest = p.y < lowest ? p.y : lowest;
  std::printf("at the end the lowest point is at y = %.2f\n", lowest);
}
