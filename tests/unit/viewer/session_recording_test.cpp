#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "../../support/viewer_page.hpp"
#include "session/packed/packed_scene.hpp"

namespace supple::viewer::session_recording_test {

/// Frames in memory; some of them may be damaged.
struct StoredFrames : Frames {
  std::vector<std::vector<std::vector<Vec3d>>> positions;  // by frame and object
  Series rows;
  std::vector<std::uint64_t> damaged;

  std::uint64_t count() const override { return positions.size(); }
  void read(std::uint64_t frame, std::size_t object, std::span<Vec3d> to) const override {
    if (std::find(damaged.begin(), damaged.end(), frame) != damaged.end())
      throw Error("run.h5: frame " + std::to_string(frame) + " is damaged");
    std::copy(positions[frame][object].begin(), positions[frame][object].end(), to.begin());
  }
  const Series& series() const override { return rows; }
};

struct GrowingFrames final : StoredFrames {
  std::vector<std::vector<std::vector<Vec3d>>> all;
  std::vector<double> all_rows;
  bool has_news = false;
  std::string problem;

  void show_first(std::size_t count) {
    if (all.empty()) {
      all = positions;
      all_rows = rows.values;
    }
    positions.assign(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(count));
    rows.values.assign(all_rows.begin(),
                       all_rows.begin() + static_cast<std::ptrdiff_t>(count * rows.names.size()));
    has_news = true;
  }
  bool is_growing() const override { return problem.empty(); }
  bool refresh() override {
    if (!problem.empty() && !std::exchange(is_told, true)) throw Error(problem);
    return std::exchange(has_news, false);
  }
  bool is_told = false;
};

/// The recording of a simulation, and its contacts frame by frame.
struct Recorded {
  std::shared_ptr<StoredFrames> frames = std::make_shared<StoredFrames>();
  SceneView show;
  std::vector<std::vector<Contact>> contacts;
  std::vector<std::vector<ContinuousContact>> impacts;

  std::size_t frame_count() const { return contacts.size(); }
};

SceneView flight() {
  SceneView show;
  show.objects = {test_ball("ball", {}), test_ball("flying", {2.6, 0, 0}), test_ball("wall", {-2.5, 0, 0})};
  show.objects[1].motion = WaveMotion{.velocity = {-3, 0, 0}, .amplitude = 0.05};
  show.objects[2].options.is_static = true;
  return show;
}

Recorded record(int frames, ContactKinds contacts = ContactKinds::intersection) {
  SceneView live = flight();
  live.simulation.scene.contacts = contacts;
  Simulation simulation = simulation_of(live);
  Recorded recorded;
  recorded.frames->rows.names = {"time", "contacts"};
  for (int frame = 0; frame < frames; ++frame) {
    const DetectResult& result = frame == 0 ? simulation.detect() : simulation.step();
    auto& positions = recorded.frames->positions.emplace_back();
    for (const ObjectId id : simulation.scene().objects())
      positions.emplace_back(simulation.positions(id).begin(), simulation.positions(id).end());
    recorded.contacts.emplace_back(result.contacts.begin(), result.contacts.end());
    recorded.impacts.emplace_back(result.continuous_contacts.begin(), result.continuous_contacts.end());
    const auto count = static_cast<double>(result.stats.contacts);
    recorded.frames->rows.values.insert(recorded.frames->rows.values.end(), {simulation.time(), count});
    const auto number = static_cast<std::uint32_t>(frame);
    for (const ObjectPair& pair : result.volume_events.begin)
      recorded.frames->rows.volumes.begin.push_back({number, pair.a.index, pair.b.index});
    for (const ObjectPair& pair : result.contact_events.begin)
      recorded.frames->rows.contacts.begin.push_back({number, pair.a.index, pair.b.index});
    for (const ObjectPair& pair : result.contact_events.end)
      recorded.frames->rows.contacts.end.push_back({number, pair.a.index, pair.b.index});
  }
  recorded.show = live;
  for (std::size_t i = 0; i < live.objects.size(); ++i) {
    recorded.show.objects[i].motion = {};
    recorded.show.objects[i].mesh.positions = recorded.frames->positions[0][i];
  }
  recorded.show.frames = recorded.frames;
  return recorded;
}

std::size_t contact_count(const ViewerMessage& frame) {
  return count_of(frame, "contacts");
}

/// Returns the first two messages: the scene and the series.
std::vector<ViewerMessage> opening(TestPage& page) {
  std::vector<ViewerMessage> messages = page.drain();
  EXPECT_EQ(messages.size(), 2u);
  EXPECT_EQ(messages.at(0).kind, ViewerMessage::scene);
  EXPECT_EQ(messages.at(1).kind, ViewerMessage::series);
  return messages;
}

TEST(ViewerRecording, TellsSceneAndSeries) {
  const Recorded recorded = record(60);
  TestPage page(recorded.show);
  const std::vector<ViewerMessage> messages = opening(page);
  const Json& scene = messages[0].json;
  EXPECT_EQ(scene["source"], "recording");
  EXPECT_EQ(scene["frames"], 60);
  EXPECT_EQ(scene["can"], (Json{"play", "seek", "set"}));
  EXPECT_EQ(scene["series"], (Json{"time", "contacts"}));
  const ViewerMessage& series = messages[1];
  EXPECT_EQ(series.section(64).count, 60u);
  EXPECT_EQ(series.values<double>(64), recorded.frames->rows.values);
  using Event = std::array<std::uint32_t, 3>;
  const auto begin = series.values<Event>(65);
  ASSERT_EQ(begin.size(), 1u);
  const Series::Event& expected = recorded.frames->rows.contacts.begin[0];
  EXPECT_EQ(begin[0], (Event{expected.frame, expected.a, expected.b}));
  const std::vector<Series::Event>& volumes = recorded.frames->rows.volumes.begin;
  ASSERT_FALSE(volumes.empty());
  ASSERT_EQ(series.values<Event>(69).size(), volumes.size());
  EXPECT_EQ(series.values<Event>(69)[0], (Event{volumes[0].frame, volumes[0].a, volumes[0].b}));
  EXPECT_EQ(series.section(67).count, 0u) << "without colliding vertices";
}

TEST(ViewerRecording, PinsHaveTheirSpeedInEachFrameThatIsVisited) {
  const Recorded recorded = record(30);
  TestPage page(recorded.show);
  const std::vector<ViewerMessage> messages = opening(page);
  const Json& names = messages[0].json["pin_values"];
  std::size_t speed = 2;
  while (names[speed - 2]["key"] != "speed") ++speed;
  const auto mean = [&](std::uint32_t frame) {
    const std::vector<Vec3d>& positions = recorded.frames->positions[frame][1];
    Vec3d sum{};
    for (const Vec3d& p : positions) sum = sum + p;
    return (1.0 / static_cast<double>(positions.size())) * sum;
  };
  page.ask({{"do", "pins"}, {"pins", {{{"pin", 1}, {"objects", {1}}}}}});
  for (const std::uint32_t number : {12u, 3u, 4u, 29u}) {
    page.ask({{"do", "seek"}, {"frame", number}});
    page.session.advance(0);
    const auto row = page.frame().values<double>(63, 1);
    ASSERT_EQ(row.size(), 2 + names.size());
    EXPECT_EQ(row[0], number);
    const double time =
        recorded.frames->rows.values[2 * number] - recorded.frames->rows.values[2 * number - 2];
    EXPECT_NEAR(row[speed], norm(mean(number) - mean(number - 1)) / time, 1e-9);
  }
  recorded.frames->damaged = {19};
  page.ask({{"do", "seek"}, {"frame", 20}});
  page.session.advance(0);
  EXPECT_TRUE(std::isnan(page.frame().values<double>(63, 1)[speed])) << "the frame before cannot be read";
}

TEST(ViewerRecording, EachFrameIsDetectedAsItWas) {
  const Recorded recorded = record(60);
  TestPage page(recorded.show);
  const Vec3d center = center_of(opening(page)[0]);
  page.ask({{"do", "pause"}});
  std::size_t most = 0;
  // Seek forwards, backwards and over long distances.
  std::vector<std::uint32_t> order;
  for (std::uint32_t i = 0; i < 60; ++i) order.push_back(i * 37 % 60);
  for (const std::uint32_t number : order) {
    page.ask({{"do", "seek"}, {"frame", number}});
    page.session.advance(0);
    const ViewerMessage frame = page.frame();
    ASSERT_EQ(frame.json["step"], number);
    EXPECT_DOUBLE_EQ(frame.json["time"], 0.01 * number);
    EXPECT_EQ(contact_count(frame), recorded.contacts[number].size());
    if (frame.has(32, 1)) {
      EXPECT_EQ(frame.values<Vec3f>(32, 1), as_floats(recorded.frames->positions[number][1], center));
    }
    EXPECT_FALSE(number != order[0] && frame.has(32, 2)) << "the wall is sent once";
    most = std::max(most, contact_count(frame));
  }
  EXPECT_GT(most, 0u);
}

TEST(ViewerRecording, WhatIsReadAfterASeekIsOfThatFrame) {
  const Recorded recorded = record(20);
  TestPage page(recorded.show);
  opening(page);
  page.ask({{"do", "pause"}});
  for (const std::uint32_t number : {15u, 3u}) {
    page.ask({{"do", "seek"}, {"frame", number}});
    const Vec3d expected = recorded.frames->positions[number][1][0];
    const Json answer = page.ask({{"do", "read"}, {"object", 1}, {"vertex", 0}});
    EXPECT_EQ(answer["position"], (Json{expected.x, expected.y, expected.z}));
  }
}

TEST(ViewerRecording, ContinuousContactsAreThoseOfTheWayFromTheFrameBefore) {
  const Recorded recorded = record(60, ContactKinds::continuous);
  TestPage page(recorded.show);
  opening(page);
  page.ask({{"do", "pause"}});
  std::size_t most = 0;
  for (std::uint32_t i = 0; i < 60; ++i) {
    const std::uint32_t number = i < 30 ? i * 2 : (89 - i) * 2 - 59;
    page.ask({{"do", "seek"}, {"frame", number}});
    page.session.advance(0);
    const ViewerMessage frame = page.frame();
    ASSERT_EQ(frame.json["step"], number);
    ASSERT_EQ(count_of(frame, "continuous_contacts"), recorded.impacts[number].size()) << number;
    const auto times = column_of<float>(frame, "continuous_contacts", "toi");
    for (std::size_t c = 0; c < times.size(); ++c)
      EXPECT_EQ(times[c], static_cast<float>(recorded.impacts[number][c].toi));
    most = std::max(most, times.size());
  }
  EXPECT_GT(most, 0u);
}

TEST(ViewerRecording, PlaysInItsOwnTimeAndLeavesOutWhatIsLate) {
  TestPage page(record(60).show);
  opening(page);
  Session& session = page.session;
  session.advance(0.1);
  const ViewerMessage first = page.frame();
  EXPECT_EQ(first.json["step"], 0);
  EXPECT_EQ(first.json["playing"], false) << "recordings open paused";
  page.ask({{"do", "play"}});
  EXPECT_NEAR(session.advance(0), 0.01, 1e-12);
  EXPECT_EQ(page.frame().json["playing"], true);
  EXPECT_NEAR(session.advance(0.004), 0.006, 1e-12);
  EXPECT_NEAR(session.advance(0.006), 0.01, 1e-9);
  EXPECT_EQ(page.frame().json["step"], 1);
  session.advance(0.1);  // late by ten frames
  EXPECT_EQ(page.frame().json["step"], 11);
  page.ask({{"do", "speed"}, {"factor", 2}});
  session.advance(0.05);
  EXPECT_EQ(page.frame().json["step"], 21);
  page.ask({{"do", "speed"}, {"factor", 0}});
  session.advance(0.05);
  EXPECT_EQ(page.frame().json["step"], 22);
  page.ask({{"do", "speed"}, {"factor", 1}});
  for (int i = 0; i < 10; ++i) session.advance(0.2);
  const ViewerMessage end = page.frame();
  EXPECT_EQ(end.json["step"], 59);
  EXPECT_EQ(end.json["playing"], false);
  page.ask({{"do", "play"}});  // restarts from the beginning
  session.advance(0);
  const ViewerMessage again = page.frame();
  EXPECT_EQ(again.json["step"], 0);
  EXPECT_EQ(again.json["playing"], true);
}

TEST(ViewerRecording, LoopsAndStepsBothWaysWithinItsEnds) {
  TestPage page(record(20).show);
  opening(page);
  Session& session = page.session;
  page.frame();
  page.ask({{"do", "play"}});
  page.ask({{"do", "loop"}, {"on", true}});
  page.ask({{"do", "speed"}, {"factor", 0}});
  std::vector<int> seen;
  for (int i = 0; i < 45; ++i) {
    session.advance(0.01);
    seen.push_back(page.frame().json["step"]);
  }
  for (int i = 0; i < 45; ++i) EXPECT_EQ(seen[static_cast<std::size_t>(i)], (i + 1) % 20);
  page.ask({{"do", "speed"}, {"factor", 1}});
  for (int i = 0; i < 100; ++i) session.advance(0.01);
  EXPECT_EQ(page.frame().json["playing"], true);

  const auto step = [&](int count) {
    page.ask({{"do", "step"}, {"count", count}});
    session.advance(0);
    return page.frame().json["step"].get<int>();
  };
  page.ask({{"do", "seek"}, {"frame", 10}});
  session.advance(0);
  EXPECT_EQ(page.frame().json["step"], 10);
  EXPECT_EQ(step(3), 13);
  EXPECT_EQ(step(-5), 8);
  EXPECT_EQ(step(-100), 0);
  EXPECT_EQ(step(1000), 19);
  EXPECT_FALSE(page.failure(R"({"do": "seek", "frame": 20})").empty());
  EXPECT_FALSE(page.failure(R"({"do": "grab", "object": 0, "vertex": 0})").empty());
  EXPECT_FALSE(page.failure(R"({"do": "reset"})").empty());
  EXPECT_FALSE(page.failure(R"({"do": "set", "objects": 2})").empty());
}

/// Both recordings at once: each has its own contacts, and no pair of objects of both is tested.
TEST(ViewerRecording, ComparedRecordingsDoNotTouchEachOther) {
  const Recorded recorded = record(60);
  auto both = std::make_shared<StoredFrames>(*recorded.frames);
  SceneView show = recorded.show;
  const std::size_t count = show.objects.size();
  for (std::size_t i = 0; i < count; ++i) show.objects.push_back(recorded.show.objects[i]);
  for (auto& frame : both->positions) {
    for (std::size_t i = 0; i < count; ++i) frame.push_back(frame[i]);
  }
  show.frames = both;
  show.comparison = Comparison{{"a.h5", "b.h5"}, count, 7, "a vertex differs"};
  TestPage page(show);
  const Json scene = opening(page)[0].json;
  EXPECT_EQ(
      scene["comparison"],
      (Json{
          {"names", {"a.h5", "b.h5"}}, {"objects_of_a", count}, {"frame", 7}, {"text", "a vertex differs"}}));
  page.ask({{"do", "layers"}, {"colliding_vertices", true}});
  std::size_t most = 0;
  for (const std::uint64_t frame : {0u, 20u, 40u, 59u}) {
    page.ask({{"do", "seek"}, {"frame", frame}});
    page.session.advance(0);
    const ViewerMessage message = page.frame();
    EXPECT_EQ(contact_count(message), 2 * recorded.contacts[frame].size());
    most = std::max(most, contact_count(message));
    for (const char* const list : {"object_pairs", "contacts"}) {
      const auto a = column_of<std::uint32_t>(message, list, "object_a");
      const auto b = column_of<std::uint32_t>(message, list, "object_b");
      for (std::size_t row = 0; row < a.size(); ++row) EXPECT_EQ(a[row] < count, b[row] < count);
    }
  }
  EXPECT_GT(most, 0u);
}

/// Frames that are added while the recording is shown.
TEST(ViewerRecording, GrowsAndFollows) {
  Recorded recorded = record(60);
  auto frames = std::make_shared<GrowingFrames>();
  *static_cast<StoredFrames*>(frames.get()) = *recorded.frames;
  frames->show_first(20);
  frames->has_news = false;
  recorded.show.frames = frames;
  TestPage page(recorded.show);
  opening(page);
  page.session.advance(0);
  ViewerMessage frame = page.frame();
  EXPECT_EQ(frame.json["step"], 19) << "starts at the newest frame";
  EXPECT_EQ(frame.json["playing"], true);
  for (int i = 0; i < 50; ++i) page.session.advance(0.01);
  EXPECT_TRUE(page.drain().empty()) << "waits for more frames";
  frames->show_first(25);
  page.session.advance(0.01);
  const ViewerMessage series = page.only(ViewerMessage::series);
  EXPECT_EQ(series.section(64).count, 25u);
  for (int i = 0; i < 3; ++i) page.session.advance(0.01);
  frame = page.frame();
  EXPECT_EQ(frame.json["range"], (Json{0, 24}));
  EXPECT_GT(frame.json["step"], 19);
  EXPECT_LT(frame.json["step"], 25);
  EXPECT_EQ(contact_count(frame), recorded.contacts[frame.json["step"].get<std::size_t>()].size());
  page.ask({{"do", "seek"}, {"frame", 24}});
  page.session.advance(0);
  EXPECT_EQ(page.frame().json["step"], 24);
  frames->problem = "run.h5: was recorded again; open it again";
  page.session.advance(0.01);
  EXPECT_EQ(page.only(ViewerMessage::failure).json["message"], frames->problem);
  EXPECT_EQ(page.frame().json["step"], 24);
}

TEST(ViewerRecording, AFrameThatCannotBeReadLeavesAllAsItWas) {
  const Recorded recorded = record(60);
  TestPage page(recorded.show);
  opening(page);
  page.ask({{"do", "pause"}});
  page.ask({{"do", "seek"}, {"frame", 40}});
  page.session.advance(0);
  const ViewerMessage before = page.frame();
  EXPECT_GT(contact_count(before), 0u);
  recorded.frames->damaged = {41};
  page.ask({{"do", "seek"}, {"frame", 41}});
  page.session.advance(0);
  const ViewerMessage failure = page.only(ViewerMessage::failure);
  EXPECT_EQ(failure.json["message"], "run.h5: frame 41 is damaged");
  EXPECT_EQ(failure.json["fatal"], false);
  page.session.advance(0);
  const ViewerMessage after = page.frame();
  EXPECT_EQ(after.json["step"], 40);
  EXPECT_EQ(contact_count(after), contact_count(before));
  EXPECT_FALSE(after.has(32, 1));
  page.ask({{"do", "play"}});  // stops before the damaged frame
  for (int i = 0; i < 5; ++i) page.session.advance(0.01);
  EXPECT_EQ(page.only(ViewerMessage::failure).json["message"], "run.h5: frame 41 is damaged");
  EXPECT_EQ(page.frame().json["playing"], false);
  page.ask({{"do", "seek"}, {"frame", 42}});
  page.session.advance(0);
  EXPECT_EQ(page.frame().json["step"], 42);
}

TEST(ViewerRecording, SetDetectsTheSameFrameAnew) {
  const Recorded recorded = record(60);
  TestPage page(recorded.show);
  opening(page);
  page.ask({{"do", "pause"}});
  page.ask({{"do", "seek"}, {"frame", 45}});
  page.session.advance(0);
  page.say({{"do", "set"}, {"bounding_volume", "sphere"}, {"max_level", 3}, {"broad_phase", "sweep"}});
  EXPECT_EQ(opening(page)[0].json["bounding_volume"], "sphere");
  const ViewerMessage frame = page.frame();
  EXPECT_EQ(frame.json["step"], 45);
  EXPECT_EQ(contact_count(frame), recorded.contacts[45].size());
  page.say({{"do", "set"}, {"contacts", "continuous"}});
  opening(page);
  EXPECT_GT(count_of(page.frame(), "continuous_contacts"), 0u);
}

TEST(ViewerRecording, WithoutSeriesOrWithoutFramesItIsFine) {
  Recorded recorded = record(5);
  recorded.frames->rows = {};
  TestPage page(recorded.show);
  const std::vector<ViewerMessage> messages = opening(page);
  EXPECT_EQ(messages[0].json["series"], Json::array());
  EXPECT_EQ(messages[1].section(64).count, 0u);
  page.ask({{"do", "seek"}, {"frame", 4}});
  page.session.advance(0);
  EXPECT_DOUBLE_EQ(page.frame().json["time"], 0.04);

  recorded.frames->positions.clear();
  TestPage empty(recorded.show);
  EXPECT_EQ(opening(empty)[0].json["frames"], 0);
  empty.session.advance(1);
  EXPECT_EQ(empty.frame().json["step"], 0);
  empty.ask({{"do", "step"}, {"count", 1}});
  empty.ask({{"do", "play"}});
  empty.session.advance(1);
  EXPECT_EQ(empty.frame().json["step"], 0);
}

TEST(ViewerRecording, PackedFramesAreThoseOfTheRecordingAsFloats) {
  const Recorded recorded = record(60);
  const SceneView packed = unpack(pack(recorded.show));
  TestPage page(packed), original(recorded.show);
  const auto told = opening(page), told_there = opening(original);
  EXPECT_EQ(told[0].json, told_there[0].json);
  EXPECT_EQ(told[1].values<double>(64), recorded.frames->rows.values);
  std::vector<Vec3d> positions(92);
  for (const std::uint64_t frame : {0, 17, 59}) {
    for (std::size_t object = 0; object < 3; ++object) {
      packed.frames->read(frame, object, positions);
      for (std::size_t i = 0; i < positions.size(); ++i) {
        const Vec3d p = recorded.frames->positions[frame][object][i];
        for (int axis = 0; axis < 3; ++axis) ASSERT_NEAR(positions[i][axis], p[axis], 2e-7);
        if (object != 1) {
          ASSERT_EQ(positions[i], p) << "positions of objects at rest are exact";
        }
      }
    }
  }
  EXPECT_THROW(packed.frames->read(60, 0, positions), Error);
}

}  // namespace supple::viewer::session_recording_test
