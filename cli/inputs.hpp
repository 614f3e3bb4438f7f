#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "supple/mesh.hpp"
#include "supple/options.hpp"
#include "sway.hpp"

namespace supple {
class Recording;
}

namespace supple::cli {

/// An object to add to the scene, placed.
struct InputObject {
  TriangleMesh mesh;
  ObjectOptions options;
  std::optional<Sway> motion;
};

/// What a command works on: objects, and what moves them from frame to frame.
struct Input {
  std::vector<InputObject> objects;
  /// Frames of the one object, the first being its mesh; empty when the input is no sequence.
  std::vector<std::filesystem::path> frames;
  /// Says where the objects are in each frame; null when the input is no recording.
  std::shared_ptr<const Recording> recording{};
  std::string recording_name{};
  std::optional<Bounds> bounds;
  double time_step = 0.01;  ///< seconds between frames
};

bool is_scene_file(const std::string& name);

/// Meshes by name or quoted pattern (`part*.obj`, in natural number order), an object each; or one scene
/// file; or one recording.
Input read_objects(const std::vector<std::string>& names);
/// The first frame, and the names of all.
Input read_sequence(const std::vector<std::string>& names);
/// A later frame of a sequence; throws `Error` when it is not the same object: other counts or other
/// triangles.
TriangleMesh read_frame(const Input& sequence, std::size_t frame);

/// Each pattern replaced by the files that match, in natural number order: frame_9 before frame_10. Throws
/// `Error` when none does.
std::vector<std::filesystem::path> expand_patterns(const std::vector<std::string>& names);
bool natural_less(const std::string& a, const std::string& b);

}  // namespace supple::cli
