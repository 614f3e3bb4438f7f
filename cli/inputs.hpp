#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "frame_files.hpp"
#include "supple/mesh.hpp"
#include "supple/options.hpp"
#include "supple/recording.hpp"
#include "supple/simulation.hpp"
#include "supple/wave_motion.hpp"

namespace supple::cli {

/// Where an object was in each frame of a recording.
struct RecordedMotion {
  std::shared_ptr<const Recording> recording;
  std::size_t object = 0;  ///< its place in there
};

/// What moves an object from frame to frame.
using Motion = std::variant<WaveMotion, MassSpringMotion, FrameSequence, RecordedMotion>;

/// An object to add to the scene, placed.
struct InputObject {
  TriangleMesh mesh;
  ObjectOptions options;
  std::optional<Motion> motion;
};

/// What a command works on: objects, and what moves them.
struct Input {
  std::vector<InputObject> objects;
  SimulationOptions simulation;
  /// Of a sequence or a recording.
  struct Frames {
    std::string name{};  ///< in messages
    std::uint64_t count = 0;
  };
  std::optional<Frames> frames{};
  std::string scene_text;  ///< of the scene file; empty when there is none
};

/// What the command line says instead of the scene file.
struct SceneOverrides {
  std::optional<std::uint64_t> seed{};
  std::optional<double> time_step{};
};

bool is_scene_file(const std::string& name);

/// Meshes by name or quoted pattern (`part*.obj`, in natural number order), an object each; or one scene
/// file; or one recording.
Input read_objects(const std::vector<std::string>& names, const SceneOverrides& overrides = {});
/// The object of the first frame, moved by all of them.
Input read_sequence(const std::vector<std::string>& names);

/// Each pattern replaced by the files that match, in natural number order: frame_9 before frame_10. Throws
/// `Error` when none does.
std::vector<std::filesystem::path> expand_patterns(const std::vector<std::string>& names);
bool natural_less(const std::string& a, const std::string& b);

}  // namespace supple::cli
