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

/// Boxes of many elements: six arrays, `stride` floats apart, with min x, y, z and max x, y, z.
struct BoxArrays {
  float* values = nullptr;
  std::size_t stride = 0;

  float& at(int side, std::size_t element) const {
    return values[static_cast<std::size_t>(side) * stride + element];
  }
};

/// Rounds the vertices [begin, end), three doubles each, outward to float boxes of eight floats each: four
/// for the lower corner, four for the upper corner. Finite coordinates stay within the range of float.
void round_corners(const double* vertices, float* corners, std::uint32_t begin, std::uint32_t end);

/// Boxes of the elements [begin, end). All vertices count as finite. Each chooses the widest instruction set
/// at run time; the boxes are equal on all.
void set_vertex_boxes(const VertexCorners& corners, const BoxArrays& boxes, std::uint32_t begin,
                      std::uint32_t end);
void set_edge_boxes(const VertexCorners& corners, const Edge* edges, const BoxArrays& boxes,
                    std::uint32_t begin, std::uint32_t end);
void set_face_boxes(const VertexCorners& corners, const Triangle* faces, const BoxArrays& boxes,
                    std::uint32_t begin, std::uint32_t end);

/// The elements that the boxes of leaves enclose.
struct LeafElements {
  BoxArrays vertices, edges, faces;
  const std::uint32_t* first_vertex = nullptr;
  const std::uint32_t* first_edge = nullptr;
  /// The faces of a leaf enclose its other elements, unless some are inert.
  bool faces_enclose = true;
};

/// Computes the boxes of all leaves of the nodes [begin, end), and writes the box of each of these nodes into
/// its parent, as `refit_boxes` does.
void refit_element_boxes(const OctreeNode* nodes, ChildBoxes* boxes, const LeafElements& elements,
                         std::uint32_t begin, std::uint32_t end);

}  // namespace supple
