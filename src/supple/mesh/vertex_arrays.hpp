#pragma once

#include <cstddef>
#include <cstdint>

#include "supple/mesh.hpp"

namespace supple {

/// Vertices in memory: x y z of vertex v are the three scalars from `(*this)[v]` on. What follows them need
/// not be readable.
template <class Scalar>
struct VertexArray {
  const Scalar* data = nullptr;
  std::size_t stride = 3;  ///< scalars from one vertex to the next

  const Scalar* operator[](std::size_t vertex) const { return data + vertex * stride; }
};

/// What kernels read of the triangles of an object: raw arrays, so that they compile for every instruction
/// set alike. One of `floats` and `doubles` has data; `inert` has a byte a triangle or is null.
struct TriangleArrays {
  const Triangle* triangles = nullptr;
  VertexArray<float> floats;
  VertexArray<double> doubles;
  const std::uint8_t* inert = nullptr;
};

}  // namespace supple
