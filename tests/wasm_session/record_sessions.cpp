// Plays sessions natively and writes files from which the test of the WebAssembly module repeats them: the
// packed scenes, the commands, and the SHA-256 of all messages without measured times.
//
// usage: record_sessions FOLDER

#include <openssl/evp.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "lists/lists_of_frames.hpp"
#include "packed/packed_scene.hpp"
#include "session.hpp"
#include "supple/models.hpp"
#include "support/hard_scenes.hpp"
#include "support/viewer_messages.hpp"

namespace {

using supple::viewer::SceneView;
using supple::viewer::ViewedObject;

constexpr std::uint32_t column_tag = 33, statistics_tag = 43;

/// The rows of a list in a frame.
std::uint32_t count_of(const supple::ViewerMessage& frame, std::string_view name) {
  std::uint32_t section = 0;
  for (const supple::viewer::ListOfFrames& list : supple::viewer::lists_of_frames()) {
    if (name == list.info->name)
      return frame.has(column_tag, section) ? frame.section(column_tag, section).count : 0;
    section += static_cast<std::uint32_t>(list.columns.size());
  }
  throw std::runtime_error("no list " + std::string(name));
}

/// The input of a session: each entry is a command as JSON text or a number of milliseconds to wait.
struct Script {
  std::string name;
  SceneView show;
  nlohmann::json entries = nlohmann::json::array();

  void command(const std::string& text) { entries.push_back(text); }
  void steps(int count, double milliseconds) {
    for (int i = 0; i < count; ++i) {
      command(R"({"do": "credit", "frames": 1})");
      entries.push_back(milliseconds);
    }
  }
};

/// The hash of whole messages, with zeros in place of measured times.
class MessageHash {
 public:
  MessageHash() : context_(EVP_MD_CTX_new(), &EVP_MD_CTX_free) {
    EVP_DigestInit_ex(context_.get(), EVP_sha256(), nullptr);
  }
  void add(std::span<const std::byte> message) {
    std::vector<std::byte> bytes(message.begin(), message.end());
    const auto word = [&](std::size_t place) {
      std::uint32_t value = 0;
      std::memcpy(&value, bytes.data() + place, sizeof(value));
      return value;
    };
    const std::uint32_t sections = word(12);
    std::size_t place = 16;
    for (std::uint32_t i = 0; i < sections; ++i) {
      const std::uint32_t length = word(place + 12);
      if (word(place) == statistics_tag) std::fill_n(bytes.begin() + place + 16, length, std::byte{0});
      place += 16 + (length + 15) / 16 * 16;
    }
    EVP_DigestUpdate(context_.get(), bytes.data(), bytes.size());
  }
  std::string hex() {
    unsigned char digest[32];
    unsigned int length = 0;
    EVP_DigestFinal_ex(context_.get(), digest, &length);
    std::string text;
    for (const unsigned char byte : digest) {
      char two[3];
      std::snprintf(two, sizeof two, "%02x", byte);
      text += two;
    }
    return text;
  }

 private:
  std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> context_;
};

ViewedObject placed(const char* model, const std::string& name, supple::Vec3d at) {
  ViewedObject object{supple::make_model(model)};
  object.options.name = name;
  for (supple::Vec3d& p : object.mesh.positions) p = p + at;
  return object;
}

/// The nine objects of the paper's experiment. They deform for a while and then get random velocities in a
/// room that is small enough for collisions.
Script nine() {
  Script script{"nine", {}};
  script.show.title = "nine";
  script.show.simulation.time_step = 0.02;
  script.show.simulation.seed = 1;
  script.show.simulation.border = supple::Border{{{-1.2, -1, -1.2}, {1.2, 1, 1.2}}};
  supple::MassSpringMotion soft;
  soft.springs.vertex_mass = 0.01;
  soft.springs.stiffness = 0.6;
  soft.springs.bending_stiffness = 0.6;
  soft.springs.damping = 0.007;
  soft.random_force = 0.002;
  soft.deform_seconds = 0.2;
  soft.random_speed = 0.8;
  const char* const models[] = {"pawn", "fish", "rabbit"};
  for (int i = 0; i < 9; ++i) {
    const supple::Vec3d at{0.55 * (i % 3 - 1), 0.4 * (i / 3 - 1), 0.3 * ((i * 7) % 3 - 1)};
    script.show.objects.push_back(
        placed(models[i % 3], std::string(models[i % 3]) + " " + std::to_string(i), at));
    script.show.objects.back().motion = soft;
  }
  script.command(R"({"do": "speed", "factor": 0})");
  script.command(
      R"({"do": "layers", "candidates": true, "scene_regions": true, "octree": {"objects": [0, 5], "level": 2}})");
  script.steps(40, 20);
  script.command(R"({"do": "explain", "id": 1, "a": [0, 10], "b": [1, 20]})");
  script.command(R"({"do": "explain", "id": 2, "a": [2, 10], "b": [8, 99]})");
  script.command(R"({"do": "read", "id": 3, "object": 4})");
  script.command(R"({"do": "read", "id": 4, "object": 4, "triangle": 7})");
  script.command(R"({"do": "grab", "object": 2, "vertex": 5})");
  script.command(R"({"do": "drag", "to": [0.1, 0.2, 0.3]})");
  script.steps(10, 20);
  script.command(R"({"do": "release"})");
  script.command(R"({"do": "what", "id": 5})");
  script.command(
      R"({"do": "set", "integrator": "backward_euler", "bounding_volume": "sphere", "objects": 4})");
  script.command(R"({"do": "layers", "colliding_vertices": true, "colliding_nodes": {"level": -2}})");
  script.command(R"({"do": "node_pairs", "id": 6, "a": 0, "b": 1})");
  script.command(R"({"do": "measure", "id": 7, "a": 0, "b": 1})");
  script.steps(8, 20);
  for (const char* field : {"speed", "strain", "distance"}) {
    script.command(std::string(R"({"do": "layers", "field": ")") + field + R"("})");
    script.steps(2, 20);
  }
  return script;
}

/// A body that becomes unstable with long steps, and continues with another integrator.
Script exploding() {
  Script script{"exploding", {}};
  script.show.title = script.name;
  script.show.objects = {placed("rabbit", "soft", {}), placed("pawn", "hard", {0.3, 0, 0})};
  script.show.objects.front().motion = supple::MassSpringMotion{
      .springs = {.vertex_mass = 1e-6, .stiffness = 1e4}, .random_force = 1, .deform_seconds = 1};
  script.command(R"({"do": "speed", "factor": 0})");
  script.steps(30, 20);
  script.command(R"({"do": "set", "integrator": "backward_euler"})");
  script.command(R"({"do": "play"})");
  script.steps(5, 20);
  return script;
}

/// A degenerate family with wave motion and self-collision.
Script hard(const supple::Family& family, bool continuous) {
  Script script{std::string(family.name) + (continuous ? "_continuous" : ""), {}};
  script.show.title = script.name;
  script.show.simulation.scene.contacts =
      continuous ? supple::ContactKinds::continuous : supple::ContactKinds::intersection;
  std::uint64_t seed = 0;
  for (supple::TriangleMesh& mesh : family.make(3)) {
    // Exact arithmetic for all triangles would take minutes.
    if (continuous) mesh.triangles.resize(std::min<std::size_t>(mesh.triangles.size(), 12));
    ViewedObject object{std::move(mesh)};
    object.options.name = "object " + std::to_string(seed);
    object.options.self_collision = true;
    object.options.octree.leaf_size = 3;
    if (seed != 1) object.motion = supple::WaveMotion{{0.2, 0.1, 0}, 0.05, 0.7, 1, seed};
    ++seed;
    script.show.objects.push_back(std::move(object));
  }
  script.command(R"({"do": "speed", "factor": 0})");
  script.command(R"({"do": "layers", "candidates": true, "octree": {"objects": [0], "level": -1}})");
  script.steps(continuous ? 2 : 6, 20);
  return script;
}

/// Plays the script and returns the results that the module must reproduce.
nlohmann::json play(const Script& script, std::span<const std::byte> packed) {
  supple::viewer::Session session(supple::viewer::unpack(packed));
  session.greet();
  MessageHash hash;
  std::uint64_t messages = 0, frames = 0, contacts = 0, failures = 0;
  supple::viewer::MessageWriter writer;
  const auto drain = [&] {
    for (auto bytes = session.next_message(writer); !bytes.empty(); bytes = session.next_message(writer)) {
      hash.add(bytes);
      const supple::ViewerMessage message(bytes);
      ++messages;
      if (message.kind == supple::ViewerMessage::failure) ++failures;
      if (message.kind != supple::ViewerMessage::frame) continue;
      ++frames;
      contacts += count_of(message, "contacts") + count_of(message, "continuous_contacts");
    }
  };
  drain();
  for (const nlohmann::json& entry : script.entries) {
    if (entry.is_string())
      session.command(entry.get<std::string>());
    else
      session.advance(entry.get<double>() / 1000);
    drain();
  }
  return {{"name", script.name},  {"entries", script.entries}, {"messages", messages}, {"frames", frames},
          {"contacts", contacts}, {"failures", failures},      {"sha256", hash.hex()}};
}

void write(const std::filesystem::path& path, const char* data, std::size_t size) {
  std::ofstream file(path, std::ios::binary);
  file.write(data, static_cast<std::streamsize>(size));
  if (!file.flush()) throw std::runtime_error("cannot write " + path.string());
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return std::fprintf(stderr, "usage: %s FOLDER\n", argv[0]), 2;
  const std::filesystem::path folder = argv[1];
  std::filesystem::create_directories(folder);
  std::vector<Script> scripts{nine(), exploding()};
  for (const supple::Family& family : supple::hard_families()) {
    scripts.push_back(hard(family, false));
    scripts.push_back(hard(family, true));
  }
  nlohmann::json sessions = nlohmann::json::array();
  for (const Script& script : scripts) {
    const std::vector<std::byte> packed = supple::viewer::pack(script.show);
    write(folder / (script.name + ".show"), reinterpret_cast<const char*>(packed.data()), packed.size());
    sessions.push_back(play(script, packed));
  }
  const std::string text = sessions.dump(1);
  write(folder / "sessions.json", text.data(), text.size());
}
