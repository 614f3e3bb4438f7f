#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "../../support/viewer_page.hpp"

namespace supple::viewer::session_pins_test {

constexpr std::uint32_t pin_rows = 63;

/// A row of a pin by the names of its numbers.
using PinNumbers = std::map<std::string, double>;

class PinnedPage : public TestPage {
 public:
  explicit PinnedPage(SceneView show) : TestPage(std::move(show)) {
    const ViewerMessage first = scene();
    for (const Json& value : first.json["pin_values"]) names_.push_back(value["key"]);
  }
  std::vector<PinNumbers> rows(const ViewerMessage& frame, std::uint32_t pin) const {
    std::vector<PinNumbers> list;
    if (!frame.has(pin_rows, pin)) return list;
    const auto values = frame.values<double>(pin_rows, pin);
    const std::size_t width = 2 + names_.size();
    EXPECT_EQ(values.size() % width, 0u);
    for (std::size_t at = 0; at + width <= values.size(); at += width) {
      PinNumbers& row = list.emplace_back();
      row["step"] = values[at];
      row["time"] = values[at + 1];
      for (std::size_t i = 0; i < names_.size(); ++i) row[names_[i]] = values[at + 2 + i];
    }
    return list;
  }
  void pin(const Json& pins) { ask({{"do", "pins"}, {"pins", pins}}); }

 private:
  std::vector<std::string> names_;
};

/// A waving ball and a soft ball that touch at the start, and a ball at rest.
SceneView meeting_balls(ContactKinds contacts) {
  SceneView show;
  show.simulation.scene.contacts = contacts;
  show.simulation.scene.curves = contains(contacts, ContactKinds::penetration);
  show.objects = {test_ball("left", {}), test_ball("right", {1.7, 0.1, 0}), test_ball("far", {0, 8, 0})};
  for (ViewedObject& object : show.objects) {
    object.options.margin = 0.2;
    object.options.solid = true;
  }
  show.objects[0].motion = WaveMotion{.velocity = {0.5, 0, 0}, .amplitude = 0.05};
  return show;
}

Vec3d center_of(std::span<const Vec3d> positions) {
  Vec3d sum{};
  for (const Vec3d& p : positions) sum = sum + p;
  return (1.0 / static_cast<double>(positions.size())) * sum;
}

bool is_of(ObjectId a, ObjectId b) {
  return std::minmax(a.index, b.index) == std::minmax(0u, 1u);
}

/// The numbers of the pair of the first two objects, from the lists of the result alone.
PinNumbers expected_of_pair(const DetectResult& result) {
  const double nothing = std::numeric_limits<double>::quiet_NaN();
  PinNumbers row{{"contacts", 0}, {"gap", nothing}, {"depth", nothing}, {"length", 0}, {"area", 0}};
  Vec3d normal{};
  const auto add = [&](ObjectId a, const Vec3d& n) { normal = normal + (a.index == 0 ? 1.0 : -1.0) * n; };
  for (const Contact& c : result.contacts) {
    if (!is_of(c.object_a, c.object_b)) continue;
    row["contacts"] += 1;
    add(c.object_a, c.normal);
    if (c.point_count == 2)
      row["length"] += norm(result.points_of(c)[0].position - result.points_of(c)[1].position);
  }
  for (const ProximityPair& p : result.proximity_pairs) {
    if (!is_of(p.object_a, p.object_b)) continue;
    row["contacts"] += 1;
    add(p.object_a, p.normal);
    row["gap"] = std::isnan(row["gap"]) ? p.distance : std::min(row["gap"], p.distance);
  }
  const auto deepen = [&](double depth) {
    row["depth"] = std::isnan(row["depth"]) ? depth : std::max(row["depth"], depth);
  };
  for (const Penetration& p : result.penetrations) {
    if (!is_of(p.object_a, p.object_b)) continue;
    row["contacts"] += 1;
    add(p.object_a, p.normal);
    deepen(p.depth);
  }
  for (const IntersectionCurve& c : result.curves) {
    if (!is_of(c.a, c.b)) continue;
    deepen(c.depth);
    if (c.kind == CurveKind::closed) row["area"] += norm(c.area);
  }
  row["normal_x"] = normal.x / norm(normal);
  row["normal_y"] = normal.y / norm(normal);
  row["normal_z"] = normal.z / norm(normal);
  return row;
}

void expect_same(const PinNumbers& row, const PinNumbers& expected) {
  for (const auto& [name, value] : expected) {
    if (std::isnan(value)) {
      EXPECT_TRUE(std::isnan(row.at(name))) << name;
      continue;
    }
    EXPECT_NEAR(row.at(name), value, 1e-12 * (1 + std::fabs(value))) << name;
  }
}

TEST(ViewerPins, APairHasItsContactsInEachStep) {
  const SceneView show = meeting_balls(ContactKinds::proximity | ContactKinds::penetration);
  PinnedPage page(show);
  page.frame();
  page.ask({{"do", "pause"}});
  page.pin({{{"pin", 7}, {"objects", {0, 1}}}, {{"pin", 8}, {"objects", {1, 0}}}});
  Simulation simulation = simulation_of(show);
  simulation.detect();
  auto first = page.rows(page.frame(), 7);
  ASSERT_EQ(first.size(), 1u);
  EXPECT_EQ(first[0]["step"], 0);
  expect_same(first[0], expected_of_pair(simulation.scene().result()));

  const ViewerMessage frame = page.frame_after_steps(5);  // one frame with the rows of all steps
  auto rows = page.rows(frame, 7), reversed = page.rows(frame, 8);
  ASSERT_EQ(rows.size(), 5u);
  bool has_depth = false;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    simulation.step();
    EXPECT_EQ(rows[i]["step"], i + 1);
    EXPECT_DOUBLE_EQ(rows[i]["time"], simulation.time());
    expect_same(rows[i], expected_of_pair(simulation.scene().result()));
    has_depth = has_depth || rows[i]["depth"] > 0;
    const Vec3d normal{rows[i]["normal_x"], rows[i]["normal_y"], rows[i]["normal_z"]};
    EXPECT_LT(normal.x, -0.3) << "from the right ball to the left one";
    EXPECT_NEAR(reversed[i]["normal_x"], -normal.x, 1e-12);
  }
  EXPECT_TRUE(has_depth);
}

TEST(ViewerPins, AnObjectHasItsSpeedAndDisplacement) {
  const SceneView show = meeting_balls(ContactKinds::intersection);
  PinnedPage page(show);
  page.frame();
  page.ask({{"do", "pause"}});
  page.pin({{{"pin", 1}, {"objects", {0}}}, {{"pin", 2}, {"objects", {2}}}});
  Simulation simulation = simulation_of(show);
  simulation.detect();
  const ObjectId left = simulation.scene().objects().front();
  const auto positions = [&] {
    const auto now = simulation.positions(left);
    return std::vector<Vec3d>(now.begin(), now.end());
  };
  const std::vector<Vec3d> start = positions();
  auto first = page.rows(page.frame(), 1);
  ASSERT_EQ(first.size(), 1u);
  EXPECT_EQ(first[0]["displacement"], 0);
  EXPECT_TRUE(std::isnan(first[0]["speed"])) << "there is no step before";
  const ViewerMessage frame = page.frame_after_steps(4);
  auto rows = page.rows(frame, 1), far = page.rows(frame, 2);
  ASSERT_EQ(rows.size(), 4u);
  std::vector<Vec3d> before = start;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const double time = simulation.time();
    simulation.step();
    const std::vector<Vec3d> now = positions();
    double largest = 0;
    for (std::size_t v = 0; v < now.size(); ++v) largest = std::max(largest, norm(now[v] - start[v]));
    EXPECT_NEAR(rows[i]["displacement"], largest, 1e-12);
    EXPECT_NEAR(rows[i]["speed"], norm(center_of(now) - center_of(before)) / (simulation.time() - time),
                1e-9);
    EXPECT_EQ(rows[i]["contacts"], simulation.scene().result().contacts.size());
    EXPECT_EQ(far[i]["contacts"], 0);
    EXPECT_EQ(far[i]["speed"], 0);
    before = now;
  }
}

TEST(ViewerPins, AContactIsFollowedWhileItExists) {
  PinnedPage page(meeting_balls(ContactKinds::penetration));
  const ViewerMessage frame = page.frame();
  page.ask({{"do", "pause"}});
  const auto contacts = contacts_in(frame);
  ASSERT_FALSE(contacts.empty());
  const auto c = contacts.front();
  page.pin({{{"pin", 1}, {"objects", {c[0], c[2]}}, {"contact", c}},
            {{"pin", 2}, {"objects", {c[0], c[2]}}, {"contact", {c[0], c[1], c[2], 0}}}});
  const ViewerMessage pinned = page.frame();
  auto row = page.rows(pinned, 1).at(0);
  EXPECT_EQ(row["contacts"], 1);
  EXPECT_GT(row["length"], 0);
  EXPECT_GT(row["depth"], 0) << "that of its curve";
  EXPECT_NEAR(row["normal_x"], column_of<float>(frame, "contacts", "normal").at(0), 1e-6);
  auto other = page.rows(pinned, 2).at(0);
  EXPECT_EQ(other["contacts"], 0);
  EXPECT_TRUE(std::isnan(other["depth"]));
}

TEST(ViewerPins, RowsComeOnceAndFollowTheListOfPins) {
  PinnedPage page(meeting_balls(ContactKinds::intersection));
  page.frame();
  page.ask({{"do", "pause"}});
  page.pin({{{"pin", 1}, {"objects", {0}}}});
  EXPECT_EQ(page.rows(page.frame_after_steps(3), 1).size(), 3u)
      << "the step of the pin is replaced by the next ones";
  page.pin({{{"pin", 1}, {"objects", {0}}}, {{"pin", 2}, {"objects", {0, 1}}}});
  const ViewerMessage both = page.frame();
  ASSERT_EQ(page.rows(both, 1).size(), 1u);
  EXPECT_EQ(page.rows(both, 1)[0].at("step"), 3);
  EXPECT_FALSE(std::isnan(page.rows(both, 1)[0].at("speed"))) << "a pin that stays keeps its last place";
  EXPECT_EQ(page.rows(both, 2).size(), 1u);
  page.pin(Json::array());
  EXPECT_FALSE(page.frame_after_steps(1).has(pin_rows, 1));
  page.pin({{{"pin", 3}, {"objects", {0}}}});
  page.say({{"do", "reset"}});
  page.scene();
  auto again = page.rows(page.frame(), 3);
  ASSERT_EQ(again.size(), 1u);
  EXPECT_EQ(again[0]["step"], 0);
}

TEST(ViewerPins, AnInvalidPinChangesNothing) {
  PinnedPage page(meeting_balls(ContactKinds::intersection));
  page.frame();
  page.ask({{"do", "pause"}});
  page.pin({{{"pin", 1}, {"objects", {0}}}});
  page.frame();
  const auto refuses = [&](const char* pins, const char* reason) {
    const std::string text = page.failure(std::string(R"({"do": "pins", "pins": )") + pins + "}");
    EXPECT_NE(text.find(reason), std::string::npos) << text;
  };
  refuses("3", "a list of at most 32 pins");
  refuses("[4]", "pin 0 of the list is not an object");
  refuses(R"([{"objects": [0]}])", "pin is missing");
  refuses(R"([{"pin": 1}])", "objects is missing");
  refuses(R"([{"pin": 1, "objects": []}])", "one or two numbers of objects");
  refuses(R"([{"pin": 1, "objects": [3]}])", "there is no object 3; there are 3");
  refuses(R"([{"pin": 1, "objects": [0]}, {"pin": 1, "objects": [1]}])", "the number of another pin: 1");
  refuses(R"([{"pin": 1, "objects": [0, 1], "contact": [0, 5, 2, 5]}])", "of these objects");
  refuses(R"([{"pin": 1, "objects": [0], "word": 1}])", "it has no \"word\"");
  EXPECT_TRUE(page.frame_after_steps(1).has(pin_rows, 1));
}

}  // namespace supple::viewer::session_pins_test
