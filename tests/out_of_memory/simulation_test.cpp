// A simulation in which an allocation fails can be destroyed, leaks nothing, and leaves no traces in others.

#include <gtest/gtest.h>

#include <optional>
#include <vector>

#include "every_allocation.hpp"
#include "supple/models.hpp"
#include "supple/simulation.hpp"

namespace supple::simulation_test {

TriangleMesh ball(Vec3d at) {
  TriangleMesh mesh = make_icosphere(2);
  for (Vec3d& p : mesh.positions) p = p + at;
  return mesh;
}

/// Adds objects of all kinds of motion and takes some steps. Returns the positions of all steps.
std::vector<double> run(std::optional<Simulation>& simulation, const SimulationOptions& options,
                        Integrator integrator) {
  std::vector<double> log;
  simulation.emplace(options);
  MassSpringMotion soft;
  soft.springs.integrator = integrator;
  soft.springs.stiffness = 10;
  soft.springs.yield_strain = 0.3;
  soft.random_force = 0.1;
  soft.deform_seconds = 0.015;
  soft.velocity = {5, 0, 0};
  std::vector<ObjectId> ids{simulation->add(ball({}), {}, soft)};
  ids.push_back(
      simulation->add(ball({2.3, 0, 0}), {}, RigidMotion{.velocity = {-5, 0, 0}, .spin = {0, 90, 0}}));
  ids.push_back(simulation->add(ball({0, 2.2, 0}), {}, [](double seconds, std::span<Vec3d> positions) {
    for (Vec3d& p : positions) p.y -= seconds;
  }));
  ids.push_back(simulation->add(ball({0, 0, 2.1}), {}));
  simulation->detect();
  for (int step = 0; step < 5; ++step) {
    const DetectResult& result = simulation->step();
    log.push_back(static_cast<double>(result.contacts.size()));
    log.push_back(static_cast<double>(result.contact_events.begin.size()));
    for (const ObjectId id : ids) {
      for (const Vec3d& p : simulation->positions(id)) log.insert(log.end(), {p.x, p.y, p.z});
    }
  }
  simulation->remove(ids[0]);
  simulation->detect();
  return log;
}

void expect_clean_end(const SimulationOptions& options, Integrator integrator) {
  std::optional<Simulation> simulation;
  const std::vector<double> undisturbed = run(simulation, options, integrator);
  simulation.reset();
  refuse_every_allocation([&](Refusal& refusal) {
    std::vector<double> log;
    std::optional<Simulation> disturbed;
    const bool is_out = refusal.strikes([&] { log = run(disturbed, options, integrator); });
    EXPECT_TRUE(is_out || log == undisturbed);
    EXPECT_TRUE(!disturbed || disturbed->step_count() <= 5u);
    disturbed.reset();
    EXPECT_EQ(run(disturbed, options, integrator), undisturbed);
  });
}

TEST(SimulationOutOfMemory, CanBeDestroyed) {
  for (const Integrator integrator : {Integrator::verlet, Integrator::backward_euler}) {
    SCOPED_TRACE(static_cast<int>(integrator));
    expect_clean_end({.scene = {.threads = 1}}, integrator);
  }
}

TEST(SimulationOutOfMemory, CanBeDestroyedWithAResponse) {
  const SceneOptions scene{.contacts = ContactKinds::intersection | ContactKinds::continuous, .threads = 1};
  expect_clean_end({.scene = scene,
                    .border = Border{{{-3, -3, -3}, {3, 3, 3}}},
                    .response = ContactResponse{.thickness = 0.05}},
                   Integrator::verlet);
}

}  // namespace supple::simulation_test
