#pragma once

#include <cstddef>
#include <cstdint>

#include "supple/mesh.hpp"
#include "supple/types.hpp"

namespace supple {

/// Vertices in memory: x, y, z of vertex v are the three scalars that start at `(*this)[v]`. The memory after
/// them may be unreadable.
template <class Scalar>
struct VertexArray {
  const Scalar* data = nullptr;
  std::size_t stride = 3;  ///< scalars from one vertex to the next

  const Scalar* operator[](std::size_t vertex) const { return data + vertex * stride; }
};

/// The data of an object's triangles that kernels read: raw arrays, so that kernels compile in the same way
/// for every instruction set. Either `floats` or `doubles` has data. `inert` has one byte per triangle, or is
/// null.
struct TriangleArrays {
  const Triangle* triangles = nullptr;
  VertexArray<float> floats;
  VertexArray<double> doubles;
  const std::uint8_t* inert = nullptr;
};

/// Triangles of an object, and the translation of its positions.
struct PlacedTriangles {
  TriangleArrays arrays;
  Vec3d translation;
};

}  // namespace supple
