#pragma once

#include <array>
#include <span>
#include <vector>

#include "supple/types.hpp"

namespace supple {

/// The surface of an intersection of slabs, for drawing and statistics. The directions of the first three
/// slabs are at right angles and of unit length. Computed in double and rounded.
class Polytope {
 public:
  /// Without faces when a bound of the first three slabs is infinite. O(slabs · faces).
  explicit Polytope(std::span<const Slab> slabs);

  /// Each edge once.
  std::vector<std::array<Vec3d, 2>> edges() const;
  double surface() const;

 private:
  using Face = std::vector<Vec3d>;  // corners in order around the face

  void cut(Vec3d direction, double high);

  std::vector<Face> faces_;
};

}  // namespace supple
