#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
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

/// The box of some points, by the loop that the motion of 2007 has.
std::array<Vec3d, 2> bounds_of(std::span<const Vec3d> positions);

/// Frames of a scene, every `steps_per_frame` steps, from the first step after a second on in which triangles
/// of different objects are near each other, or from the sixtieth second on.
Replay replay_of(const Table1Scene& scene, std::uint64_t seed, int frames, int steps_per_frame);

/// The hierarchy that the paper chose.
class Hierarchy {
 public:
  explicit Hierarchy(const Replay& replay) : scene_(options_of(replay)) {
    for (const TriangleMesh& mesh : replay.objects)
      ids_.push_back(scene_.add(mesh, {.octree = octree_of_2007()}));
  }
  static SceneOptions options_of(const Replay& replay) {
    SceneOptions options = with_method_of_2007({});
    options.contacts = ContactKinds::none;
    options.threads = 1;
    if (replay.border) options.scene_octree.root = cube_around((*replay.border)[0], (*replay.border)[1]);
    return options;
  }
  StepStats find(const Replay::Frame& frame) {
    for (std::size_t i = 0; i < ids_.size(); ++i)
      scene_.set_positions(ids_[i], frame.positions[i], frame.bounds[i]);
    return scene_.detect().stats;
  }

 private:
  Scene scene_;
  std::vector<ObjectId> ids_;
};

}  // namespace supple::experiments
