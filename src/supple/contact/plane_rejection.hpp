#pragma once

#include <cstddef>
#include <cstdint>

#include "supple/triangle_intersection.hpp"

namespace supple {

/// Pairs of triangles as structure-of-arrays, so that one vector register holds a coordinate of several
/// pairs. 9 KiB: meant to live on the stack or in a thread's own memory, and to be filled again and again.
struct TrianglePairBlock {
  static constexpr std::size_t capacity = 64;

  /// `[3 * corner + axis][pair]`
  alignas(64) double a[9][capacity] = {};
  alignas(64) double b[9][capacity] = {};

  void set(std::size_t pair, const TrianglePoints& triangle_a, const TrianglePoints& triangle_b) {
    for (std::size_t corner = 0; corner < 3; ++corner) {
      for (int axis = 0; axis < 3; ++axis) {
        const std::size_t row = 3 * corner + static_cast<std::size_t>(axis);
        a[row][pair] = triangle_a[corner][axis];
        b[row][pair] = triangle_b[corner][axis];
      }
    }
  }
};

/// Bit i is set when the plane of one triangle of pair i separates it strictly from the other, as the
/// floating-point filter proves, for i < count <= capacity; `triangles_intersect` would answer no. A clear
/// bit says nothing. Of a triangle with a coordinate that is not finite, the bit may be either.
std::uint64_t planes_separate(const TrianglePairBlock& block, std::size_t count);

/// The same by scalar arithmetic; the meaning of the above.
std::uint64_t planes_separate_scalar(const TrianglePairBlock& block, std::size_t count);

}  // namespace supple
