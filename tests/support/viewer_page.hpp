#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "session/scene_view.hpp"
#include "session/session.hpp"
#include "supple/models.hpp"
#include "supple/simulation.hpp"
#include "supple/wave_motion.hpp"
#include "viewer_messages.hpp"

namespace supple::viewer {

using Json = nlohmann::json;
/// Types of the elements in sections.
using Pair = std::array<std::uint32_t, 2>;
using StepPair = std::array<std::uint32_t, 3>;
using Ids = std::array<std::uint32_t, 8>;
using Row = std::array<float, 8>;

/// A page without a network. It sends commands to the session and reads its messages.
class TestPage {
 public:
  explicit TestPage(SceneView show, MemoryBudget budget = {}) : session(std::move(show), budget) {
    session.greet();
  }

  /// The next message as sent, or empty; valid until the next call.
  std::span<const std::byte> next_bytes() { return session.next_message(message_); }
  /// All pending messages.
  std::vector<ViewerMessage> drain() {
    std::vector<ViewerMessage> messages;
    for (auto bytes = next_bytes(); !bytes.empty(); bytes = next_bytes()) messages.emplace_back(bytes);
    return messages;
  }
  /// The only pending message.
  ViewerMessage only() {
    std::vector<ViewerMessage> messages = drain();
    if (messages.size() != 1) throw std::runtime_error(std::to_string(messages.size()) + " messages came");
    return messages.front();
  }
  ViewerMessage only(ViewerMessage::Kind kind) {
    ViewerMessage message = only();
    if (message.kind != kind)
      throw std::runtime_error("another kind of message came: " + message.json.dump());
    return message;
  }
  /// Returns the first message of a simulation, which is the scene.
  ViewerMessage scene() { return only(ViewerMessage::scene); }

  void say(const Json& command) { session.command(command.dump()); }
  /// Sends a command that must succeed, and returns its answer.
  Json ask(Json command) {
    command["id"] = ++last_id_;
    say(command);
    for (const ViewerMessage& message : drain()) {
      if (message.kind == ViewerMessage::failure) throw std::runtime_error(message.json.dump());
      if (message.kind != ViewerMessage::answer) continue;
      EXPECT_EQ(message.json["id"], last_id_);
      return message.json;
    }
    throw std::runtime_error("no answer to " + command.dump());
  }
  /// The error message of a command that must fail without other effects.
  std::string failure(const std::string& command) {
    session.command(command);
    const ViewerMessage message = only(ViewerMessage::failure);
    EXPECT_EQ(message.json["fatal"], false);
    return message.json["message"];
  }

  /// The newest frame, which the page then draws; the test fails without one.
  ViewerMessage frame() {
    say({{"do", "credit"}, {"frames", 1}});
    ViewerMessage frame = only(ViewerMessage::frame);
    say({{"do", "credit"}, {"frames", 0}});
    return frame;
  }
  /// Takes this many steps and returns the last frame.
  ViewerMessage frame_after_steps(int count) {
    ask({{"do", "step"}, {"count", count}});
    for (int i = 0; i < count; ++i) session.advance(0);
    return frame();
  }

  Session session;

 private:
  MessageWriter message_;
  int last_id_ = 0;
};

inline ViewedObject test_ball(const char* name, Vec3d at, std::uint32_t frequency = 3) {
  ViewedObject object{make_icosphere(frequency)};
  object.options.name = name;
  for (Vec3d& p : object.mesh.positions) p = p + at;
  return object;
}

/// A waving ball, a soft ball that flies towards it, and a ball at rest.
inline SceneView three_balls() {
  SceneView show;
  show.title = "balls";
  show.objects = {test_ball("waves", {}), test_ball("soft", {3, 0, 0}), test_ball("rest", {0, 0, 2.2})};
  show.objects[0].motion = WaveMotion{.amplitude = 0.05};
  show.objects[1].motion = MassSpringMotion{.velocity = {-1, 0, 0}};
  return show;
}

/// Two balls that intersect, and a waving ball at some distance.
inline SceneView touching_balls() {
  SceneView show;
  show.objects = {test_ball("left", {}), test_ball("right", {1.5, 0, 0}), test_ball("waves", {4, 0, 0})};
  show.objects[2].motion = WaveMotion{.velocity = {-1, 0.1, 0}, .amplitude = 0.05};
  return show;
}

/// The same simulation created with the library alone.
inline Simulation simulation_of(const SceneView& show) {
  Simulation simulation(show.simulation);
  for (const ViewedObject& object : show.objects) {
    if (const auto* const springs = std::get_if<MassSpringMotion>(&object.motion)) {
      simulation.add(object.mesh, object.options, *springs);
    } else if (const auto* const rigid = std::get_if<RigidMotion>(&object.motion)) {
      simulation.add(object.mesh, object.options, *rigid);
    } else if (const auto* const waves = std::get_if<WaveMotion>(&object.motion)) {
      const auto move = [waves = *waves, border = show.simulation.border, rest = object.mesh.positions](
                            double seconds, std::span<Vec3d> positions) {
        apply_wave_motion(waves, border, rest, seconds, positions);
      };
      TriangleMesh start = object.mesh;
      move(0, start.positions);
      simulation.add(start, object.options, move);
    } else {
      simulation.add(object.mesh, object.options);
    }
  }
  simulation.detect();
  return simulation;
}

inline Vec3d center_of(const ViewerMessage& scene) {
  return {scene.json["center"][0], scene.json["center"][1], scene.json["center"][2]};
}

inline std::vector<Vec3f> as_floats(std::span<const Vec3d> positions, Vec3d center) {
  std::vector<Vec3f> floats;
  for (const Vec3d& p : positions) {
    const Vec3d q = p - center;
    floats.push_back({static_cast<float>(q.x), static_cast<float>(q.y), static_cast<float>(q.z)});
  }
  return floats;
}

/// Expects that the contacts and contact points of a frame equal those of the library.
inline void expect_contacts(const ViewerMessage& frame, const DetectResult& result, Vec3d center) {
  std::vector<Ids> contacts;
  for (const Contact& c : result.contacts)
    contacts.push_back({c.object_a.index, c.triangle_a, c.object_b.index, c.triangle_b,
                        static_cast<std::uint32_t>(c.kind), c.point_count, c.first_point, 0});
  EXPECT_EQ(frame.values<Ids>(34), contacts);
  std::vector<Vec3d> points;
  for (const ContactPoint& point : result.contact_points) points.push_back(point.position);
  const std::vector<Vec3f> expected = as_floats(points, center);
  const std::vector<Row> sent = frame.has(35) ? frame.values<Row>(35) : std::vector<Row>{};
  ASSERT_EQ(sent.size(), expected.size());
  for (std::size_t i = 0; i < sent.size(); ++i)
    EXPECT_EQ((Vec3f{sent[i][0], sent[i][1], sent[i][2]}), expected[i]);
  std::vector<Pair> pairs;
  for (const ObjectPair& pair : result.object_pairs) pairs.push_back({pair.a.index, pair.b.index});
  EXPECT_EQ(frame.values<Pair>(33), pairs);
}

}  // namespace supple::viewer
