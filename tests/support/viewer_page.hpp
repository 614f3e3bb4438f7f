#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "session/lists/lists_of_frames.hpp"
#include "session/scene_view.hpp"
#include "session/session.hpp"
#include "supple/models.hpp"
#include "supple/simulation.hpp"
#include "supple/wave_motion.hpp"
#include "viewer_messages.hpp"

namespace supple::viewer {

using Json = nlohmann::json;
/// Types of the elements in sections.
using StepPair = std::array<std::uint32_t, 3>;
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

/// The number of the section of a column; the first one of the list without a name.
inline std::uint32_t section_of(std::string_view name, std::string_view column = "") {
  std::uint32_t number = 0;
  for (const ListOfFrames& list : lists_of_frames()) {
    for (const Column& each : list.columns) {
      if (name == list.info->name && (column.empty() || column == each.name)) return number;
      ++number;
    }
  }
  throw std::runtime_error("no column " + std::string(column) + " of " + std::string(name));
}
/// The column of a list in a frame. Empty when the list is.
template <class Value>
std::vector<Value> column_of(const ViewerMessage& frame, std::string_view list, std::string_view name) {
  const std::uint32_t section = section_of(list, name);
  return frame.has(33, section) ? frame.values<Value>(33, section) : std::vector<Value>{};
}
inline std::uint32_t count_of(const ViewerMessage& frame, std::string_view list) {
  return frame.has(33, section_of(list)) ? frame.section(33, section_of(list)).count : 0;
}
/// Object and triangle of both sides of each contact.
inline std::vector<std::array<std::uint32_t, 4>> contacts_in(const ViewerMessage& frame) {
  std::vector<std::array<std::uint32_t, 4>> contacts(count_of(frame, "contacts"));
  std::size_t place = 0;
  for (const char* name : {"object_a", "triangle_a", "object_b", "triangle_b"}) {
    const auto column = column_of<std::uint32_t>(frame, "contacts", name);
    for (std::size_t i = 0; i < contacts.size(); ++i) contacts[i][place] = column[i];
    ++place;
  }
  return contacts;
}
/// All columns of all lists.
inline std::map<std::uint32_t, std::vector<std::byte>> columns_of(const ViewerMessage& frame) {
  std::map<std::uint32_t, std::vector<std::byte>> found;
  for (const auto& [key, section] : frame.sections) {
    if (key.first == 33) found[key.second] = section.data;
  }
  return found;
}

/// Expects that the rows of a list in a frame are those of the library, member by member.
template <class Row>
void expect_rows(const ViewerMessage& frame, const char* name, std::span<const Row> expected, Vec3d center) {
  ASSERT_EQ(count_of(frame, name), expected.size());
  const ListOfFrames& list = lists_of_frames()[place_of_list(name)];
  for (const Column& column : list.columns) {
    const auto expect = [&](const auto& sent, const auto& member) {
      for (std::size_t i = 0; i < sent.size(); ++i) {
        const auto* const row = reinterpret_cast<const std::byte*>(&expected[i / column.width]);
        ASSERT_EQ(sent[i], member(row, i % column.width)) << name << " " << column.name;
      }
    };
    const auto whole = [&](const std::byte* row, std::size_t k) { return number_of(*column.field, row, k); };
    const auto real = [&](const std::byte* row, std::size_t k) {
      const double origin = !column.is_position ? 0 : k == 0 ? center.x : k == 1 ? center.y : center.z;
      return static_cast<float>(real_number(*column.field, row, k) - origin);
    };
    if (column.scalar == ScalarOfSection::float32)
      expect(column_of<float>(frame, name, column.name), real);
    else if (column.scalar == ScalarOfSection::uint32)
      expect(column_of<std::uint32_t>(frame, name, column.name), whole);
    else
      expect(column_of<std::uint8_t>(frame, name, column.name), whole);
  }
}

/// Expects that the contacts and contact points of a frame equal those of the library.
inline void expect_contacts(const ViewerMessage& frame, const DetectResult& result, Vec3d center) {
  expect_rows(frame, "contacts", result.contacts, center);
  expect_rows(frame, "contact_points", result.contact_points, center);
  expect_rows(frame, "object_pairs", result.object_pairs, center);
}

}  // namespace supple::viewer
