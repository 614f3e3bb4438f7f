#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "octree/volumes/node_volumes.hpp"
#include "supple/types.hpp"

namespace supple {

/// A point that moves, turns and grows with a triangle: below its centroid, against its normal. The depth is
/// in units of the square root of twice the area.
struct MedialCenter {
  std::uint32_t triangle = 0;
  double depth = std::numeric_limits<double>::quiet_NaN();

  /// Not finite when the depth is not finite, or the triangle is degenerate or not finite.
  Vec3d position(const RefittedOctree& octree) const;
};

/// The depth of the medial axis below each triangle: of the centre of the ball that touches the centroid from
/// below and shrinks until no vertex is deep in it. (Ma, Bae and Choi, "3D medial axis point approximation
/// using nearest neighbors and the normal field", 2012.) 0 for triangles that have no normal. Needs current
/// boxes of all nodes.
std::vector<double> medial_depths(const RefittedOctree& octree);

}  // namespace supple
