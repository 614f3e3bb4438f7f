#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "inputs/inputs.hpp"
#include "scene_file/toml_reader.hpp"

namespace supple::cli {

/// The `motion` of one [[object]] of a scene file. It applies to each copy of the object.
class SceneMotion {
 public:
  /// `object` is the reader of the [[object]], and `where` its name in messages. `gravity` is the gravity of
  /// the scene. Throws as `read_scene_file` does.
  SceneMotion(TomlReader& object, const std::filesystem::path& scene_file, std::string where, Vec3d gravity,
              const CoordinateConversion& conversion);

  bool empty() const { return table_ == nullptr; }
  /// The mesh files of `kind = "frames"`; null for other kinds.
  const FrameSequence* frames() const { return motion_ ? std::get_if<FrameSequence>(&*motion_) : nullptr; }

  /// Reads the animation or the point cache that a motion of kind "clip" or "cache" names, for a mesh of this
  /// file; null for an object without a file. Adds notes for users.
  void read_files(const std::filesystem::path* mesh_file, double time_step, std::vector<std::string>& notes);

  /// The motion of one copy: with its own seed, and with the vertices that lie in the boxes.
  std::optional<Motion> of_copy(std::uint64_t copy, const Placement& placement,
                                const std::vector<Vec3d>& positions);
  /// Throws when a box contains no vertex of any copy.
  void check_boxes() const;

 private:
  struct Pull {
    Border box{};
    Vec3d by{};
    double seconds = 1;
  };

  /// The keys of kind "clip" or "cache".
  struct Playback {
    std::optional<std::string> clip;
    std::filesystem::path cache;  ///< empty: a clip
    double speed;
    bool loop;
  };

  void read_playback(TomlReader& reader, bool is_cache);
  void read_kind(TomlReader& reader, Vec3d gravity);
  MassSpringMotion read_mass_spring(TomlReader& reader, Vec3d gravity);
  FrameSequence read_frames(TomlReader& reader) const;
  void read_pulls(TomlReader& reader);
  void select_vertices(MassSpringMotion& motion, const std::vector<Vec3d>& positions);

  std::filesystem::path file_;
  CoordinateConversion conversion_;
  const toml::table* table_;
  std::string where_;
  std::optional<Motion> motion_;
  std::optional<Playback> playback_;
  std::function<ComputedMotion(const Placement& placement, std::size_t vertices)> play_;  ///< of `playback_`
  std::vector<Border> fixed_;
  std::vector<Pull> pulls_;
  std::vector<bool> fixed_found_, pulls_found_;  ///< whether a vertex of any copy lies in the box
};

}  // namespace supple::cli
