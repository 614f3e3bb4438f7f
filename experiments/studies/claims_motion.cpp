#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "studies/shape_pair.hpp"
#include "studies/studies.hpp"
#include "supple/models.hpp"
#include "supple/motion.hpp"
#include "supple/scene.hpp"
#include "supple/simulation_descriptions.hpp"
#include "table1/table1_runs.hpp"
#include "table1/table1_scenes.hpp"
#include "work.hpp"

namespace supple::experiments {
namespace {

/// A body that vibrates: every vertex gets a velocity.
MassSpringBody vibrating(const TriangleMesh& mesh, Integrator integrator) {
  MassSpringOptions options;
  options.integrator = integrator;
  options.damping = 0;
  options.threads = 1;
  MassSpringBody body(mesh, options);
  std::vector<Vec3d> velocities;
  for (const Vec3d& p : mesh.positions) velocities.push_back({0.2 * p.y, -0.3 * p.x, 0.1 * p.z});
  body.set_velocities(velocities);
  return body;
}

/// The energy at the end divided by that at the start; nothing when the motion fails or the energy grows
/// tenfold.
std::optional<double> energy_kept(MassSpringBody body, double step, double seconds) {
  const double start = body.energy().total();
  const auto steps = static_cast<std::uint64_t>(std::ceil(seconds / step));
  for (std::uint64_t i = 0; i < steps; ++i) {
    if (body.try_step(step)) return std::nullopt;
    if (!(body.energy().total() < 10 * start)) return std::nullopt;
  }
  return body.energy().total() / start;
}

}  // namespace

/// Section 5.2: the translation is added to the box.
Table translation_of_volumes(const ClaimsOptions& options) {
  const TriangleMesh mesh = make_icosphere(options.largest_frequency);
  Scene scene({.contacts = ContactKinds::none, .threads = 1});
  const ObjectId id = scene.add(mesh);
  scene.detect();
  std::vector<Vec3d> positions = mesh.positions;
  Table table{"claims_translation", {"update", "round", "seconds", "triangles"}};
  for (int round = 1; round <= options.rounds; ++round) {
    const auto add = [&](const char* update) {
      const TimedDetection detection(scene);
      table.add({std::string(update), static_cast<std::uint64_t>(round), detection.refit,
                 detection.result->stats.triangles_refitted});
    };
    scene.translate(id, {0.01, 0, 0});
    add("translation");
    for (std::size_t i = 0; i < positions.size(); ++i) positions[i] = mesh.positions[i] * (1 + 0.01 * round);
    scene.set_positions(id, positions);
    add("refit");
  }
  return table;
}

/// Section 5.2: the boxes of the bodies of table1_9 are made in the loop of the motion, or in one of their
/// own.
Table loops(const ClaimsOptions& options) {
  Table table{"claims_loops", {"loops", "round", "seconds"}};
  std::vector<Simulation> simulations;
  for (const bool fused : {true, false}) {
    Variant variant{{}, BoundingVolume::aabb};
    variant.method.scene.contacts = ContactKinds::none;
    variant.method.fused_refit = fused;
    cli::Input input = read_scene(mixed_scene(9), {}, options.seed);
    simulations.push_back(build_variant(input, variant));
  }
  constexpr int steps = 100;
  for (int round = 0; round < options.rounds; ++round) {
    for (std::size_t i = 0; i < simulations.size(); ++i) {
      const double seconds = seconds_of([&] {
        for (int step = 0; step < steps; ++step) simulations[i].step();
      });
      table.add({std::uint64_t{i + 1}, static_cast<std::uint64_t>(round), seconds / steps});
    }
  }
  return table;
}

/// Section 7: a step of each model.
Table steps_of_models(const ClaimsOptions& options) {
  Table table{"claims_motion", {"model", "vertices", "round", "seconds"}};
  for (const char* const model : models) {
    MassSpringBody body = vibrating(make_model(model), Integrator::verlet);
    const double step = body.stable_step() / 2;
    constexpr int steps = 20;
    for (int round = 0; round < options.rounds; ++round) {
      const double seconds = seconds_of([&] {
        for (int i = 0; i < steps; ++i) body.step(step);
      });
      table.add({std::string(model), std::uint64_t{body.vertex_count()}, static_cast<std::uint64_t>(round),
                 seconds / steps});
    }
  }
  return table;
}

/// Section 4: the energy of a rabbit without damping, by integrator and step.
Table energies_of_integrators(const ClaimsOptions& options) {
  Table table{"claims_integrators", {"integrator", "seconds_of_step", "of_stable_step", "energy_kept"}};
  constexpr std::array parts{0.5, 1.0, 2.0, 4.0, 8.0, 16.0};
  const TriangleMesh mesh = make_model("rabbit");
  const double stable = vibrating(mesh, Integrator::verlet).stable_step();
  for (std::size_t k = 0; k < words<Integrator>.size(); ++k) {
    for (const double part : parts) {
      const auto kept =
          energy_kept(vibrating(mesh, static_cast<Integrator>(k)), part * stable, options.motion_seconds);
      table.add(
          {std::string(words<Integrator>[k]), part * stable, part, kept ? Cell(*kept) : Cell("unstable")});
    }
  }
  return table;
}

/// Section 4: how far areas change and edges are strained in the scenes of section 7, with the force that
/// preserves areas and without it.
Table areas_and_strains(const ClaimsOptions& options) {
  Table table{"claims_areas",
              {"scene", "preserved", "seconds", "mean_area_error", "mean_strain", "largest_strain"}};
  for (const Table1Scene& scene :
       {mixed_scene(3), mixed_scene(9), built_in_scene("three_humans"), built_in_scene("three_bikes")}) {
    for (const bool preserved : {true, false}) {
      cli::Input input = read_scene(scene, {}, options.seed);
      for (cli::InputObject& object : input.objects) {
        if (auto& springs = std::get<MassSpringMotion>(*object.motion).springs; !preserved)
          springs.area_stiffness = 0;
      }
      Variant variant{{}, BoundingVolume::aabb};
      variant.method.scene.contacts = ContactKinds::none;
      Simulation simulation = build_variant(input, variant);
      double error = 0, mean = 0, largest = 0, samples = 0;
      while (simulation.time() < options.motion_seconds) {
        simulation.step();
        if (simulation.step_count() % strain_every != 0) continue;
        for (const ObjectId id : simulation.scene().objects()) {
          const EdgeStrain strain = simulation.body(id)->edge_strain();
          error += simulation.body(id)->area_error().mean;
          mean += strain.mean;
          largest = std::max(largest, strain.largest);
          ++samples;
        }
      }
      table.add({scene.name, std::string(preserved ? "yes" : "no"), options.motion_seconds, error / samples,
                 mean / samples, largest});
    }
  }
  return table;
}

}  // namespace supple::experiments
