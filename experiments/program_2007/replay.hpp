#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "supple/mesh.hpp"
#include "supple/simulation.hpp"
#include "table1/table1_options.hpp"

namespace supple::experiments {

/// The motion of a scene, so that several methods see the same frames.
struct Replay {
  /// The objects in one frame.
  struct Frame {
    std::vector<std::vector<Vec3d>> positions;  ///< by object
    std::vector<std::array<Vec3d, 2>> bounds;   ///< of these positions, as the loop of the motion finds
  };

  std::string name;
  std::vector<TriangleMesh> objects;
  std::optional<Border> border{};
  std::vector<Frame> frames{};
};

/// Frames of a scene, every `steps_per_frame` steps, from the first step after a second on in which triangles
/// of different objects are near each other, or from the sixtieth second on.
Replay replay_of(const Table1Scene& scene, std::uint64_t seed, int frames, int steps_per_frame);

}  // namespace supple::experiments
