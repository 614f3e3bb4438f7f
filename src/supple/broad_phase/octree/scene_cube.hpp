#pragma once

#include <optional>
#include <span>
#include <vector>

#include "supple/comparison_options.hpp"
#include "supple/types.hpp"

namespace supple {

/// The root region of the scene octree.
struct SceneCube {
  Vec3f center;
  float edge = 2;
  /// Regions with a shorter edge would have planes that floats cannot distinguish.
  float finest_edge = 0;
  /// The bounds of the objects' centres without the outermost 1/64 along each axis. They are inside the cube.
  /// Empty when the user gave the cube.
  Aabb core;
};

/// Whether the objects for which `best` was chosen have outgrown the present cube or fill little of it.
bool is_outdated(const SceneCube& present, const SceneCube& best);

/// Chooses the cube that the user gave, or the cube around the core of a sample of the boxes, with a margin.
/// The same boxes give the same cube.
class SceneCubeChooser {
 public:
  explicit SceneCubeChooser(const std::optional<RootCube>& given = {}) : given_(given) {}

  SceneCube choose(std::span<const Aabb> boxes);

 private:
  std::optional<RootCube> given_;
  std::vector<Vec3f> centers_;
  std::vector<float> scratch_;
};

}  // namespace supple
