// Tutorial, part 3: a cloth falls onto a ball and must pass neither through the ball nor through itself.
#include <algorithm>
#include <cstdio>
#include <vector>

#include "supple/models.hpp"
#include "supple/supple.hpp"

using supple::Vec3d;

constexpr double time_step = 0.01, gravity = -9.81, stiffness = 2000, damping = 2;

struct Spring {
  std::uint32_t a, b;
  double rest_length;
};

int main() {
  const supple::TriangleMesh shape = supple::make_cloth(24, 24, 2.4, 2.4);
  std::vector<Vec3d> now = shape.positions, next = now, velocities(now.size());
  for (Vec3d& p : now) p.y += 1.5;
  std::vector<Spring> springs;
  for (const supple::Triangle& t : shape.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t a = t[i], b = t[(i + 1) % 3];
      springs.push_back({a, b, norm(now[a] - now[b])});
    }
  }

  supple::SceneOptions options;
  options.contacts = supple::ContactKinds::continuous;
  supple::Scene scene(options);
  scene.add(supple::make_icosphere(10), {.name = "ball", .is_static = true});
  const supple::ObjectId cloth = scene.add(shape, {.name = "cloth", .self_collision = true});

  for (int step = 1; step <= 100; ++step) {
    // 1. Your forces: gravity, springs, damping.
    std::vector<Vec3d> forces(now.size());
    for (const Spring& s : springs) {
      const Vec3d d = now[s.b] - now[s.a];
      const Vec3d pull = d * (stiffness * (norm(d) - s.rest_length) / norm(d));
      forces[s.a] += pull;
      forces[s.b] -= pull;
    }
    for (std::size_t i = 0; i < now.size(); ++i)
      velocities[i] =
          velocities[i] * (1 - damping * time_step) + (forces[i] + Vec3d{0, gravity, 0}) * time_step;

    // 2. Find what would touch on the paths, stop its approach, and look again.
    std::size_t found = 0, left = 0;
    for (int round = 0; round < 10; ++round) {
      for (std::size_t i = 0; i < now.size(); ++i) next[i] = now[i] + velocities[i] * time_step;
      scene.set_motion(cloth, now, next);
      const supple::DetectResult& result = scene.detect();
      left = result.continuous_contacts.size();
      if (round == 0) found = left;
      if (left == 0) break;
      for (const supple::ContinuousContact& c : result.continuous_contacts) {
        double approach = 0, weight = 0;
        const auto for_each_cloth_vertex = [&](auto visit) {
          for (const supple::ContactSide side : {supple::ContactSide::a, supple::ContactSide::b}) {
            if ((side == supple::ContactSide::a ? c.object_a : c.object_b) != cloth) continue;
            const auto& barycentric = side == supple::ContactSide::a ? c.barycentric_a : c.barycentric_b;
            const supple::ElementVertices vertices = scene.vertices_of(c, side);
            for (std::size_t i = 0; i < vertices.size(); ++i)
              visit(velocities[vertices[i]],
                    side == supple::ContactSide::a ? barycentric[i] : -barycentric[i]);
          }
        };
        for_each_cloth_vertex([&](const Vec3d& v, double w) {
          approach += w * dot(v, c.normal);
          weight += w * w;
        });
        if (approach >= 0 || weight == 0) continue;  // they already separate
        for_each_cloth_vertex([&](Vec3d& v, double w) { v -= c.normal * (w * approach / weight); });
      }
    }

    // 3. Go as far as is safe: the whole step, or to just before the first contact that is left.
    const double part = left == 0 ? 1 : 0.9 * scene.max_step().step;
    for (std::size_t i = 0; i < now.size(); ++i) now[i] += (next[i] - now[i]) * part;
    if (step % 20 != 0) continue;
    double lowest = now[0].y;
    for (const Vec3d& p : now) lowest = std::min(lowest, p.y);
    std::printf("step %3d: %zu contacts, %zu after the response; lowest point at %.2f\n", step, found, left,
                lowest);
  }

  // The proof: no triangle of the cloth intersects the ball or the cloth.
  scene.set_positions(cloth, now);
  const supple::DetectResult& proof = scene.detect({.contacts = supple::ContactKinds::intersection});
  std::printf("%zu triangles intersect\n", proof.contacts.size());
}
