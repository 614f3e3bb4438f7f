// The contact part of a solver in the style of incremental potential contact (IPC, Li et al. 2020). A cloth
// is thrown onto a ball: in each time step, descent lowers an energy of inertia, springs and barriers.
// Proximity in the listing of features is the set of barriers: each pair of closest features once. `max_step`
// limits each step of the descent, so that nothing ever intersects. An argument is the number of time steps,
// 60 by default.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <utility>
#include <vector>

#include "supple/models.hpp"
#include "supple/supple.hpp"

using supple::Vec3d;

namespace {

/// Barriers act at distances below d_hat, m: energy -stiffness (d - d_hat)² ln(d / d_hat), in joules.
constexpr double d_hat = 0.01, barrier_stiffness = 20;
constexpr double vertex_mass = 1e-3, gravity = -9.81, spring_stiffness = 1, time_step = 0.01;
constexpr int descents = 10;

struct Spring {
  std::uint32_t a, b;
  double length;
};

/// The incremental potential, whose minimum is the end of the time step.
struct Potential {
  double energy = 0;
  double nearest = d_hat;       ///< the smallest distance of two features
  std::vector<Vec3d> gradient;  ///< by the vertices of the cloth
  std::vector<double> scale;    ///< an estimate of the diagonal of the Hessian
};

/// The barriers of all pairs within d_hat. The derivative of a distance by the vertices of its features is
/// the normal, weighted with the barycentric coordinates of the closest points.
void add_barriers(supple::Scene& scene, supple::ObjectId cloth, Potential& sum) {
  for (const supple::ProximityPair& pair : scene.detect().proximity_pairs) {
    const double d = pair.distance, below = d - d_hat, logarithm = std::log(d / d_hat);
    const double derivative = -barrier_stiffness * below * (2 * logarithm + below / d);
    const double second = -barrier_stiffness * (2 * logarithm + 4 * below / d - below * below / (d * d));
    sum.energy += -barrier_stiffness * below * below * logarithm;
    sum.nearest = std::min(sum.nearest, d);
    for (const supple::ContactSide side : {supple::ContactSide::a, supple::ContactSide::b}) {
      const bool is_a = side == supple::ContactSide::a;
      if ((is_a ? pair.object_a : pair.object_b) != cloth) continue;
      const auto& weights = is_a ? pair.barycentric_a : pair.barycentric_b;
      const supple::ElementVertices vertices = scene.vertices_of(pair, side);
      for (std::size_t i = 0; i < vertices.size(); ++i) {
        sum.gradient[vertices[i]] += pair.normal * ((is_a ? 1 : -1) * weights[i] * derivative);
        sum.scale[vertices[i]] += weights[i] * second;
      }
    }
  }
}

/// `free` are the positions that the vertices would reach without springs and contacts.
Potential potential_at(supple::Scene& scene, supple::ObjectId cloth, const std::vector<Spring>& springs,
                       const std::vector<Vec3d>& free, const std::vector<Vec3d>& x) {
  constexpr double inertia = vertex_mass / (time_step * time_step);
  Potential sum;
  sum.scale.assign(x.size(), inertia);
  for (std::size_t v = 0; v < x.size(); ++v) {
    sum.energy += 0.5 * inertia * squared_norm(x[v] - free[v]);
    sum.gradient.push_back(inertia * (x[v] - free[v]));
  }
  for (const Spring& s : springs) {
    const Vec3d along = x[s.b] - x[s.a];
    const double length = norm(along), stretch = length - s.length;
    const Vec3d pull = along * (spring_stiffness * stretch / length);
    sum.energy += 0.5 * spring_stiffness * stretch * stretch;
    sum.gradient[s.a] -= pull;
    sum.gradient[s.b] += pull;
    for (const std::uint32_t v : {s.a, s.b}) sum.scale[v] += spring_stiffness;
  }
  scene.set_positions(cloth, x);
  add_barriers(scene, cloth, sum);
  return sum;
}

std::vector<Vec3d> moved(const std::vector<Vec3d>& x, const std::vector<Vec3d>& direction, double step) {
  std::vector<Vec3d> to(x.size());
  for (std::size_t v = 0; v < x.size(); ++v) to[v] = x[v] + step * direction[v];
  return to;
}

double product(const std::vector<Vec3d>& a, const std::vector<Vec3d>& b) {
  double sum = 0;
  for (std::size_t v = 0; v < a.size(); ++v) sum += dot(a[v], b[v]);
  return sum;
}

}  // namespace

int main(int argc, char** argv) {
  const int time_steps = argc > 1 ? std::atoi(argv[1]) : 60;
  supple::TriangleMesh ball = supple::make_icosphere(8);
  for (Vec3d& p : ball.positions) p *= 0.4;
  const supple::TriangleMesh sheet = supple::make_cloth(20, 20, 1.2, 1.2);
  std::vector<Vec3d> x = sheet.positions;
  for (Vec3d& p : x) p += {0.01, 0.6, 0.02};
  std::vector<Spring> springs;
  for (const supple::Triangle& t : sheet.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t a = t[i], b = t[(i + 1) % 3];
      springs.push_back({a, b, norm(sheet.positions[b] - sheet.positions[a])});
    }
  }

  // A pair is near within the sum of two margins.
  supple::Scene scene({.contacts = supple::ContactKinds::proximity});
  scene.add(ball, {.is_static = true, .margin = d_hat / 2});
  const supple::ObjectId cloth =
      scene.add({x}, {sheet.triangles}, {.self_collision = true, .margin = d_hat / 2});

  std::vector<Vec3d> velocities(x.size(), {0, -4, 0}), free(x.size());
  double largest_error = 0;
  int limited = 0;
  for (int step = 1; step <= time_steps; ++step) {
    const std::vector<Vec3d> before = x;
    for (std::size_t v = 0; v < x.size(); ++v)
      free[v] = x[v] + time_step * (velocities[v] + time_step * Vec3d{0, gravity, 0});
    const auto potential = [&](const std::vector<Vec3d>& at) {
      return potential_at(scene, cloth, springs, free, at);
    };
    Potential now = potential(x);
    for (int descent = 0; descent < descents; ++descent) {
      std::vector<Vec3d> direction(x.size());
      for (std::size_t v = 0; v < x.size(); ++v) direction[v] = now.gradient[v] * (-1 / now.scale[v]);
      const double slope = product(now.gradient, direction);

      // The longest step that is free of contact, then shorter ones until the energy falls enough.
      scene.set_motion(cloth, x, moved(x, direction, 1));
      const double free_part = scene.max_step().step;
      if (free_part < 1) ++limited;
      double part = free_part < 1 ? 0.9 * free_part : 1;
      Potential next = potential(moved(x, direction, part));
      while (part > 1e-9 && next.energy > now.energy + 1e-4 * part * slope) {
        part /= 2;
        next = potential(moved(x, direction, part));
      }
      x = moved(x, direction, part);
      now = std::move(next);
    }
    for (std::size_t v = 0; v < x.size(); ++v) velocities[v] = (x[v] - before[v]) / time_step;
    if (step * 6 % time_steps != 0) continue;

    // The gradient agrees with differences of the energy along it.
    const double squared = product(now.gradient, now.gradient), h = 1e-8 / std::sqrt(squared);
    const double rise =
        potential(moved(x, now.gradient, h)).energy - potential(moved(x, now.gradient, -h)).energy;
    largest_error = std::max(largest_error, std::abs(rise / (2 * h * squared) - 1));
    std::printf("step %d: potential %.5f J, gradient %.5f N, nearest features at %.4f m\n", step, now.energy,
                std::sqrt(squared), now.nearest);
  }

  scene.set_positions(cloth, x);
  const std::size_t cut = scene.detect({.contacts = supple::ContactKinds::intersection}).contacts.size();
  std::printf("contact limited %d of %d descents\n", limited, time_steps * descents);
  std::printf("the gradient is exact to %.0e; %zu pairs of triangles intersect\n", largest_error, cut);
  return cut == 0 && largest_error < 1e-3 ? 0 : 1;
}
