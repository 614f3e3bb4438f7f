#pragma once

#include <cstdint>

#include "narrow_phase/overlap_kernels.hpp"
#include "octree/octree_node.hpp"

namespace supple {

/// A point as the boxes of an object see it: between two floats on each axis.
struct PointBounds {
  Vec3f low, high;
};

/// Writes the squared distances of the point and the boxes of eight children, in single precision: they are
/// below 1 + 2^-20 times the exact ones, plus 2^-140. Those of missing children are unspecified.
void squared_distances(const PointBounds& point, const ChildBoxes& boxes, float* squares);
/// The triangles of a block whose boxes have such a squared distance of at most `limit`.
std::uint64_t near_triangles(const PointBounds& point, const LeafBoxes& boxes, float limit);

}  // namespace supple
