#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>

#include "supple/formats.hpp"

namespace supple::cli {

/// How the command line plays animations of files.
struct ClipOptions {
  std::optional<std::string> clip;      ///< by name; none: the first
  std::optional<double> fps;            ///< frames per second; none: `frames` frames from start to end
  std::optional<std::uint64_t> frames;  ///< none: all frames of the clip

  bool is_given() const { return clip || fps || frames; }
};

/// Values of the command line that replace those of the scene file.
struct SceneOverrides {
  std::optional<std::uint64_t> seed{};
  std::optional<double> time_step{};
  /// Scene files with more triangles in all objects are refused before the objects are made. A few bytes can
  /// ask for billions, so set it for files of strangers.
  std::uint64_t most_triangles = std::numeric_limits<std::uint64_t>::max();
};

/// How the command line reads meshes.
struct MeshReading {
  CoordinateConversion conversion{};
  ClipOptions clips{};
  std::string cache{};  ///< a point cache; empty: none
};

}  // namespace supple::cli
