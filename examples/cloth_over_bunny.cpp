// A cloth falls over a rabbit: extended position-based dynamics (XPBD, Macklin, Müller and Chentanez 2016)
// with small steps. Proximity gives the contact constraints, once per frame. Where a vertex moves so far in a
// frame that it could pass a surface, the frame is cut to the part after which each pair keeps a fifth of its
// distance. The program prints the share of the time that is spent in Supple. An argument is the number of
// frames, 60 by default.
#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "supple/models.hpp"
#include "supple/supple.hpp"

using supple::Vec3d;

namespace {

constexpr double frame_seconds = 1.0 / 60, gravity = -9.81, damping = 1, friction = 0.4;
constexpr int substeps = 30;
/// Contacts keep the thickness. Proximity finds pairs within the sum of two margins, so that no pair that it
/// does not find can touch while every vertex moves less than a margin.
constexpr double thickness = 0.008, margin = 0.006;
/// What a pair that is nearer than the thickness regains in a frame. Without it, each shortened frame would
/// lower the distance that the next one keeps, and the cloth would lock where it touches.
constexpr double regain = thickness / 8;

/// Keeps the distance of two vertices. Its compliance is the inverse of a stiffness, m/N.
struct Link {
  std::uint32_t a, b;
  double length, compliance;
};

struct Cloth {
  std::vector<Vec3d> positions, before, velocities;
  std::vector<Link> links;
  double inverse_mass = 0;
};

Cloth make(const supple::TriangleMesh& mesh, double vertex_mass) {
  Cloth cloth{mesh.positions, mesh.positions, std::vector<Vec3d>(mesh.positions.size()), {}, 1 / vertex_mass};
  std::vector<std::array<std::uint32_t, 3>> sides;  // the ends, and the opposite corner
  for (const supple::Triangle& t : mesh.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t a = t[i], b = t[(i + 1) % 3];
      sides.push_back({std::min(a, b), std::max(a, b), t[(i + 2) % 3]});
    }
  }
  std::sort(sides.begin(), sides.end());
  const auto link = [&](std::uint32_t a, std::uint32_t b, double compliance) {
    cloth.links.push_back({a, b, norm(mesh.positions[a] - mesh.positions[b]), compliance});
  };
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const bool is_repeated = i > 0 && sides[i][0] == sides[i - 1][0] && sides[i][1] == sides[i - 1][1];
    if (is_repeated) {
      link(sides[i - 1][2], sides[i][2], 1e-2);  // against bending
    } else {
      link(sides[i][0], sides[i][1], 1e-6);
    }
  }
  return cloth;
}

/// One iteration of each constraint. Without Lagrange multipliers, because each substep starts at zero.
void keep_lengths(Cloth& cloth, double seconds) {
  for (const Link& link : cloth.links) {
    Vec3d& a = cloth.positions[link.a];
    Vec3d& b = cloth.positions[link.b];
    const Vec3d d = a - b;
    const double length = norm(d);
    const double softness = link.compliance / (seconds * seconds);
    const Vec3d push = d * ((link.length - length) / (length * (2 * cloth.inverse_mass + softness)));
    a += cloth.inverse_mass * push;
    b -= cloth.inverse_mass * push;
  }
}

/// A pair of features with their vertices in the cloth; the rabbit does not move.
struct Constraint {
  supple::ElementVertices vertices_a, vertices_b;
  std::array<double, 3> weights_a{}, weights_b{};
  Vec3d fixed;  // the point on the rabbit, with the sign of its side
  Vec3d normal;
  double distance = 0, squared_weights = 0;
};

Constraint constraint_of(const supple::Scene& scene, const supple::ProximityPair& pair,
                         supple::ObjectId cloth) {
  Constraint c;
  c.normal = pair.normal;
  c.distance = std::min(thickness, pair.distance + regain);  // no jump apart
  if (pair.object_a == cloth) {
    c.vertices_a = scene.vertices_of(pair, supple::ContactSide::a);
    c.weights_a = pair.barycentric_a;
  } else {
    c.fixed += pair.point_a;
  }
  if (pair.object_b == cloth) {
    c.vertices_b = scene.vertices_of(pair, supple::ContactSide::b);
    c.weights_b = pair.barycentric_b;
  } else {
    c.fixed -= pair.point_b;
  }
  for (const auto* weights : {&c.weights_a, &c.weights_b}) {
    for (const double w : *weights) c.squared_weights += w * w;
  }
  return c;
}

/// Keeps the two sides at the distance, and stops sliding within Coulomb's cone.
void keep_apart(const Constraint& c, Cloth& cloth) {
  Vec3d apart = c.fixed, slide;
  const auto for_each_vertex = [&](auto visit) {
    for (std::size_t i = 0; i < c.vertices_a.size(); ++i) visit(c.vertices_a[i], c.weights_a[i]);
    for (std::size_t i = 0; i < c.vertices_b.size(); ++i) visit(c.vertices_b[i], -c.weights_b[i]);
  };
  for_each_vertex([&](std::uint32_t v, double w) {
    apart += w * cloth.positions[v];
    slide += w * (cloth.positions[v] - cloth.before[v]);
  });
  const double missing = c.distance - dot(apart, c.normal);
  if (missing <= 0) return;
  slide -= c.normal * dot(slide, c.normal);
  const double way = norm(slide);
  const Vec3d stop = way > 0 ? slide * (std::min(friction * missing, way) / way) : Vec3d{};
  for_each_vertex([&](std::uint32_t v, double w) {
    cloth.positions[v] += (c.normal * missing - stop) * (w / c.squared_weights);
  });
}

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace

int main(int argc, char** argv) {
  const int frames = argc > 1 ? std::atoi(argv[1]) : 60;
  supple::TriangleMesh sheet = supple::make_cloth(48, 48, 1.4, 1.4);
  for (Vec3d& p : sheet.positions) p += {0.01, 0.55, 0.02};
  Cloth cloth = make(sheet, 1e-4);
  supple::Scene scene({.contacts = supple::ContactKinds::proximity});
  scene.add(supple::make_model("rabbit"), {.is_static = true, .margin = margin});
  const supple::ObjectId id = scene.add(sheet, {.self_collision = true, .margin = margin});

  double in_supple = 0;
  const double start = now();
  std::vector<Constraint> constraints;
  for (int frame = 1; frame <= frames; ++frame) {
    double begin = now();
    scene.set_positions(id, cloth.positions);
    const supple::DetectResult& result = scene.detect();
    in_supple += now() - begin;
    constraints.clear();
    for (const supple::ProximityPair& pair : result.proximity_pairs)
      constraints.push_back(constraint_of(scene, pair, id));

    const std::vector<Vec3d> from = cloth.positions;
    constexpr double seconds = frame_seconds / substeps;
    for (int substep = 0; substep < substeps; ++substep) {
      cloth.before = cloth.positions;
      for (std::size_t v = 0; v < cloth.positions.size(); ++v)
        cloth.positions[v] += seconds * (cloth.velocities[v] + seconds * Vec3d{0, gravity, 0});
      keep_lengths(cloth, seconds);
      for (const Constraint& c : constraints) keep_apart(c, cloth);
      for (std::size_t v = 0; v < cloth.positions.size(); ++v)
        cloth.velocities[v] = (cloth.positions[v] - cloth.before[v]) * ((1 - damping * seconds) / seconds);
    }

    double farthest = 0, part = 1;
    for (std::size_t v = 0; v < from.size(); ++v)
      farthest = std::max(farthest, norm(cloth.positions[v] - from[v]));
    if (farthest >= margin) {
      begin = now();
      scene.set_motion(id, from, cloth.positions);
      part = scene.collision_free_step({.keep = 0.2}).step;
      in_supple += now() - begin;
      for (std::size_t v = 0; part < 1 && v < from.size(); ++v) {
        cloth.positions[v] = from[v] + part * (cloth.positions[v] - from[v]);
        cloth.velocities[v] = (cloth.positions[v] - from[v]) / frame_seconds;
      }
    }
    if (frame % 10 == 0)
      std::printf("frame %d: %zu constraints, moves up to %.4f m, goes %.0f %% of the way\n", frame,
                  constraints.size(), farthest, 100 * part);
  }
  std::printf("%.0f %% of %.2f s were spent in Supple\n", 100 * in_supple / (now() - start), now() - start);

  // The proof: no triangle of the cloth intersects the rabbit or the cloth.
  scene.set_positions(id, cloth.positions);
  const std::size_t cut = scene.detect({.contacts = supple::ContactKinds::intersection}).contacts.size();
  std::printf("%zu pairs of triangles intersect\n", cut);
  return cut == 0 ? 0 : 1;
}
