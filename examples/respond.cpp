// The contact response of the library for your own simulator: `respond` changes your velocities so that
// nothing passes through anything. A cloth of masses and springs falls onto a ball that turns and drags it
// along.
#include <cmath>
#include <cstdio>
#include <vector>

#include "supple/models.hpp"
#include "supple/response.hpp"
#include "supple/supple.hpp"

using supple::Vec3d;

int main() {
  constexpr double dt = 0.004, mass = 0.005, stiffness = 10, spin = 1;
  constexpr supple::ContactResponse response{.thickness = 0.01, .friction = 0.5};
  constexpr double margin = supple::least_margin(response);

  supple::Scene scene({.contacts = supple::ContactKinds::intersection});
  supple::TriangleMesh ball = supple::make_icosphere(6);
  for (Vec3d& p : ball.positions) p *= 0.3;
  const supple::ObjectId ball_id = scene.add(ball, {.margin = margin});
  const supple::TriangleMesh sheet = supple::make_cloth(14, 14);
  std::vector<Vec3d> x = sheet.positions, velocities(x.size()), ball_velocities(ball.positions.size());
  for (Vec3d& p : x) p.y += 0.35;
  const std::vector<double> masses(x.size(), mass);
  const supple::ObjectId cloth_id =
      scene.add({x}, {sheet.triangles}, {.self_collision = true, .margin = margin});

  std::size_t cut = 0;
  for (int step = 1; step <= 300; ++step) {
    // 1. Your forces give your velocities.
    std::vector<Vec3d> forces(x.size(), {0, -9.81 * mass, 0});
    for (const supple::Triangle& t : sheet.triangles) {
      for (std::size_t i = 0; i < 3; ++i) {
        const std::uint32_t a = t[i], b = t[(i + 1) % 3];
        const Vec3d d = x[b] - x[a];
        const double rest = norm(sheet.positions[b] - sheet.positions[a]);
        const Vec3d pull = d * (0.5 * stiffness * (norm(d) - rest) / norm(d));
        forces[a] += pull;
        forces[b] -= pull;
      }
    }
    for (std::size_t v = 0; v < x.size(); ++v) velocities[v] = 0.995 * velocities[v] + dt / mass * forces[v];
    for (std::size_t v = 0; v < ball.positions.size(); ++v)
      ball_velocities[v] = cross(Vec3d{0, spin, 0}, ball.positions[v]);

    // 2. The response. The ball has no masses: it pushes and is not pushed.
    const std::vector<supple::ResponseBody> bodies{{ball_id, ball_velocities},
                                                   {cloth_id, velocities, masses}};
    const double part = supple::respond(scene, bodies, dt, response);

    // 3. Move.
    for (std::size_t v = 0; v < x.size(); ++v) x[v] += part * dt * velocities[v];
    for (std::size_t v = 0; v < ball.positions.size(); ++v)
      ball.positions[v] += part * dt * ball_velocities[v];
    scene.set_positions(cloth_id, x);
    scene.set_positions(ball_id, ball.positions);
    cut += scene.detect().contacts.size();
    if (step % 60 == 0) {
      const Vec3d arm = x.front();
      std::printf("%.2f s: a corner of the cloth is at height %.2f and %.0f degrees\n", step * dt, arm.y,
                  std::atan2(arm.x, arm.z) * 57.29578);
    }
  }
  std::printf("%zu pairs of triangles intersected in all steps\n", cut);
  return cut == 0 ? 0 : 1;
}
