#include "session/packed_scene.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <string>
#include <vector>

#include "../../support/soups.hpp"
#include "../../support/viewer_page.hpp"

namespace supple::viewer {
namespace {

/// Something of everything that a show can have, nothing being what it is by default.
SceneView rich_show() {
  SceneView show;
  show.title = "rich";
  show.simulation.border = Border{{{-5, -6, -7}, {8, 9, 10}}};
  show.simulation.seed = 77;
  show.simulation.time_step = 0.004;
  show.simulation.response = {
      .enabled = true, .thickness = 2e-3, .restitution = 0.1, .friction = 0.2, .iterations = 3};
  show.simulation.scene.broad_phase = BroadPhaseMethod::octree;
  show.simulation.scene.scene_octree = {.max_level = 5, .expand_at = 3};
  show.objects = {test_ball("waves", {}, 2), test_ball("soft", {3, 0, 0}, 2),
                  test_ball("wall", {0, 3, 0}, 1)};
  show.objects[0].motion = WaveMotion{{0.1, 0.2, 0.3}, 0.05, 0.9, 1.5, 12};
  MassSpringMotion motion;
  motion.springs = {.integrator = Integrator::symplectic_euler,
                    .substeps = 2,
                    .stiffness = 40,
                    .gravity = {0, -1, 0},
                    .max_strain = 0.4,
                    .fixed_vertices = {3}};
  motion.random_speed = 0.5;
  motion.random_force = 0.1;
  motion.deform_seconds = 0.02;
  motion.seed = 9;
  motion.handles = {{.vertices = {1, 2}, .by = {0, 1, 0}, .seconds = 0.5}};
  show.objects[1].motion = motion;
  show.objects[1].options.octree = {.max_level = 6, .leaf_size = 12, .arity = 4};
  show.objects[2].options.is_static = true;
  show.objects[2].mesh.positions[0].x = std::numeric_limits<double>::quiet_NaN();
  return show;
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

/// Without the statistics, which measure time.
void expect_equal_frames(const std::vector<std::vector<std::byte>>& a,
                         const std::vector<std::vector<std::byte>>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    // Copies: what is read in place has an alignment.
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
  const SceneView show = rich_show();
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
  const auto bytes = pack(rich_show());
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

/// The number that tells whether the bytes are damaged, for bytes that were changed on purpose.
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

/// Single frames, of which one object moves.
struct TwoFrames final : Frames {
  Series rows{{"time"}, {0, 0.1}, {{1, 0, 1}}, {}};
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
  for (const SceneView& show : {rich_show(), recorded_show()}) {
    const auto bytes = pack(show);
    int refused = 0, taken = 0;
    for (int round = 0; round < 1500; ++round) {
      auto changed = bytes;
      // Most in the first part, where counts and options are.
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
      // Whatever it says now, a session refuses it or plays it.
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

}  // namespace
}  // namespace supple::viewer
