#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "supple/types.hpp"

namespace supple {

/// The root region of the scene octree and the depth below it.
struct SceneCube {
  Vec3f center;
  float edge = 2;
  std::uint32_t max_level = 1;
  /// Bounds of the objects' centres, but for the outermost few; lies inside the cube.
  Aabb core;
};

/// Whether objects for which `best` would be chosen are better off in regions of `best` than of `present`:
/// they outgrew the cube, fill little of it, or leaves of half or twice the edge would suit them.
bool is_outdated(const SceneCube& present, const SceneCube& best);

/// Chooses the cube from a sample of the boxes: around their centres but for the outermost 1/64 along each
/// axis, with a margin. `max_level` 0 is replaced by the level at which a leaf holds few objects on average,
/// as long as its edge is no shorter than the median object. Far from the origin `max_level` is lowered to
/// where floats still tell the planes between regions apart. O(sample), and the same for
/// the same boxes.
class SceneCubeChooser {
 public:
  SceneCube choose(std::span<const Aabb> boxes, std::uint32_t max_level);

 private:
  std::uint32_t automatic_level(const SceneCube& cube, std::size_t object_count, float median_extent);

  std::vector<Vec3f> centers_;
  std::vector<float> scratch_;
  std::vector<std::uint64_t> cells_;
};

}  // namespace supple
