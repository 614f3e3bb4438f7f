#pragma once

#include <span>
#include <vector>

#include "supple/types.hpp"

namespace supple {

/// The root region of the scene octree.
struct SceneCube {
  Vec3f center;
  float edge = 2;
  /// The shortest edge of regions that floats still tell apart here.
  float finest_edge = 0;
  /// Bounds of the objects' centres, but for the outermost few; lies inside the cube.
  Aabb core;
};

/// Whether objects for which `best` would be chosen are better off in it than in `present`: they outgrew the
/// cube, or fill little of it.
bool is_outdated(const SceneCube& present, const SceneCube& best);

/// Chooses the cube from a sample of the boxes: around their centres but for the outermost 1/64 along each
/// axis, with a margin. O(sample), and the same for the same boxes.
class SceneCubeChooser {
 public:
  SceneCube choose(std::span<const Aabb> boxes);

 private:
  std::vector<Vec3f> centers_;
  std::vector<float> scratch_;
};

}  // namespace supple
