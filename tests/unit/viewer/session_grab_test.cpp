#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "../../support/viewer_page.hpp"

namespace supple::viewer::session_grab_test {

/// The vertex with the largest x.
std::uint32_t foremost(const TriangleMesh& mesh) {
  const auto less = [](const Vec3d& a, const Vec3d& b) { return a.x < b.x; };
  return static_cast<std::uint32_t>(std::max_element(mesh.positions.begin(), mesh.positions.end(), less) -
                                    mesh.positions.begin());
}

std::vector<Vec3f> positions(const ViewerMessage& frame, std::uint32_t object) {
  return frame.values<Vec3f>(32, object);
}

/// Two balls of radius 1 with a gap of 0.5; the left one has the given motion.
SceneView apart(decltype(ViewedObject::motion) motion = {}, std::uint32_t frequency = 8) {
  SceneView show;
  show.objects = {test_ball("left", {}, frequency), test_ball("right", {2.5, 0, 0}, frequency)};
  show.objects[0].motion = std::move(motion);
  return show;
}

/// A point inside the right ball, in the page's coordinates.
Json inside_right(const ViewerMessage& scene, double further = 0) {
  const Vec3d p = Vec3d{1.8 + further, 0, 0} - center_of(scene);
  return {p.x, p.y, p.z};
}

double distance(Vec3f a, Vec3f b) {
  return std::hypot(a.x - b.x, a.y - b.y, a.z - b.z);
}

TEST(ViewerGrab, AnObjectWithoutMotionIsBentSmoothlyAndTouchesAtOnce) {
  const SceneView show = apart();
  TestPage page(show);
  const ViewerMessage scene = page.scene();
  const ViewerMessage before = page.frame();
  EXPECT_EQ(count_of(before, "contacts"), 0u);
  const std::uint32_t vertex = foremost(show.objects[0].mesh);
  page.ask({{"do", "grab"}, {"object", 0}, {"vertex", vertex}, {"radius", 0.6}});
  page.ask({{"do", "drag"}, {"to", inside_right(scene, 0.1)}});
  page.ask({{"do", "drag"}, {"to", inside_right(scene)}});
  page.session.advance(0);
  const ViewerMessage bent = page.frame();
  EXPECT_EQ(bent.json["playing"], false);
  EXPECT_EQ(bent.json["step"], 0);
  EXPECT_GT(count_of(bent, "contacts"), 0u);
  EXPECT_EQ(bent.values<StepPair>(44), (std::vector<StepPair>{{0, 0, 1}}));
  EXPECT_FALSE(bent.has(32, 1));

  const auto from = positions(before, 0), to = positions(bent, 0);
  const Vec3f target = as_floats(std::array{Vec3d{1.8, 0, 0}}, center_of(scene))[0];
  EXPECT_LT(distance(to[vertex], target), 1e-6);
  const Vec3d held = show.objects[0].mesh.positions[vertex];
  for (std::size_t i = 0; i < to.size(); ++i) {
    const Vec3d p = show.objects[0].mesh.positions[i] - held;
    const double r = std::hypot(p.x, p.y, p.z) / 0.6, falloff = r < 1 ? (1 - r * r) * (1 - r * r) : 0;
    EXPECT_NEAR(distance(from[i], to[i]), falloff * distance(from[vertex], target), 1e-5);
  }

  page.ask({{"do", "release"}});
  page.session.advance(0);
  const ViewerMessage released = page.frame();
  EXPECT_FALSE(released.has(32, 0)) << "it stays bent";
  EXPECT_EQ(count_of(released, "contacts"), count_of(bent, "contacts"));
  EXPECT_EQ(count_of(page.frame_after_steps(2), "contacts"), count_of(bent, "contacts"));
  // A second grab continues from the bent shape.
  page.ask({{"do", "grab"}, {"object", 0}, {"vertex", vertex}, {"radius", 0.6}});
  page.ask({{"do", "drag"}, {"to", inside_right(scene)}});
  page.session.advance(0);
  EXPECT_LT(distance(positions(page.frame(), 0)[vertex], target), 1e-6);
  page.say({{"do", "reset"}});
  page.scene();
  EXPECT_EQ(positions(page.frame(), 0), from);
}

TEST(ViewerGrab, ABentObjectIsExplainedWhereItIs) {
  const SceneView show = apart();
  TestPage page(show);
  const ViewerMessage scene = page.scene();
  page.ask({{"do", "grab"}, {"object", 0}, {"vertex", foremost(show.objects[0].mesh)}});
  page.ask({{"do", "drag"}, {"to", inside_right(scene)}});
  EXPECT_NE(page.ask({{"do", "explain"}, {"a", {0, 0}}, {"b", {1, 0}}})["stage"], "contact");
  page.session.advance(0);
  const auto contacts = contacts_in(page.frame());
  ASSERT_FALSE(contacts.empty());
  for (const auto& c : contacts)
    EXPECT_EQ(page.ask({{"do", "explain"}, {"a", {c[0], c[1]}}, {"b", {c[2], c[3]}}})["stage"], "contact");
}

TEST(ViewerMeasure, FindsTheNearestPointsOfTwoObjectsWhereTheyAre) {
  const SceneView show = apart();
  TestPage page(show);
  const ViewerMessage message = page.scene();
  Scene scene;
  for (const ViewedObject& object : show.objects) scene.add(object.mesh);
  const auto expected = scene.distance({0, 0}, {1, 0});
  const Json answer = page.ask({{"do", "measure"}, {"a", 1}, {"b", 0}});
  EXPECT_EQ(answer["distance"], expected->distance);
  const auto point = [&](int i) {
    return Vec3d{answer["points"][i][0], answer["points"][i][1], answer["points"][i][2]};
  };
  const Vec3d way = point(1) - point(0);
  EXPECT_NEAR(std::hypot(way.x, way.y, way.z), expected->distance, 1e-12);
  EXPECT_TRUE(page.ask({{"do", "measure"}, {"a", 1}, {"b", 1}})["distance"].is_null());
  page.ask({{"do", "grab"}, {"object", 0}, {"vertex", foremost(show.objects[0].mesh)}});
  page.ask({{"do", "drag"}, {"to", inside_right(message)}});
  page.session.advance(0);
  EXPECT_EQ(page.ask({{"do", "measure"}, {"a", 0}, {"b", 1}})["distance"], 0) << "they touch";
  EXPECT_NE(page.failure(R"({"do": "measure", "id": 1, "a": 0, "b": 9})").find("no object 9"),
            std::string::npos);
}

TEST(ViewerGrab, ARigidObjectFollowsAsAWhole) {
  const SceneView show = apart(RigidMotion{.velocity = {-0.5, 0, 0}});
  TestPage page(show);
  const ViewerMessage scene = page.scene();
  EXPECT_EQ(scene.json["objects"][0]["rigid"], true);
  EXPECT_EQ(scene.json["objects"][1]["rigid"], false);
  const auto from = positions(page.frame(), 0);
  const std::uint32_t vertex = foremost(show.objects[0].mesh);
  page.ask({{"do", "grab"}, {"object", 0}, {"vertex", vertex}});
  page.ask({{"do", "drag"}, {"to", inside_right(scene)}});
  page.session.advance(0);
  const ViewerMessage carried = page.frame();
  EXPECT_EQ(carried.json["step"], 0) << "it needs no step";
  EXPECT_GT(count_of(carried, "contacts"), 0u);
  const Vec3f target = as_floats(std::array{Vec3d{1.8, 0, 0}}, center_of(scene))[0];
  const auto to = positions(carried, 0);
  for (std::size_t i = 0; i < to.size(); ++i)
    EXPECT_LT(distance(to[i], from[i] + target - from[vertex]), 1e-5);

  // It stays in the hand while time passes, and then flies on from there.
  const float step = 0.5f * 0.01f;
  const auto later = positions(page.frame_after_steps(5), 0);
  EXPECT_NEAR(later[vertex].x, target.x - step, 1e-5);
  page.ask({{"do", "release"}});
  const auto released = positions(page.frame_after_steps(10), 0);
  EXPECT_NEAR(released[vertex].x, target.x - 11 * step, 1e-5);
}

TEST(ViewerGrab, AnObjectInWavesIsBentOnTopOfThem) {
  const SceneView show = apart(WaveMotion{.amplitude = 0.02});
  TestPage page(show);
  const ViewerMessage scene = page.scene();
  page.ask({{"do", "pause"}});
  page.frame();
  const std::uint32_t vertex = foremost(show.objects[0].mesh);
  page.ask({{"do", "grab"}, {"object", 0}, {"vertex", vertex}});
  page.session.advance(1);
  EXPECT_EQ(page.frame().json["step"], 0) << "grabbed, but not dragged";
  page.ask({{"do", "drag"}, {"to", inside_right(scene)}});
  const Vec3f target = as_floats(std::array{Vec3d{1.8, 0, 0}}, center_of(scene))[0];
  for (int step = 1; step <= 5; ++step) {
    page.session.advance(0.01);  // playback is paused, but steps are needed to show the motion
    const ViewerMessage frame = page.frame();
    EXPECT_EQ(frame.json["step"], step);
    EXPECT_LT(distance(positions(frame, 0)[vertex], target), 1e-6);
    EXPECT_GT(count_of(frame, "contacts"), 0u);
  }
  page.ask({{"do", "release"}});
  page.session.advance(0.01);
  EXPECT_EQ(page.frame().json["step"], 5);
  // The bend remains while the object waves again: it differs from an untouched copy by a constant offset.
  Simulation free = simulation_of(show);
  for (int i = 0; i < 5; ++i) free.step();
  std::optional<Vec3d> offset;
  for (int i = 0; i < 20; ++i) {
    free.step();
    const auto now = positions(page.frame_after_steps(1), 0);
    const Vec3f waving = as_floats(free.positions({0, 0}), center_of(scene))[vertex];
    const Vec3d bend{now[vertex].x - waving.x, now[vertex].y - waving.y, now[vertex].z - waving.z};
    if (!offset) offset = bend;
    EXPECT_GT(bend.x, 0.5);
    EXPECT_NEAR(bend.x, offset->x, 1e-5);
    EXPECT_NEAR(bend.y, offset->y, 1e-5);
  }
}

/// Materials from slack to the stiffest that the step allows; the implicit integrator allows stiffer ones.
std::vector<MassSpringMotion> materials() {
  std::vector<MassSpringMotion> materials;
  for (const Integrator integrator :
       {Integrator::verlet, Integrator::symplectic_euler, Integrator::backward_euler}) {
    for (const double stiffness : {0.0, 50.0, 800.0}) {
      if (integrator == Integrator::backward_euler && stiffness != 50) continue;
      MassSpringMotion motion;
      motion.springs.integrator = integrator;
      motion.springs.stiffness = stiffness;
      motion.springs.damping = 0.1;
      materials.push_back(motion);
    }
  }
  MassSpringMotion stiff;
  stiff.springs = {.integrator = Integrator::backward_euler,
                   .vertex_mass = 0.01,
                   .stiffness = 1e4,
                   .damping = 1,
                   .bending_stiffness = 1e3,
                   .volume_stiffness = 60};
  materials.push_back(stiff);
  return materials;
}

TEST(ViewerGrab, ABodyIsPulledIntoContactAndHeldThere) {
  for (const MassSpringMotion& motion : materials()) {
    const SceneView show = apart(motion, 4);
    SCOPED_TRACE(std::to_string(static_cast<int>(motion.springs.integrator)) + " " +
                 std::to_string(motion.springs.stiffness));
    TestPage page(show);
    const ViewerMessage scene = page.scene();
    page.ask({{"do", "pause"}});
    page.frame();
    const std::uint32_t vertex = foremost(show.objects[0].mesh);
    page.ask({{"do", "grab"}, {"object", 0}, {"vertex", vertex}});
    page.ask({{"do", "drag"}, {"to", inside_right(scene)}});
    const Vec3f target = as_floats(std::array{Vec3d{1.8, 0, 0}}, center_of(scene))[0];
    // A shell without bending stiffness turns inside out around the grabbed vertex and ends inside the other
    // ball, so contacts occur only on the way.
    std::uint32_t contacts = 0;
    for (int i = 0; i < 240; ++i) {
      page.session.advance(0.01);
      if (i % 10 == 0) contacts = std::max(contacts, count_of(page.frame(), "contacts"));
    }
    page.session.advance(0.01);
    const ViewerMessage pulled = page.frame();
    EXPECT_EQ(pulled.json["step"], 241);
    EXPECT_GT(contacts, 0u);
    EXPECT_LT(distance(positions(pulled, 0)[vertex], target), 0.1);
    page.ask({{"do", "release"}});
    page.session.advance(0.01);
    EXPECT_EQ(page.frame().json["step"], 241) << "after the release the session is paused again";
    EXPECT_NO_THROW(page.frame_after_steps(100));
  }
}

TEST(ViewerGrab, NoDragMakesABodyExplode) {
  for (const MassSpringMotion& motion : materials()) {
    SCOPED_TRACE(std::to_string(static_cast<int>(motion.springs.integrator)) + " " +
                 std::to_string(motion.springs.stiffness));
    const SceneView show = apart(motion, 4);
    TestPage page(show);
    page.scene();
    page.frame();
    page.ask({{"do", "speed"}, {"factor", 0}});
    page.ask({{"do", "grab"}, {"object", 0}, {"vertex", foremost(show.objects[0].mesh)}});
    for (int i = 0; i < 200; ++i) {
      const double far = i % 7 == 0 ? 1e6 : i % 3 == 0 ? -40 : 3;
      page.say({{"do", "drag"}, {"to", {far, i % 2 == 0 ? far : -far, 1.0 * i}}});
      page.session.advance(0.01);
      ASSERT_TRUE(page.drain().empty()) << "step " << i;
    }
    page.ask({{"do", "release"}});
    for (int i = 0; i < 100; ++i) page.session.advance(0.01);
    const ViewerMessage frame = page.frame();
    EXPECT_EQ(frame.json["playing"], true);
    EXPECT_EQ(frame.json["step"], 300);
    for (const Vec3f& p : positions(frame, 0)) ASSERT_LT(std::hypot(p.x, p.y, p.z), 1e3);
  }
}

/// The block of `scenes/soft_block.toml`: its bottom is fixed and its top is pulled.
SceneView soft_block() {
  SceneView show;
  ViewedObject block{make_box({2, 1, 2}, 8), {.name = "block", .self_collision = true}};
  MassSpringMotion motion;
  motion.springs = {.integrator = Integrator::backward_euler,
                    .vertex_mass = 0.01,
                    .stiffness = 100,
                    .damping = 1,
                    .air_friction = 0.02,
                    .bending_stiffness = 50,
                    .volume_stiffness = 60};
  for (std::uint32_t i = 0; i < block.mesh.positions.size(); ++i) {
    const Vec3d& p = block.mesh.positions[i];
    if (p.y == -0.5) motion.springs.fixed_vertices.push_back(i);
    if (p.y == 0.5 && std::fabs(p.x) < 0.25 && std::fabs(p.z) < 0.25) {
      if (motion.handles.empty()) motion.handles.push_back({.by = {0.3, 0.6, 0}, .seconds = 2});
      motion.handles[0].vertices.push_back(i);
    }
  }
  block.motion = std::move(motion);
  show.objects = {std::move(block), test_ball("tool", {1.6, 1.2, 0})};
  return show;
}

TEST(ViewerGrab, FixedVerticesStayWhereTheyAreHeld) {
  const SceneView show = soft_block();
  const TriangleMesh& mesh = show.objects[0].mesh;
  const auto& motion = std::get<MassSpringMotion>(show.objects[0].motion);
  TestPage page(show);
  const ViewerMessage scene = page.scene();
  for (const std::uint32_t fixed : {motion.springs.fixed_vertices[0], motion.handles[0].vertices[0]}) {
    EXPECT_EQ(page.failure("{\"do\": \"grab\", \"object\": 0, \"vertex\": " + std::to_string(fixed) + "}"),
              "grab: vertex " + std::to_string(fixed) + " of block is fixed; choose another one");
  }
  const std::uint32_t vertex = foremost(mesh) + 0;
  std::uint32_t corner = vertex;
  for (std::uint32_t i = 0; i < mesh.positions.size(); ++i)
    if (mesh.positions[i].x == 1 && mesh.positions[i].y == 0.5) corner = i;
  const ViewerMessage before = page.frame();
  page.ask({{"do", "grab"}, {"object", 0}, {"vertex", corner}});
  const Vec3d to = mesh.positions[corner] + Vec3d{0.6, 0.4, 0} - center_of(scene);
  page.ask({{"do", "drag"}, {"to", {to.x, to.y, to.z}}});
  page.ask({{"do", "speed"}, {"factor", 0}});
  std::size_t contacts = 0;
  for (int i = 0; i < 250; ++i) {
    page.session.advance(0.01);
    if (i % 25 == 24) contacts = std::max<std::size_t>(contacts, count_of(page.frame(), "contacts"));
  }
  EXPECT_GT(contacts, 0u) << "the pulled corner touches the tool";
  const ViewerMessage frame = page.frame_after_steps(1);
  for (const std::uint32_t fixed : motion.springs.fixed_vertices)
    EXPECT_EQ(positions(frame, 0)[fixed], positions(before, 0)[fixed]);
  for (const std::uint32_t held : motion.handles[0].vertices) {
    const Vec3f p = as_floats(std::array{mesh.positions[held] + Vec3d{0.3, 0.6, 0}}, center_of(scene))[0];
    EXPECT_LT(distance(positions(frame, 0)[held], p), 1e-5);
  }
}

TEST(ViewerGrab, StaticObjectsAndRecordingsAreRefusedInWords) {
  SceneView show = apart();
  show.objects[0].options.is_static = true;
  TestPage page(show);
  page.scene();
  EXPECT_EQ(page.failure(R"({"do": "grab", "object": 0, "vertex": 0})"),
            "grab: left is static: it cannot be moved or bent");
  page.ask({{"do", "grab"}, {"object", 1}, {"vertex", 0}});
  EXPECT_FALSE(page.failure(R"({"do": "grab", "object": 0, "vertex": 0})").empty());
  EXPECT_FALSE(page.failure(R"({"do": "drag", "to": [0, 0, 0]})").empty()) << "the failed grab released it";
}

TEST(ViewerGrab, ReleasedByItselfWhenThePageGoes) {
  TestPage page(apart());
  page.scene();
  page.ask({{"do", "grab"}, {"object", 0}, {"vertex", 0}});
  page.session.greet();
  page.scene();
  EXPECT_FALSE(page.failure(R"({"do": "drag", "to": [0, 0, 0]})").empty());
}

TEST(ViewerGrab, ContinuousContactsSeeWhereAThingWasBentTo) {
  SceneView show = apart();
  show.simulation.scene.contacts = ContactKinds::continuous;
  TestPage page(show);
  const ViewerMessage scene = page.scene();
  page.ask({{"do", "grab"}, {"object", 0}, {"vertex", foremost(show.objects[0].mesh)}});
  page.ask({{"do", "drag"}, {"to", inside_right(scene)}});
  page.session.advance(0);
  const ViewerMessage frame = page.frame();
  EXPECT_GT(count_of(frame, "continuous_contacts"), 0u);
  EXPECT_TRUE(frame.has(32, 0));
}

}  // namespace supple::viewer::session_grab_test
