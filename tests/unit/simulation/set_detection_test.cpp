// `Simulation::set_detection`: other options of the detection, while the motion goes on.

#include <gtest/gtest.h>

#include <span>
#include <string>
#include <vector>

#include "supple/models.hpp"
#include "supple/simulation.hpp"
#include "supple/verify.hpp"
#include "support/scenes.hpp"

namespace supple::set_detection_test {

TriangleMesh ball(Vec3d at) {
  TriangleMesh mesh = make_icosphere(3);
  for (Vec3d& p : mesh.positions) p = 0.3 * p + at;
  return mesh;
}

/// An object of each kind of motion, and a static one, in a room.
struct Room {
  std::vector<SceneObject> objects;
  std::vector<TriangleMesh> meshes{ball({}), ball({0.5, 0, 0}), ball({-0.5, 0, 0}), ball({0, 0.5, 0}),
                                   ball({0, -0.5, 0.1})};
  Simulation simulation;

  explicit Room(const SceneOptions& scene, bool responds = false) : simulation(options(scene, responds)) {
    MassSpringMotion springy;
    springy.springs.vertex_mass = 0.1;
    springy.springs.stiffness = 50;
    springy.random_speed = 1;
    springy.random_force = 0.5;
    springy.force_change_seconds = 0.1;
    for (const TriangleMesh& mesh : meshes) objects.push_back({&mesh, {.margin = 0.01}});
    objects[4].options.is_static = true;
    simulation.add(meshes[0], objects[0].options, springy);
    simulation.add(meshes[1], objects[1].options, RigidMotion{.velocity = {-1, 0.3, 0}, .spin = {20, 90, 0}});
    simulation.add(meshes[2], objects[2].options, RigidMotion{.velocity = {1, 0.1, 0}});
    simulation.add(meshes[3], objects[3].options, [](double, std::span<Vec3d> positions) {
      for (Vec3d& p : positions) p.y -= 0.004;
    });
    simulation.add(meshes[4], objects[4].options);
  }

  static SimulationOptions options(const SceneOptions& scene, bool responds) {
    SimulationOptions options{.scene = scene, .border = Border{{{-1, -1, -1}, {1, 1, 1}}}, .seed = 3};
    if (responds) options.response = ContactResponse{.thickness = 0.005};
    return options;
  }
};

TEST(SetDetection, TheMotionGoesOnAndTheContactsAreThoseOfTheNewOptions) {
  const SceneOptions before{};
  SceneOptions after{.bounding_volume = BoundingVolume::sphere, .broad_phase = BroadPhaseMethod::sweep};
  after.contacts = ContactKinds::intersection | ContactKinds::continuous;
  for (const auto& [from, to] : {std::pair(before, after), std::pair(after, before)}) {
    Room changed(from), expected(to), unchanged(from);
    for (int step = 0; step < 40; ++step) {
      changed.simulation.step();
      expected.simulation.step();
      unchanged.simulation.step();
    }
    const DetectResult& now = changed.simulation.set_detection(to, changed.objects);
    EXPECT_EQ(changed.simulation.step_count(), 40u);
    EXPECT_EQ(now.contacts.size(), unchanged.simulation.scene().result().contacts.size());
    EXPECT_TRUE(now.continuous_contacts.empty()) << "nothing has moved since";
    std::size_t contacts = 0;
    for (int step = 0; step < 60; ++step) {
      EXPECT_EQ(hash_of(changed.simulation.step()), hash_of(expected.simulation.step())) << step;
      contacts += changed.simulation.scene().result().contacts.size();
    }
    EXPECT_GT(contacts, 0u);
    EXPECT_TRUE(verify(changed.simulation.scene()).differences.empty());
  }
}

TEST(SetDetection, AResponseGoesOn) {
  Room changed({}, true), expected({}, true);
  for (int step = 0; step < 60; ++step) {
    changed.simulation.step();
    expected.simulation.step();
    if (step % 20 == 10) changed.simulation.set_detection({}, changed.objects);
  }
  for (const ObjectId id : expected.simulation.scene().objects()) {
    const auto a = changed.simulation.positions(id), b = expected.simulation.positions(id);
    EXPECT_TRUE(std::equal(a.begin(), a.end(), b.begin(), b.end())) << id.index;
  }
}

TEST(SetDetection, AFailureChangesNothing) {
  Room room({});
  for (int step = 0; step < 20; ++step) room.simulation.step();
  const auto hash = hash_of(room.simulation.scene().result());
  EXPECT_THROW(room.simulation.set_detection({.threads = 2000}, room.objects), Error);
  EXPECT_THROW(room.simulation.set_detection({}, std::span(room.objects).first(3)), Error);
  EXPECT_EQ(hash_of(room.simulation.scene().result()), hash);
  EXPECT_NE(room.simulation.options().scene.threads, 2000u);
  room.simulation.remove(room.simulation.scene().objects().front());
  EXPECT_THROW(room.simulation.set_detection({}, room.objects), Error);
}

}  // namespace supple::set_detection_test
