#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>

#include "inputs/inputs.hpp"
#include "inputs/placement.hpp"
#include "supple/animation.hpp"

namespace supple::cli {

/// Frames per second of a clip when nothing else is given.
inline constexpr double film_rate = 25;

/// The animations of a file, placed as a mesh of the same file is.
class ClipPlayer {
 public:
  /// Reads the file. Throws `Error` when it has no clip, or none of this name.
  ClipPlayer(const std::filesystem::path& path, const std::optional<std::string>& clip);

  const AnimationClip& clip() const { return animation_.clips()[clip_]; }
  /// Says which clip plays when the file has several and none was chosen; otherwise empty. `how` says how to
  /// choose.
  std::string note(const std::optional<std::string>& chosen, const char* how) const;

  /// The motion of the command line: with a rate, one frame each 1 / fps seconds; without, `frames` frames
  /// evenly from the start of the clip to its end.
  ComputedMotion frames(const ClipOptions& options, const CoordinateConversion& conversion) const;
  /// The motion of a scene: a frame for each time step. It starts with the clip and has the given speed.
  ComputedMotion steps(double time_step, double speed, bool loop, const CoordinateConversion& conversion,
                       const Placement& placement) const;

 private:
  void pose(double time, const CoordinateConversion& conversion, std::span<Vec3d> positions) const;

  std::string file_;
  AnimatedMesh animation_;
  std::size_t clip_ = 0;
};

/// The frames of a point cache of a mesh with so many vertices. Throws `Error` when it has others.
ComputedMotion play_cache(const std::filesystem::path& path, std::size_t vertices, bool loop,
                          const Placement& placement);

}  // namespace supple::cli
