#include <gtest/gtest.h>
#include <malloc.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "../../support/viewer_page.hpp"
#include "session/settings.hpp"

namespace supple::viewer::session_settings_test {

/// The settings that restart, as the scene message describes them.
std::vector<std::string> restarting_settings(const ViewerMessage& scene) {
  std::vector<std::string> keys;
  for (const Json& setting : scene.json["settings"]) {
    if (setting["restarts"]) keys.push_back(setting["key"]);
  }
  return keys;
}

/// After each setting, the step is kept or the restart was announced.
TEST(ViewerSettings, SetChangesEachOptionAndKeepsTheStateOrRestartsAsAnnounced) {
  TestPage page(three_balls());
  const std::vector<std::string> restarting = restarting_settings(page.scene());
  EXPECT_EQ(restarting, (std::vector<std::string>{"objects", "integrator", "time_step"}));
  page.ask({{"do", "pause"}});
  const std::vector<std::pair<std::string, Json>> options{{"bounding_volume", "sphere"},
                                                          {"max_level", 2},
                                                          {"leaf_size", 8},
                                                          {"integrator", "backward_euler"},
                                                          {"integrator", "symplectic_euler"},
                                                          {"broad_phase", "sweep"},
                                                          {"broad_phase", "brute"},
                                                          {"contacts", "continuous"},
                                                          {"contacts", "none"},
                                                          {"objects", 3},
                                                          {"time_step", 0.005}};
  int generation = 1, run = 1;
  for (const auto& [name, value] : options) {
    const ViewerMessage before = page.frame_after_steps(5);
    page.say({{"do", "set"}, {name, value}, {"id", 1}});
    const std::vector<ViewerMessage> messages = page.drain();
    ASSERT_EQ(messages.size(), 2u) << name;
    const bool restarts = std::count(restarting.begin(), restarting.end(), name) > 0;
    const ViewerMessage& scene = messages.front();
    ASSERT_EQ(scene.kind, ViewerMessage::scene);
    if (name != "objects") {
      EXPECT_EQ(scene.json[name], value);
    }
    EXPECT_EQ(scene.json["generation"], ++generation);
    EXPECT_EQ(scene.json["run"], restarts ? ++run : run) << name;
    EXPECT_EQ(messages.back().kind, ViewerMessage::answer);
    const ViewerMessage frame = page.frame();
    EXPECT_EQ(frame.json["step"], restarts ? 0 : before.json["step"].get<int>()) << name;
    EXPECT_EQ(frame.json["playing"], false);
    for (std::uint32_t i = 0; i < 3; ++i) ASSERT_TRUE(frame.has(32, i));
    if (!restarts) {
      EXPECT_EQ(frame.values<Vec3f>(32, 1), before.values<Vec3f>(32, 1)) << name;
    }
  }
  page.say({{"do", "set"}});  // changes nothing
  const ViewerMessage scene = page.scene();
  EXPECT_EQ(scene.json["bounding_volume"], "sphere");
  EXPECT_EQ(scene.json["leaf_size"], 8);
  EXPECT_EQ(scene.json["time_step"], 0.005);
}

TEST(ViewerSettings, OptionsOfTheSceneOctreeNeedAMethodThatHasOne) {
  TestPage page(three_balls());
  page.ask({{"do", "set"}, {"broad_phase", "sweep"}});
  EXPECT_EQ(page.failure(R"({"do": "set", "scene_octree_max_level": 4})"),
            "set: options of the scene octree have no effect with the broad phase sweep; choose automatic or "
            "octree first");
  page.say({{"do", "set"}, {"broad_phase", "octree"}, {"scene_octree_max_level", 4}});
  EXPECT_EQ(page.scene().json["scene_octree_max_level"], 4);
}

/// Options of the detection change nothing of the motion, and find what a scene with these options finds.
TEST(ViewerSettings, AfterASetTheMotionGoesOnAsWithoutIt) {
  SceneView show = three_balls();
  show.objects.push_back(test_ball("rigid", {-2.5, 0, 0}));
  show.objects.back().motion = RigidMotion{.velocity = {1, 0, 0}, .spin = {0, 90, 0}};
  show.objects.push_back(test_ball("drifts", {0, 2.5, 0}));
  show.objects.back().motion = RigidMotion{.velocity = {0, -1, 0}};
  TestPage page(show), other(show);
  const Vec3d center = center_of(page.scene());
  other.scene();
  show.simulation.scene.bounding_volume = BoundingVolume::obb;
  Simulation expected = simulation_of(show);
  for (TestPage* const each : {&page, &other}) {
    each->ask({{"do", "pause"}});
    each->frame_after_steps(60);
  }
  page.say({{"do", "set"}, {"bounding_volume", "obb"}});
  page.scene();
  page.frame();
  for (int i = 0; i < 90; ++i) expected.step();
  const ViewerMessage frame = page.frame_after_steps(30), without = other.frame_after_steps(30);
  EXPECT_EQ(frame.json["step"], 90);
  for (const std::uint32_t moving : {0u, 1u, 3u, 4u})
    EXPECT_EQ(frame.values<Vec3f>(32, moving), without.values<Vec3f>(32, moving)) << moving;
  EXPECT_GT(count_of(frame, "contacts"), 0u);
  expect_contacts(frame, expected.scene().result(), center);
}

TEST(ViewerSettings, ASetLosesNoEventsAndNoStatistics) {
  TestPage page(touching_balls());
  page.scene();
  page.ask({{"do", "pause"}});
  EXPECT_EQ(page.frame().values<StepPair>(44).size(), 1u);
  page.ask({{"do", "step"}, {"count", 3}});
  for (int i = 0; i < 3; ++i) page.session.advance(0);
  page.say({{"do", "set"}, {"leaf_size", 4}});
  const std::size_t columns = page.scene().json["statistics"].size();
  const ViewerMessage frame = page.frame();
  EXPECT_TRUE(frame.values<StepPair>(44).empty() && frame.values<StepPair>(45).empty())
      << "the pair still touches";
  EXPECT_EQ(frame.section(43).count, 3 * columns);
}

TEST(ViewerSettings, RefusesWhatIsOutOfRangeWithTheRange) {
  TestPage page(three_balls());
  const Json settings = page.scene().json["settings"];
  const auto described = [&](const std::string& key) {
    for (const Json& setting : settings) {
      if (setting["key"] == key) return setting;
    }
    return Json();
  };
  const std::vector<std::pair<std::string, Json>> refused{
      {"time_step", -1},  {"time_step", 0},     {"time_step", "x"}, {"max_level", 99}, {"leaf_size", -5},
      {"leaf_size", 0.5}, {"objects", 100'001}, {"objects", 0},     {"tree_arity", 3}, {"max_time", 2}};
  for (const auto& [key, value] : refused) {
    const std::string failure = page.failure(Json{{"do", "set"}, {key, value}}.dump());
    EXPECT_NE(failure.find("it must be " + described(key)["range"].get<std::string>()), std::string::npos)
        << failure;
  }
  EXPECT_EQ(described("max_level")["range"], "a whole number from 0 to 32");
  EXPECT_EQ(described("time_step")["unit"], "s");
  EXPECT_EQ(described("bounding_volume")["words"].at(0), "aabb");
  page.say({{"do", "set"}});
  EXPECT_EQ(page.scene().json["time_step"], 0.01) << "the old value stays";
}

TEST(ViewerSettings, RepeatsObjectsApartAndCutsTheList) {
  SceneView show = three_balls();
  show.simulation.border = Border{{{-2, -2, -2}, {5, 2, 4}}};
  TestPage page(show);
  page.scene();
  page.say({{"do", "set"}, {"objects", 14}});
  ViewerMessage scene = page.scene();
  ASSERT_EQ(scene.json["objects"].size(), 14u);
  EXPECT_EQ(scene.json["objects"][3]["name"], "waves #2");
  EXPECT_EQ(scene.json["objects"][13]["name"], "soft #5");
  EXPECT_EQ(scene.json["objects"][13]["body"], true);
  EXPECT_EQ(count_of(page.frame(), "object_pairs"), 0u)
      << "the copies are disjoint, like the three originals";
  EXPECT_NO_THROW(page.frame_after_steps(20));
  page.say({{"do", "set"}, {"objects", 2}});
  scene = page.scene();
  ASSERT_EQ(scene.json["objects"].size(), 2u);
  page.say({{"do", "set"}, {"objects", 3}});
  EXPECT_EQ(page.scene().json["objects"][2]["name"], "rest");
}

TEST(ViewerSettings, ResetStartsAnewWithTheSeed) {
  SceneView show = three_balls();
  show.objects[1].motion = MassSpringMotion{.random_speed = 1};
  TestPage page(show);
  page.scene();
  page.ask({{"do", "pause"}});
  const auto positions = [&] { return page.frame_after_steps(10).values<Vec3f>(32, 1); };
  const auto reset = [&](Json command) {
    command["do"] = "reset";
    page.say(command);
    return page.scene();
  };
  const auto first = positions();
  EXPECT_EQ(reset({}).json["seed"], "0");
  EXPECT_EQ(positions(), first);
  EXPECT_EQ(reset({{"seed", "5"}}).json["seed"], "5");
  const auto other = positions();
  EXPECT_NE(other, first);
  EXPECT_EQ(reset({}).json["seed"], "5");
  EXPECT_EQ(positions(), other);
}

TEST(ViewerSettings, CarriesEverySeedOf64Bits) {
  SceneView show = three_balls();
  show.objects[1].motion = MassSpringMotion{.random_speed = 1};
  show.simulation.seed = (std::uint64_t{1} << 53) + 1;  // a number of JavaScript is not exact here
  TestPage page(show);
  EXPECT_EQ(page.scene().json["seed"], "9007199254740993");
  for (const std::uint64_t seed : {std::uint64_t{1} << 32, (std::uint64_t{1} << 63) + 1, ~std::uint64_t{0}}) {
    page.say({{"do", "reset"}, {"seed", std::to_string(seed)}});
    EXPECT_EQ(page.scene().json["seed"], std::to_string(seed));
    page.ask({{"do", "pause"}});
    const auto shown = page.frame_after_steps(3).values<Vec3f>(32, 1);
    SceneView same = show;
    same.simulation.seed = seed;
    TestPage other(same);
    other.scene();
    other.ask({{"do", "pause"}});
    EXPECT_EQ(shown, other.frame_after_steps(3).values<Vec3f>(32, 1)) << seed;
  }
}

TEST(ViewerSettings, CommandsStayWithinTheMemoryBudget) {
  TestPage page(three_balls(), {4e6});
  page.scene();
  EXPECT_NE(page.failure(R"({"do": "set", "objects": 100000})").find("--max-memory"), std::string::npos);
  EXPECT_NE(page.failure(R"({"do": "set", "objects": 20, "leaf_size": 1})").find("MB"), std::string::npos);
  page.say({{"do", "set"}, {"objects", 20}});
  EXPECT_EQ(page.scene().json["objects"].size(), 20u);
  page.failure(R"({"do": "set", "leaf_size": 1})");
  page.say({{"do", "reset"}});
  EXPECT_EQ(page.scene().json["objects"].size(), 20u) << "a failure changes nothing";
}

TEST(ViewerSettings, TheOpenedSceneNeedsNoBudget) {
  SceneView show = three_balls();
  show.objects.resize(2);
  TestPage page(show, {0});
  page.scene();
  page.say({{"do", "set"}, {"contacts", "continuous"}});
  EXPECT_EQ(page.scene().json["objects"].size(), 2u);
  page.failure(R"({"do": "set", "objects": 3})");
  page.say({{"do", "set"}, {"objects", 1}});
  page.scene();
  page.say({{"do", "set"}, {"objects", 2}});
  EXPECT_EQ(page.scene().json["objects"].size(), 2u);
}

#if defined(__GLIBC__) && defined(NDEBUG) && !defined(SUPPLE_SANITIZED)
/// Memory of the whole program, without what it has freed.
double allocated_bytes() {
  const auto memory = mallinfo2();
  return static_cast<double>(memory.uordblks + memory.hblkhd);
}

TEST(ViewerSettings, MemoryIsEstimatedGenerously) {
  const Json small_nodes{{"tree_arity", 2}, {"object_octree", "regular"}, {"bounding_volume", "kdop26"}};
  for (const auto& [leaf_size, options] :
       {std::pair{64u, Json::object()}, {8u, Json::object()}, {1u, small_nodes}}) {
    for (const char* const contacts : {"intersection", "continuous", "intersection,continuous,proximity"}) {
      for (const auto& [frequency, count] : {std::pair{1u, 400u}, {16u, 10u}}) {
        SceneView show;
        show.simulation.scene.threads = 1;
        show.objects.push_back({make_icosphere(frequency), {.self_collision = true}, MassSpringMotion{}});
        show.objects.front().options.octree.leaf_size = leaf_size;
        Settings settings;
        settings.restart.objects = count;
        const double estimate = estimated_memory(show, settings), before = allocated_bytes();
        TestPage page(std::move(show));
        Json command = options;
        command.update({{"do", "set"}, {"contacts", contacts}, {"objects", count}});
        page.scene();
        page.say(command);
        EXPECT_EQ(page.scene().json["objects"].size(), count);
        page.ask({{"do", "layers"}, {"candidates", true}, {"colliding_vertices", true}});
        page.ask({{"do", "pause"}});
        page.frame_after_steps(2);
        const double needed = allocated_bytes() - before;
        EXPECT_LE(needed, estimate) << leaf_size << command;
        EXPECT_GE(needed, 0.1 * estimate) << leaf_size << command;
      }
    }
  }
}
#endif

TEST(ViewerSettings, AFailedSetLeavesAllAsItWas) {
  SceneView show = three_balls();
  show.objects[2] = test_ball("fine", {0, 0, 2.2}, 30);
  TestPage page(show, {1e18});
  page.scene();
  page.ask({{"do", "pause"}});
  page.frame_after_steps(3);
  const std::string failure =
      page.failure(R"({"do": "set", "objects": 100000, "bounding_volume": "sphere"})");
  EXPECT_EQ(failure.substr(0, 25), "set: 100000 objects have ");
  const ViewerMessage frame = page.frame_after_steps(1);
  EXPECT_EQ(frame.json["step"], 4);
  EXPECT_EQ(frame.json["generation"], 1);
  page.say({{"do", "set"}});
  const ViewerMessage scene = page.scene();
  EXPECT_EQ(scene.json["objects"].size(), 3u);
  EXPECT_EQ(scene.json["bounding_volume"], "aabb");
}

}  // namespace supple::viewer::session_settings_test
