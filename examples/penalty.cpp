// Soft balls fall into a bowl of four walls. A penalty force proportional to the depth of each vertex pushes
// it out of the object that it is inside, and pushes that object back.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <utility>
#include <vector>

#include "supple/models.hpp"
#include "supple/supple.hpp"

namespace {

/// A ball whose vertices are drawn back to its shape around their center.
struct Ball {
  supple::ObjectId id;
  std::vector<supple::Vec3d> rest, positions, velocities, forces;

  supple::Vec3d center() const {
    supple::Vec3d sum;
    for (const supple::Vec3d& p : positions) sum += p;
    return sum / static_cast<double>(positions.size());
  }
  void step(double dt) {
    const supple::Vec3d middle = center();
    for (std::size_t v = 0; v < positions.size(); ++v) {
      const supple::Vec3d to_shape = middle + rest[v] - positions[v];
      velocities[v] += dt * (forces[v] + 400 * to_shape - 1.5 * velocities[v] + supple::Vec3d{0, -9.81, 0});
      positions[v] += dt * velocities[v];
      forces[v] = {};
    }
  }
};

}  // namespace

int main() {
  supple::Scene scene({.contacts = supple::ContactKinds::penetration});
  for (const auto& [size, place] : {std::pair<supple::Vec3d, supple::Vec3d>{{4, 1, 4}, {0, -0.5, 0}},
                                    {{0.5, 2, 4}, {-1.5, 1, 0}},
                                    {{0.5, 2, 4}, {1.5, 1, 0}},
                                    {{3, 2, 0.5}, {0, 1, -1.5}},
                                    {{3, 2, 0.5}, {0, 1, 1.5}}}) {
    supple::TriangleMesh wall = supple::make_box(size, 2);
    for (supple::Vec3d& p : wall.positions) p += place;
    scene.add(wall, {.name = "wall", .is_static = true, .solid = true});
  }
  const auto first_ball = static_cast<std::uint32_t>(scene.objects().size());
  const supple::TriangleMesh sphere = supple::make_icosphere(3);
  std::vector<Ball> balls(9);
  for (std::size_t i = 0; i < balls.size(); ++i) {
    Ball& ball = balls[i];
    const supple::Vec3d place{0.8 * static_cast<double>(i % 3) - 0.8, 1 + 0.9 * static_cast<double>(i / 3),
                              0.1 * static_cast<double>(i % 4) - 0.15};
    for (const supple::Vec3d& p : sphere.positions) {
      ball.rest.push_back(0.35 * p);
      ball.positions.push_back(0.35 * p + place);
    }
    ball.velocities.resize(ball.rest.size());
    ball.forces.resize(ball.rest.size());
    ball.id = scene.add({ball.positions}, {sphere.triangles}, {.name = "ball", .solid = true});
  }
  constexpr double dt = 0.004, stiffness = 3000;
  for (int step = 1; step <= 500; ++step) {
    const supple::DetectResult& result = scene.detect();
    double deepest = 0;
    for (const supple::Penetration& p : result.penetrations) {
      const supple::Vec3d force = stiffness * p.depth * p.normal;
      deepest = std::max(deepest, p.depth);
      if (p.object_a.index >= first_ball) balls[p.object_a.index - first_ball].forces[p.vertex] += force;
      if (p.object_b.index < first_ball) continue;
      Ball& other = balls[p.object_b.index - first_ball];
      const supple::Triangle& corners = sphere.triangles[p.triangle];
      for (std::size_t k = 0; k < 3; ++k) other.forces[corners[k]] -= p.barycentric[k] * force;
    }
    for (Ball& ball : balls) {
      ball.step(dt);
      scene.set_positions(ball.id, ball.positions);
    }
    if (step % 100 == 0) std::printf("step %d: the deepest vertex is %.3f inside\n", step, deepest);
  }
}
