// Particles fall onto a ball that swells. Those that get inside are moved to the closest point of its
// surface.
#include <cstdio>
#include <optional>
#include <vector>

#include "supple/models.hpp"
#include "supple/supple.hpp"

int main() {
  const supple::TriangleMesh sphere = supple::make_icosphere(8);
  supple::Scene scene;
  const supple::ObjectId ball = scene.add(sphere, {.name = "ball"});

  std::vector<supple::Vec3d> particles;
  std::vector<supple::Ray> down;
  for (int i = 0; i < 400; ++i) {
    particles.push_back({-1 + 0.1 * (i % 20), 1.6 + 0.01 * (i % 7), -1 + 0.1 * (i / 20.0)});
    down.push_back({particles.back(), {0, -1, 0}});
  }
  std::vector<std::optional<supple::RayHit>> hits(down.size());
  scene.cast(down, hits);
  std::size_t above = 0;
  for (const auto& hit : hits) above += hit ? 1 : 0;
  std::printf("%zu of %zu particles are above the ball\n", above, particles.size());

  std::vector<supple::Containment> places(particles.size());
  std::vector<std::optional<supple::ClosestPoint>> closest(particles.size());
  for (int step = 0; step < 40; ++step) {
    std::vector<supple::Vec3d> positions = sphere.positions;
    for (supple::Vec3d& p : positions) p = (1 + 0.005 * step) * p;
    scene.set_positions(ball, positions);
    for (supple::Vec3d& p : particles) p.y -= 0.05;
    scene.inside(particles, places);
    scene.closest(particles, closest);
    std::size_t moved = 0;
    for (std::size_t i = 0; i < particles.size(); ++i) {
      if (places[i] != supple::Containment::inside) continue;
      particles[i] = closest[i]->point;
      ++moved;
    }
    if (step % 10 == 9) std::printf("step %d: %zu particles were inside\n", step, moved);
  }
}
