#pragma once

#include <bit>
#include <cstdint>
#include <span>
#include <vector>

#include "supple/models.hpp"
#include "supple/motion.hpp"
#include "supple/simulation.hpp"
#include "supple/wave_motion.hpp"
#include "support/bodies.hpp"
#include "support/golden_hash.hpp"
#include "support/scenes.hpp"

namespace supple {

inline std::uint64_t hash_of(std::span<const Vec3d> vectors, std::uint64_t hash) {
  for (const Vec3d& v : vectors) {
    for (int axis = 0; axis < 3; ++axis) hash = hash_of_word(std::bit_cast<std::uint64_t>(v[axis]), hash);
  }
  return hash;
}

inline std::uint64_t hash_of(const MassSpringBody& body, std::uint64_t hash) {
  hash = hash_of(body.velocities(), hash_of(body.positions(), hash));
  return hash_of_word(std::bit_cast<std::uint64_t>(body.energy().total()), hash);
}

/// Some steps of a body that starts deformed and drifts.
inline std::uint64_t hash_of_run(const TriangleMesh& mesh, const MassSpringOptions& options, int steps) {
  MassSpringBody body(mesh, options);
  body.set_positions(deformed(mesh, 0.15, 0.0002, 21));
  body.add_drift({0.5, 0, 0});
  for (int i = 0; i < steps; ++i) body.step(0.01);
  return hash_of(body, empty_hash);
}

/// Every integrator, soft and stiff, with deformation limits and plastic flow.
inline std::uint64_t motion_hash(std::uint32_t threads) {
  const TriangleMesh mesh = make_torus(24, 12);
  std::uint64_t hash = 0;
  for (const Integrator integrator : all_integrators) {
    for (const double stiffness : {50.0, 5000.0}) {
      hash = hash * 31 + hash_of_run(mesh,
                                     {.integrator = integrator,
                                      .substeps = 2,
                                      .stiffness = stiffness,
                                      .air_friction = 0.1,
                                      .bending_stiffness = 5,
                                      .area_stiffness = 20,
                                      .gravity = {0, -1, 0},
                                      .max_strain = 0.1,
                                      .yield_strain = 0.05,
                                      .fixed_vertices = {0},
                                      .threads = threads},
                                     4);
    }
  }
  return hash;
}

/// Closed bodies of several pieces whose volume is preserved, by every integrator.
inline std::uint64_t piece_hash(std::uint32_t threads) {
  std::uint64_t hash = empty_hash;
  for (const Integrator integrator : all_integrators) {
    hash = hash_of_word(hash_of_run(make_model("fish"),
                                    {.integrator = integrator,
                                     .substeps = 2,
                                     .stiffness = 200,
                                     .rest_length = 0.98,
                                     .connect_pieces = true,
                                     .volume_stiffness = 500,
                                     .threads = threads},
                                    4),
                        hash);
  }
  return hash;
}

inline TriangleMesh placed(TriangleMesh mesh, double size, Vec3d at) {
  for (Vec3d& p : mesh.positions) p = size * p + at;
  return mesh;
}

/// A body that random forces deform before it flies, one that is pulled by a handle, a rigid object that
/// turns, and one with waves meet in a narrow room, with contact response. Covers positions, contacts and
/// proximity.
inline std::uint64_t simulation_hash(std::uint32_t threads) {
  const Border room{{{-0.6, -0.6, -0.6}, {0.6, 0.6, 0.6}}};
  SimulationOptions options{.time_step = 0.005, .border = room, .seed = 5};
  options.scene.threads = threads;
  options.scene.contacts = ContactKinds::intersection | ContactKinds::continuous | ContactKinds::proximity;
  options.response = ContactResponse{.thickness = 0.01, .restitution = 0.2, .friction = 0.3};
  Simulation simulation(options);

  MassSpringMotion flying;
  flying.springs.vertex_mass = 0.01;
  flying.springs.threads = threads;
  flying.velocity = {-2, 0, 0};
  flying.random_speed = 0.5;
  flying.random_force = 0.1;
  flying.deform_seconds = 0.02;
  simulation.add(placed(make_model("pawn"), 0.5, {0.3, 0.1, 0}), {.self_collision = true}, flying);

  MassSpringMotion pulled;
  pulled.springs = {.integrator = Integrator::backward_euler,
                    .vertex_mass = 0.01,
                    .bending_stiffness = 5,
                    .gravity = {0, -9.81, 0},
                    .threads = threads};
  pulled.handles = {{.vertices = {0, 8}, .by = {0.1, 0.1, 0}, .seconds = 0.05}};
  simulation.add(placed(make_cloth(8, 8), 0.8, {0, -0.2, 0}), {.self_collision = true}, pulled);

  RigidMotion turning;
  turning.velocity = {2, -1, 0};
  turning.random_spin = 360;
  simulation.add(placed(make_model("rabbit"), 0.4, {-0.3, 0.1, 0}), {}, turning);

  const TriangleMesh ball = placed(make_icosphere(3), 0.15, {0, -0.4, 0.1});
  const WaveMotion waves{
      .velocity = {0, 1, 0}, .amplitude = 0.02, .wavelength = 0.3, .period = 0.1, .seed = 7};
  simulation.add(ball, {}, [&](double seconds, std::span<Vec3d> positions) {
    apply_wave_motion(waves, room, ball.positions, seconds, positions);
  });

  std::uint64_t hash = empty_hash;
  for (int step = 0; step < 24; ++step) {
    const DetectResult& result = simulation.step();
    hash = hash_of_proximity(result.proximity_pairs, hash_of(result, hash));
    for (const ObjectId object : simulation.scene().objects())
      hash = hash_of(simulation.positions(object), hash);
  }
  return hash;
}

/// They change only with the arithmetic of a step; record the change in the changelog.
constexpr GoldenHash golden_motion_hashes[] = {{"motion", motion_hash, 10756507334953599675u},
                                               {"pieces", piece_hash, 3951911235730136532u},
                                               {"simulation", simulation_hash, 16492525214828970067u}};

}  // namespace supple
