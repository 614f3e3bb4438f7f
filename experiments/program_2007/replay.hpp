#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "supple/mesh.hpp"
#include "supple/scene.hpp"
#include "supple/simulation.hpp"
#include "table1/table1_options.hpp"

namespace supple::experiments {

/// The motion of a scene, so that several methods see the same frames.
struct Replay {
  /// The objects in one frame.
  struct Frame {
    std::vector<std::vector<Vec3d>> positions;  ///< by object
    std::vector<std::array<Vec3d, 2>> bounds;   ///< of these positions
  };

  std::string name;
  std::vector<TriangleMesh> objects;
  std::optional<Border> border{};
  std::vector<Frame> frames{};
};

/// The box of some points, by the loop that the motion of 2007 has.
std::array<Vec3d, 2> bounds_of(std::span<const Vec3d> positions);

/// Frames of a scene, every `steps_per_frame` steps, from the first step after a second on in which triangles
/// of different objects are near each other, or from the sixtieth second on.
Replay replay_of(const Table1Scene& scene, std::uint64_t seed, int frames, int steps_per_frame);

/// A way to detect, with one thread.
struct Program {
  std::string change;  ///< against the program before
  SceneOptions scene;
  ObjectOctreeOptions octree;
  bool has_bounds = true;  ///< the loop of the motion finds the bounds
};

/// The hierarchy that the paper chose, without contacts.
Program program_of_2007(const std::optional<Border>& border);

/// What a program does over the frames of a replay. Seconds are those of the processor.
struct ReplaySums {
  double bounds = 0, refit = 0, broad = 0, narrow = 0, exact = 0, total = 0;  ///< total: with the bounds
  std::uint64_t tests = 0, triangles_refitted = 0, candidates = 0;
};

/// A scene with the objects of a replay.
class ReplayedScene {
 public:
  ReplayedScene(const Replay& replay, const Program& program);

  ReplaySums run();  ///< one round over the frames
  std::uint64_t octree_bytes() const;

 private:
  const Replay& replay_;
  const Program& program_;
  Scene scene_;
  std::vector<ObjectId> ids_;
};

}  // namespace supple::experiments
