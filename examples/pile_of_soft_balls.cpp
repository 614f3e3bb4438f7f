// Soft balls in a box fall and pile up: extended position-based dynamics (XPBD) with constraints for edges
// and volumes. Proximity gives the contact constraints between balls and walls, once per frame. The program
// prints the share of the time that is spent in Supple. An argument is the number of frames, 60 by default.
#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <span>
#include <vector>

#include "supple/models.hpp"
#include "supple/supple.hpp"

using supple::Vec3d;

namespace {

constexpr double frame_seconds = 1.0 / 60, gravity = -9.81, damping = 0.5;
constexpr int substeps = 40;
constexpr double thickness = 0.006, margin = 0.006;  // proximity finds pairs within the sum of two margins
constexpr double edge_compliance = 2e-5;  ///< inverse of a stiffness, with the mass of a vertex as the unit

struct Edge {
  std::uint32_t a, b;
  double length;
};

/// All balls, one after the other in each array.
struct Balls {
  std::vector<Vec3d> positions, before, velocities;
  std::vector<Edge> edges;           // of one ball
  supple::TriangleMesh shape;        // of one ball at rest
  double volume = 0;                 // of one ball at rest
  std::vector<supple::ObjectId> id;  // of each ball

  std::span<Vec3d> of(std::vector<Vec3d>& all, std::size_t ball) const {
    return std::span(all).subspan(ball * shape.positions.size(), shape.positions.size());
  }
};

double volume_of(const supple::TriangleMesh& mesh, std::span<const Vec3d> p) {
  double sum = 0;
  for (const supple::Triangle& t : mesh.triangles) sum += dot(p[t[0]], cross(p[t[1]], p[t[2]])) / 6;
  return sum;
}

/// One iteration of each constraint of a ball. Without Lagrange multipliers, because each substep starts at
/// zero.
void keep_shape(const Balls& balls, std::span<Vec3d> p, double seconds) {
  for (const Edge& e : balls.edges) {
    const Vec3d d = p[e.a] - p[e.b];
    const double length = norm(d);
    const Vec3d push = d * ((e.length - length) / (length * (2 + edge_compliance / (seconds * seconds))));
    p[e.a] += push;
    p[e.b] -= push;
  }
  std::vector<Vec3d> gradient(p.size());
  for (const supple::Triangle& t : balls.shape.triangles) {
    for (std::size_t i = 0; i < 3; ++i) gradient[t[i]] += cross(p[t[(i + 1) % 3]], p[t[(i + 2) % 3]]) / 6;
  }
  double squared = 0;
  for (const Vec3d& g : gradient) squared += squared_norm(g);
  const double factor = (balls.volume - volume_of(balls.shape, p)) / squared;
  for (std::size_t v = 0; v < p.size(); ++v) p[v] += factor * gradient[v];
}

/// A pair of features: the vertices of balls with their weights, negative on side b, and the point on a wall.
struct Constraint {
  std::array<std::uint32_t, 6> vertices{};
  std::array<double, 6> weights{};
  std::size_t count = 0;
  Vec3d wall, normal;
  double distance = 0, squared_weights = 0;
};

Constraint constraint_of(const supple::Scene& scene, const supple::ProximityPair& pair, const Balls& balls) {
  Constraint c;
  c.normal = pair.normal;
  c.distance = std::min(thickness, pair.distance);  // no jump apart
  for (const supple::ContactSide side : {supple::ContactSide::a, supple::ContactSide::b}) {
    const bool is_a = side == supple::ContactSide::a;
    const std::uint32_t object = is_a ? pair.object_a.index : pair.object_b.index;
    const std::uint32_t first_ball = balls.id.front().index;
    if (object < first_ball) {
      c.wall += is_a ? pair.point_a : -pair.point_b;
      continue;
    }
    const auto first = static_cast<std::uint32_t>((object - first_ball) * balls.shape.positions.size());
    const supple::ElementVertices vertices = scene.vertices_of(pair, side);
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      c.vertices[c.count] = first + vertices[i];
      c.weights[c.count] = is_a ? pair.barycentric_a[i] : -pair.barycentric_b[i];
      c.squared_weights += c.weights[c.count] * c.weights[c.count];
      ++c.count;
    }
  }
  return c;
}

void keep_apart(const Constraint& c, Balls& balls) {
  Vec3d apart = c.wall;
  for (std::size_t i = 0; i < c.count; ++i) apart += c.weights[i] * balls.positions[c.vertices[i]];
  const double missing = c.distance - dot(apart, c.normal);
  if (missing <= 0) return;
  for (std::size_t i = 0; i < c.count; ++i)
    balls.positions[c.vertices[i]] += c.normal * (missing * c.weights[i] / c.squared_weights);
}

Balls add_balls(supple::Scene& scene, std::size_t count, double radius) {
  Balls balls;
  balls.shape = supple::make_icosphere(4);
  for (Vec3d& p : balls.shape.positions) p *= radius;
  balls.volume = volume_of(balls.shape, balls.shape.positions);
  for (const supple::Triangle& t : balls.shape.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t a = t[i], b = t[(i + 1) % 3];
      if (a < b) balls.edges.push_back({a, b, norm(balls.shape.positions[b] - balls.shape.positions[a])});
    }
  }
  for (std::size_t i = 0; i < count; ++i) {
    const auto x = static_cast<double>(i % 3), y = static_cast<double>(i / 9),
               z = static_cast<double>(i / 3 % 3);
    for (const Vec3d& p : balls.shape.positions)
      balls.positions.push_back(p +
                                Vec3d{0.43 * (x - 1) + 0.03 * y, 0.3 + 0.5 * y, 0.43 * (z - 1) - 0.02 * y});
    balls.id.push_back(
        scene.add({balls.of(balls.positions, i)}, {balls.shape.triangles}, {.margin = margin}));
  }
  balls.before = balls.positions;
  balls.velocities.resize(balls.positions.size());
  return balls;
}

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace

int main(int argc, char** argv) {
  const int frames = argc > 1 ? std::atoi(argv[1]) : 60;
  supple::Scene scene({.contacts = supple::ContactKinds::proximity});
  supple::TriangleMesh box = supple::make_box({1.4, 3, 1.4});
  for (Vec3d& p : box.positions) p.y += 1.5;
  scene.add(box, {.is_static = true, .margin = margin});
  Balls balls = add_balls(scene, 27, 0.2);

  double in_supple = 0;
  const double start = now();
  std::vector<Constraint> constraints;
  for (int frame = 1; frame <= frames; ++frame) {
    double begin = now();
    for (std::size_t i = 0; i < balls.id.size(); ++i)
      scene.set_positions(balls.id[i], balls.of(balls.positions, i));
    const supple::DetectResult& result = scene.detect();
    in_supple += now() - begin;
    constraints.clear();
    for (const supple::ProximityPair& pair : result.proximity_pairs)
      constraints.push_back(constraint_of(scene, pair, balls));

    std::vector<Vec3d> from = balls.positions;
    constexpr double seconds = frame_seconds / substeps;
    for (int substep = 0; substep < substeps; ++substep) {
      balls.before = balls.positions;
      for (std::size_t v = 0; v < from.size(); ++v)
        balls.positions[v] += seconds * (balls.velocities[v] + seconds * Vec3d{0, gravity, 0});
      for (std::size_t i = 0; i < balls.id.size(); ++i)
        keep_shape(balls, balls.of(balls.positions, i), seconds);
      for (const Constraint& c : constraints) keep_apart(c, balls);
      for (std::size_t v = 0; v < from.size(); ++v)
        balls.velocities[v] = (balls.positions[v] - balls.before[v]) * ((1 - damping * seconds) / seconds);
    }

    // A pair that proximity does not find can touch only when a vertex moves further than a margin.
    double farthest = 0, part = 1;
    for (std::size_t v = 0; v < from.size(); ++v)
      farthest = std::max(farthest, norm(balls.positions[v] - from[v]));
    if (farthest >= margin) {
      begin = now();
      for (std::size_t i = 0; i < balls.id.size(); ++i)
        scene.set_motion(balls.id[i], balls.of(from, i), balls.of(balls.positions, i));
      part = scene.max_step().step;
      in_supple += now() - begin;
      for (std::size_t v = 0; part < 1 && v < from.size(); ++v)
        balls.positions[v] = from[v] + (balls.positions[v] - from[v]) * (0.9 * part);
    }
    if (frame % 10 == 0)
      std::printf("frame %d: %zu constraints, moves up to %.4f m, goes %.0f %% of the way\n", frame,
                  constraints.size(), farthest, part < 1 ? 90 * part : 100);
  }
  std::printf("%.0f %% of %.2f s were spent in Supple\n", 100 * in_supple / (now() - start), now() - start);

  for (std::size_t i = 0; i < balls.id.size(); ++i)
    scene.set_positions(balls.id[i], balls.of(balls.positions, i));
  const std::size_t cut = scene.detect({.contacts = supple::ContactKinds::intersection}).contacts.size();
  std::printf("%zu pairs of triangles intersect\n", cut);
  return cut == 0 ? 0 : 1;
}
