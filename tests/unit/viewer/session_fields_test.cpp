#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "../../support/viewer_page.hpp"
#include "supple/queries.hpp"

namespace supple::viewer::session_fields_test {

constexpr std::uint32_t values_tag = 61, vectors_tag = 62;
using Vector = std::array<float, 3>;

std::set<std::string> keys_of(const ViewerMessage& scene) {
  std::set<std::string> keys;
  for (const Json& field : scene.json["fields"]) keys.insert(field["key"]);
  return keys;
}

bool has_values(const ViewerMessage& frame) {
  return std::any_of(frame.sections.begin(), frame.sections.end(), [](const auto& section) {
    return section.first.first == values_tag || section.first.first == vectors_tag;
  });
}

Json choose(TestPage& page, const char* key) {
  return page.ask({{"do", "layers"}, {"field", key}});
}

/// A cube of known velocity, and a ball at rest.
SceneView moving_cube(Vec3d velocity) {
  SceneView show;
  show.simulation.time_step = 0.25;
  show.objects = {{make_box({1, 1, 1}, 2)}, test_ball("rest", {5, 0, 0})};
  show.objects[0].motion = RigidMotion{.velocity = velocity};
  return show;
}

/// A rectangle of two triangles.
TriangleMesh sheet() {
  return {"sheet", {{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}};
}

/// Frames with the positions of one object.
struct OneObject final : Frames {
  std::vector<std::vector<Vec3d>> positions;
  Series rows{{"time"}, {}, {}, {}, {}};

  std::uint64_t count() const override { return positions.size(); }
  void read(std::uint64_t frame, std::size_t, std::span<Vec3d> to) const override {
    std::copy(positions[frame].begin(), positions[frame].end(), to.begin());
  }
  const Series& series() const override { return rows; }
};

SceneView recording(const TriangleMesh& mesh, std::vector<std::vector<Vec3d>> frames,
                    std::vector<double> times) {
  auto stored = std::make_shared<OneObject>();
  stored->positions = std::move(frames);
  stored->rows.values = std::move(times);
  SceneView show;
  show.objects = {{mesh}};
  show.frames = stored;
  return show;
}

TEST(ViewerFields, AreThoseThatTheSceneHas) {
  TestPage still(three_balls());
  EXPECT_EQ(keys_of(still.scene()),
            (std::set<std::string>{"speed", "velocity", "displacement", "strain", "distance"}));
  SceneView show = three_balls();
  show.objects.resize(1);
  show.simulation.scene.contacts = ContactKinds::penetration | ContactKinds::intersection |
                                   ContactKinds::proximity | ContactKinds::continuous;
  TestPage all(std::move(show));
  EXPECT_EQ(keys_of(all.scene()),
            (std::set<std::string>{"speed", "velocity", "displacement", "strain", "depth", "gap",
                                   "impact_time", "curve_depth", "curve_area"}));
}

TEST(ViewerFields, AreLeftOutUntilOneIsChosen) {
  TestPage page(moving_cube({2, 0, 0}));
  page.scene();
  const ViewerMessage without = page.frame_after_steps(2);
  EXPECT_TRUE(without.json["field"].is_null());
  EXPECT_FALSE(has_values(without));
  choose(page, "displacement");
  const ViewerMessage with = page.frame();
  EXPECT_EQ(with.json["field"], "displacement");
  EXPECT_TRUE(has_values(with));
  page.ask({{"do", "layers"}, {"field", nullptr}});
  EXPECT_FALSE(has_values(page.frame()));
}

TEST(ViewerFields, UnknownFieldIsRefusedAndChangesNothing) {
  TestPage page(moving_cube({2, 0, 0}));
  page.scene();
  choose(page, "displacement");
  page.frame();
  const std::string why = page.failure(R"({"do": "layers", "field": "heat"})");
  EXPECT_NE(why.find("it must be one of the fields of the scene: null, speed, velocity"), std::string::npos)
      << why;
  page.failure(R"({"do": "layers", "field": 3})");
  page.ask({{"do", "layers"}});
  EXPECT_EQ(page.frame().json["field"], "displacement");
}

TEST(ViewerFields, SpeedAndVelocityAreThoseOfTheLastStep) {
  TestPage page(moving_cube({1.5, -2, 0}));
  page.scene();
  choose(page, "speed");
  EXPECT_FALSE(has_values(page.frame())) << "before the first step";
  const ViewerMessage frame = page.frame_after_steps(3);
  const auto speeds = frame.values<float>(values_tag, 0);
  EXPECT_EQ(speeds.size(), make_box({1, 1, 1}, 2).positions.size());
  for (const float speed : speeds) EXPECT_NEAR(speed, 2.5f, 1e-6f);
  for (const float speed : frame.values<float>(values_tag, 1)) EXPECT_EQ(speed, 0.f);
  choose(page, "velocity");
  const ViewerMessage vectors = page.frame();  // the step before is still known
  EXPECT_FALSE(vectors.has(values_tag, 0));
  for (const Vector& v : vectors.values<Vector>(vectors_tag, 0)) {
    EXPECT_NEAR(v[0], 1.5f, 1e-6f);
    EXPECT_NEAR(v[1], -2.f, 1e-6f);
    EXPECT_EQ(v[2], 0.f);
  }
}

TEST(ViewerFields, RestartForgetsTheStepBefore) {
  TestPage page(moving_cube({1, 0, 0}));
  page.scene();
  choose(page, "speed");
  page.frame_after_steps(2);
  page.say({{"do", "reset"}});
  EXPECT_EQ(page.drain().front().kind, ViewerMessage::scene);
  EXPECT_FALSE(has_values(page.frame()));
  for (const float speed : page.frame_after_steps(1).values<float>(values_tag, 0))
    EXPECT_NEAR(speed, 1.f, 1e-6f);
}

TEST(ViewerFields, PageThatConnectsAgainHasValuesAtOnce) {
  TestPage page(moving_cube({1, 0, 0}));
  page.scene();
  choose(page, "speed");
  page.frame_after_steps(2);
  page.session.greet();
  page.scene();
  choose(page, "speed");
  for (const float speed : page.frame().values<float>(values_tag, 0)) EXPECT_NEAR(speed, 1.f, 1e-6f);
  page.ask({{"do", "layers"}, {"field", nullptr}});
  EXPECT_FALSE(has_values(page.frame_after_steps(1)));
  choose(page, "speed");
  for (const float speed : page.frame().values<float>(values_tag, 0)) EXPECT_NEAR(speed, 1.f, 1e-6f);
}

TEST(ViewerFields, RecordingReadsTheFrameBefore) {
  const TriangleMesh mesh = sheet();
  const auto moved = [&](double by) {
    std::vector<Vec3d> positions = mesh.positions;
    for (Vec3d& p : positions) p.x += by;
    return positions;
  };
  TestPage page(recording(mesh, {moved(1), moved(3), moved(4)}, {0, 0.5, 2.5}));
  page.drain();
  choose(page, "speed");
  EXPECT_FALSE(has_values(page.frame())) << "the first frame";
  page.ask({{"do", "seek"}, {"frame", 2}});
  page.session.advance(0);
  for (const float speed : page.frame().values<float>(values_tag, 0)) EXPECT_EQ(speed, 0.5f);
  page.ask({{"do", "seek"}, {"frame", 1}});
  page.session.advance(0);
  for (const float speed : page.frame().values<float>(values_tag, 0)) EXPECT_EQ(speed, 4.f);
  choose(page, "displacement");
  for (const Vector& v : page.frame().values<Vector>(vectors_tag, 0)) EXPECT_EQ(v, (Vector{2, 0, 0}));
}

TEST(ViewerFields, StrainOfAStretchedAndTurnedSheet) {
  const TriangleMesh mesh = sheet();
  const double turn = 0.7, u = std::cos(turn), v = std::sin(turn);
  std::vector<Vec3d> stretched, squeezed, sheared;
  for (const Vec3d& p : mesh.positions) {
    const double x = 1.25 * p.x, y = 0.5 * p.y;  // stretched along x by a quarter
    stretched.push_back({u * x - v * y, 7, v * x + u * y});
    squeezed.push_back(0.75 * p);
    sheared.push_back({p.x + 0.3 * p.y, p.y, p.z});
  }
  TestPage page(recording(mesh, {mesh.positions, stretched, squeezed, sheared}, {0, 1, 2, 3}));
  page.drain();
  choose(page, "strain");
  // The largest singular value of {{1, s}, {0, 1}}.
  const double s = 0.3, shear = std::sqrt(1 + s * s / 2 + s * std::sqrt(1 + s * s / 4)) - 1;
  const double expected[] = {0, 0.25, -0.25, shear};
  for (int frame = 0; frame < 4; ++frame) {
    page.ask({{"do", "seek"}, {"frame", frame}});
    page.session.advance(0);
    const auto strains = page.frame().values<float>(values_tag, 0);
    ASSERT_EQ(strains.size(), 2u);
    for (const float strain : strains) EXPECT_NEAR(strain, expected[frame], 1e-6) << frame;
  }
}

TEST(ViewerFields, TrianglesWithoutAreaAndVerticesThatAreNotFiniteHaveNoValue) {
  TriangleMesh mesh = sheet();
  mesh.triangles.push_back({0, 1, 1});
  std::vector<Vec3d> broken = mesh.positions;
  broken[3].y = std::numeric_limits<double>::infinity();
  TestPage page(recording(mesh, {mesh.positions, broken}, {0, 1}));
  page.drain();
  page.ask({{"do", "seek"}, {"frame", 1}});
  page.session.advance(0);
  choose(page, "strain");
  const auto strains = page.frame().values<float>(values_tag, 0);
  ASSERT_EQ(strains.size(), 3u);
  EXPECT_EQ(strains[0], 0.f);
  EXPECT_TRUE(std::isnan(strains[1]) && std::isnan(strains[2]));
  choose(page, "speed");
  const auto speeds = page.frame().values<float>(values_tag, 0);
  EXPECT_TRUE(std::isnan(speeds[3]));
  EXPECT_EQ(speeds[0], 0.f);
}

/// The distances of all vertices to all triangles of other objects, by one query for each other object.
std::vector<double> distances_of(const SceneView& show, std::size_t object) {
  Scene scene(show.simulation.scene);
  std::vector<ObjectId> ids;
  for (const ViewedObject& each : show.objects) ids.push_back(scene.add(each.mesh, each.options));
  const std::vector<Vec3d>& points = show.objects[object].mesh.positions;
  std::vector<double> least(points.size(), std::numeric_limits<double>::infinity());
  for (std::size_t other = 0; other < ids.size(); ++other) {
    if (other == object) continue;
    std::vector<std::optional<ClosestPoint>> found(points.size());
    scene.closest(points, found, {.filter = {.object = ids[other]}});
    for (std::size_t v = 0; v < points.size(); ++v) {
      if (found[v]) least[v] = std::min(least[v], found[v]->distance);
    }
  }
  return least;
}

TEST(ViewerFields, DistanceIsThatToTheNearestOtherObject) {
  SceneView show;
  show.objects = {{make_box({2, 2, 2}, 2)}, {make_box({2, 2, 2}, 2)}};
  for (Vec3d& p : show.objects[1].mesh.positions) p.x += 5;
  for (int i = 0; i < 12; ++i)
    show.objects.push_back(test_ball("ball", {3. * (i % 4), 3. + 2.5 * (i / 4), 0.4 * i}));
  TestPage page(show);
  page.scene();
  choose(page, "distance");
  const ViewerMessage frame = page.frame();
  for (std::uint32_t object = 0; object < show.objects.size(); ++object) {
    const auto sent = frame.values<float>(values_tag, object);
    const std::vector<double> expected = distances_of(show, object);
    ASSERT_EQ(sent.size(), expected.size());
    for (std::size_t v = 0; v < sent.size(); ++v) EXPECT_FLOAT_EQ(sent[v], static_cast<float>(expected[v]));
  }
  show.objects.resize(2);
  TestPage boxes(show);
  boxes.scene();
  choose(boxes, "distance");
  const auto sent = boxes.frame().values<float>(values_tag, 0);
  for (std::size_t v = 0; v < sent.size(); ++v)  // the faces look at each other
    EXPECT_FLOAT_EQ(sent[v], static_cast<float>(4 - show.objects[0].mesh.positions[v].x));
}

TEST(ViewerFields, DepthIsTheLargestOfEachVertex) {
  SceneView show = touching_balls();
  show.simulation.scene.contacts = ContactKinds::penetration;
  for (ViewedObject& object : show.objects) object.options.solid = true;
  Scene scene(show.simulation.scene);
  for (const ViewedObject& object : show.objects) scene.add(object.mesh, object.options);
  scene.detect();
  ASSERT_FALSE(scene.result().penetrations.empty());
  TestPage page(show);
  page.scene();
  choose(page, "depth");
  const ViewerMessage frame = page.frame();
  EXPECT_FALSE(frame.has(values_tag, 2)) << "nothing is inside of the third ball or the other way round";
  for (std::uint32_t object = 0; object < 2; ++object) {
    std::vector<float> expected(show.objects[object].mesh.positions.size(), -1);
    for (const Penetration& p : scene.result().penetrations) {
      if (p.object_a.index == object)
        expected[p.vertex] = std::max(expected[p.vertex], static_cast<float>(p.depth));
    }
    const auto sent = frame.values<float>(values_tag, object);
    ASSERT_EQ(sent.size(), expected.size());
    for (std::size_t v = 0; v < sent.size(); ++v) {
      if (expected[v] < 0)
        EXPECT_TRUE(std::isnan(sent[v]));
      else
        EXPECT_EQ(sent[v], expected[v]);
    }
  }
}

TEST(ViewerFields, ContactFieldsNameTheColumnOfTheirValues) {
  SceneView show = touching_balls();
  show.simulation.scene.contacts = ContactKinds::proximity;
  for (ViewedObject& object : show.objects) object.options.margin = 0.3;
  TestPage page(std::move(show));
  const Json fields = page.scene().json["fields"];
  const auto gap =
      std::find_if(fields.begin(), fields.end(), [](const Json& field) { return field["key"] == "gap"; });
  ASSERT_NE(gap, fields.end());
  EXPECT_EQ((*gap)["element"], "contact");
  EXPECT_EQ((*gap)["list"], "proximity_pairs");
  EXPECT_EQ((*gap)["column"], "distance");
  choose(page, "gap");
  const ViewerMessage frame = page.frame();
  EXPECT_FALSE(has_values(frame));
  EXPECT_GT(column_of<float>(frame, "proximity_pairs", "distance").size(), 0u);
}

TEST(ViewerFields, ReadAnswersTheValueInDouble) {
  TestPage page(moving_cube({1.0 / 3, 0, 0}));
  page.scene();
  choose(page, "speed");
  page.frame_after_steps(1);
  const Json vertex = page.ask({{"do", "read"}, {"object", 0}, {"vertex", 3}});
  EXPECT_NEAR(vertex["field"]["Speed"].get<double>(), 1.0 / 3, 1e-12);
  EXPECT_FALSE(page.ask({{"do", "read"}, {"object", 0}, {"triangle", 3}}).contains("field"));
  choose(page, "strain");
  const Json triangle = page.ask({{"do", "read"}, {"object", 0}, {"triangle", 3}});
  EXPECT_NEAR(triangle["field"]["Strain"].get<double>(), 0, 1e-12);
  choose(page, "displacement");
  const Json vector = page.ask({{"do", "read"}, {"object", 0}, {"vertex", 3}})["field"]["Displacement"];
  EXPECT_NEAR(vector[0].get<double>(), 0.25 / 3, 1e-12);
}

}  // namespace supple::viewer::session_fields_test
