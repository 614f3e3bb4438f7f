// After one full pass over its motion, a playing viewer session allocates no memory in steps or frames.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "allocation_count.hpp"
#include "session/session.hpp"
#include "supple/models.hpp"
#include "supple/wave_motion.hpp"

namespace supple::viewer {
namespace {

constexpr int period = 50;  // number of steps after which all waves repeat
constexpr double time_step = 0.02;

ViewedObject ball(Vec3d at, std::uint64_t seed) {
  ViewedObject object{make_icosphere(6)};
  for (Vec3d& p : object.mesh.positions) p = p + at;
  object.motion = WaveMotion{.amplitude = 0.15, .period = period * time_step, .seed = seed};
  return object;
}

/// Waving balls that start and stop touching, and a mass-spring cloth at rest.
SceneView waves() {
  SceneView show;
  show.simulation.time_step = time_step;
  show.simulation.scene.threads = 1;
  for (std::uint64_t i = 0; i < 6; ++i) {
    const double x = 1.95 * static_cast<double>(i % 3), z = 1.95 * static_cast<double>(i / 3);
    show.objects.push_back(ball({x, 0, z}, i));
  }
  show.objects.push_back({make_cloth(12, 12)});
  show.objects.back().motion = MassSpringMotion{};
  return show;
}

/// One period of the same motion as frames in memory.
class WaveFrames final : public Frames {
 public:
  explicit WaveFrames(const SceneView& show) : objects_(show.objects) {}
  std::uint64_t count() const override { return period + 1; }
  void read(std::uint64_t frame, std::size_t object, std::span<Vec3d> positions) const override {
    const ViewedObject& moving = objects_[object];
    if (const WaveMotion* const motion = std::get_if<WaveMotion>(&moving.motion))
      apply_wave_motion(*motion, {}, moving.mesh.positions, static_cast<double>(frame) * time_step,
                        positions);
    else
      std::copy(moving.mesh.positions.begin(), moving.mesh.positions.end(), positions.begin());
  }
  const Series& series() const override { return series_; }

 private:
  std::vector<ViewedObject> objects_;
  Series series_;
};

struct Seen {
  std::uint64_t allocations = 0, frames = 0, least_bytes = ~std::uint64_t{0}, most_bytes = 0;
};

/// Plays the session step by step and takes each frame. Counts allocations in the last two of four periods.
Seen play(SceneView show, std::initializer_list<std::string_view> commands = {}) {
  Session session(std::move(show), {.history_bytes = 1});  // full after two steps
  MessageWriter message;
  session.greet();
  for (const std::string_view command : commands) session.command(command);
  session.command(R"({"do": "speed", "factor": 0})");
  while (!session.next_message(message).empty()) {
  }
  Seen seen;
  for (int step = 0; step < 4 * period; ++step) {
    session.command(R"({"do": "credit", "frames": 1})");
    const std::uint64_t before = allocation_count();
    session.advance(time_step);
    const std::uint64_t bytes = session.next_message(message).size();
    if (step < 2 * period) continue;
    seen.allocations += allocation_count() - before;
    if (bytes > 0) ++seen.frames;
    seen.least_bytes = std::min(seen.least_bytes, bytes);
    seen.most_bytes = std::max(seen.most_bytes, bytes);
  }
  return seen;
}

void expect_no_allocations(const Seen& seen) {
  EXPECT_EQ(seen.allocations, 0u);
  EXPECT_EQ(seen.frames, 2u * period);
  EXPECT_LT(seen.least_bytes + 1000, seen.most_bytes) << "the number of contacts varies";
}

TEST(SteadyStateSession, NoAllocationsInStepsOfASimulation) {
  expect_no_allocations(play(waves()));
}

TEST(SteadyStateSession, NoAllocationsWithContinuousContacts) {
  SceneView show = waves();
  show.simulation.scene.contacts = ContactKinds::continuous;
  expect_no_allocations(play(std::move(show)));
}

TEST(SteadyStateSession, NoAllocationsWithCollidingVertices) {
  expect_no_allocations(play(waves(), {R"({"do": "layers", "colliding_vertices": true})"}));
}

TEST(SteadyStateSession, NoAllocationsWithAField) {
  expect_no_allocations(play(waves(), {R"({"do": "layers", "field": "velocity"})"}));
  expect_no_allocations(play(waves(), {R"({"do": "layers", "field": "strain"})"}));
}

TEST(SteadyStateSession, NoAllocationsInFramesOfARecording) {
  for (const ContactKinds contacts : {ContactKinds::intersection, ContactKinds::continuous}) {
    SceneView show = waves();
    show.simulation.scene.contacts = contacts;
    show.frames = std::make_shared<WaveFrames>(show);
    expect_no_allocations(play(std::move(show), {R"({"do": "loop", "on": true})", R"({"do": "play"})"}));
  }
}

}  // namespace
}  // namespace supple::viewer
