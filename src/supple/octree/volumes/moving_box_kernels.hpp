#pragma once

#include <cstddef>
#include <cstdint>

#include "octree/octree_node.hpp"
#include "octree/surface_elements.hpp"
#include "supple/mesh.hpp"

namespace supple {

/// Where the kernels read the box of each vertex: x y z of the lower corner at `lower + vertex * step`, and
/// of the upper corner at `upper + vertex * step`. They may read a fourth float. For float positions both
/// corners are the vertex itself.
struct VertexCorners {
  const float* lower = nullptr;
  const float* upper = nullptr;
  std::size_t step = 3;
};

/// Rounds the vertices [begin, end), three doubles each, outward to float boxes of eight floats each: four
/// for the lower corner, four for the upper corner. Finite coordinates stay within the range of float.
void round_corners(const double* vertices, float* corners, std::uint32_t begin, std::uint32_t end);

/// Computes the boxes of all leaves of the nodes [begin, end) from the vertices of their faces, and writes
/// the box of each of these nodes into its parent, as `refit_boxes` does. `inert` has a byte per vertex, not
/// 0 for vertices to leave out, or is null.
void refit_moving_boxes(const OctreeNode* nodes, ChildBoxes* boxes, const VertexCorners& corners,
                        const Triangle* faces, const std::uint8_t* inert, std::uint32_t begin,
                        std::uint32_t end);

}  // namespace supple
