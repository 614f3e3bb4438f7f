#include "session/packed/packed_scene.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <string>
#include <vector>

#include "../../support/soups.hpp"
#include "../../support/viewer_page.hpp"
#include "session/messages/described_json.hpp"
#include "session/messages/json_text.hpp"
#include "session/settings.hpp"
#include "unit/descriptions/other_values.hpp"

namespace supple::viewer::packed_scene_test {

/// A scene in which all options differ from their defaults, with a wave, a mass-spring and a static object.
SceneView rich_scene() {
  SceneView scene;
  scene.title = "rich";
  scene.simulation = other_values<SimulationOptions>();
  scene.simulation.time_step = 0.004;
  scene.objects = {test_ball("waves", {}, 2), test_ball("soft", {3, 0, 0}, 2),
                   test_ball("wall", {0, 3, 0}, 1)};
  for (ViewedObject& object : scene.objects) {
    object.options = other_values<ObjectOptions>();
    object.options.is_static = false;
  }
  scene.objects[0].motion = other_values<WaveMotion>();
  scene.objects[1].motion = other_values<MassSpringMotion>();
  scene.objects[2].options.is_static = true;
  scene.objects[2].mesh.positions[0].x = std::numeric_limits<double>::quiet_NaN();
  return scene;
}

TEST(PackedScene, KeepsEveryOption) {
  const SceneView scene = rich_scene();
  const SceneView again = unpack(pack(scene));
  using Keys = std::vector<std::string>;
  EXPECT_EQ(differences_of(again.simulation, scene.simulation), keys_of_machine<SimulationOptions>());
  ASSERT_EQ(again.objects.size(), scene.objects.size());
  for (std::size_t i = 0; i < scene.objects.size(); ++i)
    EXPECT_EQ(differences_of(again.objects[i].options, scene.objects[i].options), Keys{});
  EXPECT_EQ(differences_of(std::get<WaveMotion>(again.objects[0].motion),
                           std::get<WaveMotion>(scene.objects[0].motion)),
            Keys{});
  EXPECT_EQ(differences_of(std::get<MassSpringMotion>(again.objects[1].motion),
                           std::get<MassSpringMotion>(scene.objects[1].motion)),
            keys_of_machine<MassSpringMotion>());
}

TEST(PackedScene, KeepsLinesAndPoints) {
  SceneView scene;
  scene.objects = {test_ball("rods", {}, 2)};
  scene.objects[0].mesh.edges = {{0, 1}, {1, 2}};
  scene.objects[0].mesh.points = {3};
  const SceneView again = unpack(pack(scene));
  ASSERT_EQ(again.objects.size(), 1u);
  EXPECT_EQ(again.objects[0].mesh.edges, scene.objects[0].mesh.edges);
  EXPECT_EQ(again.objects[0].mesh.points, scene.objects[0].mesh.points);
}

TEST(PackedScene, KeepsRigidMotion) {
  SceneView scene;
  scene.objects = {test_ball("rigid", {}, 2)};
  scene.objects[0].motion = other_values<RigidMotion>();
  const SceneView again = unpack(pack(scene));
  ASSERT_EQ(again.objects.size(), 1u);
  EXPECT_EQ(differences_of(std::get<RigidMotion>(again.objects[0].motion),
                           std::get<RigidMotion>(scene.objects[0].motion)),
            std::vector<std::string>{});
}

/// The JSON value that the session sends for an option.
template <class Struct, class Value>
Json json_of(const Field<Struct, Value>& field, const Value& value) {
  JsonText json;
  json.clear();
  json.begin_array();
  write_value(json, field, value);
  json.end_array();
  return Json::parse(json.text())[0];
}

template <class Options>
void expect_options(const Json& message, const Options& options) {
  for_each_leaf(
      [&](const auto& field, const auto& value) {
        if (is_setting(field)) {
          EXPECT_EQ(message.at(field.key), json_of(field, value)) << field.key;
        }
      },
      options);
}

TEST(PackedScene, ThePageSeesEveryOption) {
  const SceneView scene = rich_scene();
  TestPage page(unpack(pack(scene)));
  const Json message = page.scene().json;
  expect_options(message, scene.simulation.scene);
  expect_options(message, scene.objects[0].options.octree);
}

TEST(PackedScene, ThePageSetsEveryOption) {
  SceneView scene;
  scene.objects = {test_ball("a", {}, 1)};
  TestPage page(scene);
  page.scene();
  Json command{{"do", "set"}};
  const auto add = [&](const auto& options) {
    for_each_leaf(
        [&](const auto& field, const auto& value) {
          if (is_setting(field)) command[field.key] = json_of(field, value);
        },
        options);
  };
  const auto others = other_values<SceneOptions>();
  const auto octree = other_values<ObjectOctreeOptions>();
  add(others);
  add(octree);
  page.say(command);
  const Json message = page.scene().json;
  expect_options(message, others);
  expect_options(message, octree);
}

std::vector<std::vector<std::byte>> frames_of(const SceneView& show, int count) {
  TestPage page(show);
  std::vector<std::vector<std::byte>> frames;
  const auto keep = [&] {
    for (auto bytes = page.next_bytes(); !bytes.empty(); bytes = page.next_bytes())
      frames.emplace_back(bytes.begin(), bytes.end());
  };
  for (int i = 0; i < count; ++i) {
    page.say({{"do", "credit"}, {"frames", 1}});
    keep();
    page.session.advance(0.004);
  }
  return frames;
}

/// Compares all sections except the statistics, which contain times.
void expect_equal_frames(const std::vector<std::vector<std::byte>>& a,
                         const std::vector<std::vector<std::byte>>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    // Messages are read in place, so the copies need the right alignment.
    std::vector<std::max_align_t> x((a[i].size() + sizeof(std::max_align_t) - 1) / sizeof(std::max_align_t)),
        y = x;
    ASSERT_EQ(a[i].size(), b[i].size());
    std::memcpy(x.data(), a[i].data(), a[i].size());
    std::memcpy(y.data(), b[i].data(), b[i].size());
    ViewerMessage p(std::as_bytes(std::span(x)).first(a[i].size())),
        q(std::as_bytes(std::span(y)).first(b[i].size()));
    EXPECT_EQ(p.json, q.json);
    ASSERT_EQ(p.sections.size(), q.sections.size());
    for (const auto& [key, section] : p.sections)
      if (key.first != 43) {
        EXPECT_EQ(section.data, q.sections.at(key).data) << key.first;
      }
  }
}

TEST(PackedScene, PlaysAsTheShowDoes) {
  const SceneView show = rich_scene();
  const auto bytes = pack(show);
  const SceneView again = unpack(bytes);
  EXPECT_EQ(pack(again), bytes);
  expect_equal_frames(frames_of(show, 30), frames_of(again, 30));
  EXPECT_EQ(unpack(pack(SceneView{})).objects.size(), 0u);
}

std::string failure(std::span<const std::byte> bytes) {
  try {
    unpack(bytes);
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

TEST(PackedScene, WhatItIsNotIsSaid) {
  const auto bytes = pack(rich_scene());
  EXPECT_EQ(failure({}), "this is not a packed scene; export the page again");
  for (std::size_t length = 0; length < bytes.size(); length += 1 + length / 50)
    EXPECT_FALSE(failure(std::span(bytes).first(length)).empty()) << length;
  auto longer = bytes;
  longer.push_back(std::byte{0});
  EXPECT_FALSE(failure(longer).empty());
  auto other = bytes;
  other[8] = std::byte{'9'};
  EXPECT_NE(failure(other).find("was packed by version 9"), std::string::npos) << failure(other);
}

/// Updates the checksum of bytes that were modified on purpose.
void mend_checksum(std::vector<std::byte>& bytes) {
  const std::span<const std::byte> content = std::span(bytes).subspan(32);
  std::uint64_t hash = 0xcbf29ce484222325u ^ content.size();
  for (std::size_t i = 0; i < content.size(); i += 8) {
    std::uint64_t word = 0;
    std::memcpy(&word, content.data() + i, std::min<std::size_t>(8, content.size() - i));
    hash = (hash ^ word) * 0x100000001b3u;
    hash ^= hash >> 32;
  }
  std::memcpy(bytes.data() + 24, &hash, sizeof(hash));
}

/// Two frames; one object moves.
struct TwoFrames final : Frames {
  Series rows{{"time"}, {0, 0.1}, {{{1, 0, 1}}, {}}};
  std::uint64_t count() const override { return 2; }
  void read(std::uint64_t frame, std::size_t object, std::span<Vec3d> positions) const override {
    const ViewedObject ball = test_ball("", {object == 1 ? static_cast<double>(frame) : 0.0, 0, 0}, 1);
    std::copy(ball.mesh.positions.begin(), ball.mesh.positions.end(), positions.begin());
  }
  const Series& series() const override { return rows; }
};

SceneView recorded_show() {
  SceneView show;
  show.objects = {test_ball("a", {}, 1), test_ball("b", {}, 1)};
  show.frames = std::make_shared<TwoFrames>();
  return show;
}

TEST(PackedScene, DamagedBytesNeverDoHarm) {
  RandomNumbers random(4);
  for (const SceneView& show : {rich_scene(), recorded_show()}) {
    const auto bytes = pack(show);
    int refused = 0, taken = 0;
    for (int round = 0; round < 1500; ++round) {
      auto changed = bytes;
      // Most changes are in the first part, which has the counts and options.
      const auto near = static_cast<std::uint32_t>(std::min<std::size_t>(bytes.size(), 400));
      const auto all = static_cast<std::uint32_t>(bytes.size());
      for (std::uint32_t i = 0; i <= random.below(4); ++i)
        changed[round % 3 == 0 ? random.below(all) : random.below(near)] =
            static_cast<std::byte>(random.below(256));
      if (round % 5 == 0) changed.resize(random.below(all));
      if (changed == bytes) continue;
      EXPECT_FALSE(failure(changed).empty());
      if (changed.size() < 32) continue;
      std::memcpy(changed.data(), bytes.data(), 24);
      mend_checksum(changed);
      SceneView read;
      try {
        read = unpack(changed);
      } catch (const Error&) {
        ++refused;
        continue;
      }
      ++taken;
      // A session must either refuse the modified scene or play it.
      try {
        TestPage page(std::move(read));
        page.drain();
        page.say({{"do", "credit"}, {"frames", 1}});
        page.drain();
      } catch (const Error&) {
      }
    }
    EXPECT_GT(refused, 50);
    EXPECT_GT(taken, 50);
  }
}

}  // namespace supple::viewer::packed_scene_test
