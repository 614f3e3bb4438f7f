#pragma once

#include <cstddef>
#include <cstdint>

#include "supple/triangle_intersection.hpp"

namespace supple {

/// Pairs of triangles as structure-of-arrays, so that one vector register holds a coordinate of several
/// pairs. 4.5 KiB of floats, 9 of doubles: meant to live in a thread's own memory, filled again and again.
template <class Scalar>
struct TrianglePairBlock {
  static constexpr std::size_t capacity = 64;

  /// `[3 * corner + axis][pair]`
  alignas(64) Scalar a[9][capacity] = {};
  alignas(64) Scalar b[9][capacity] = {};

  void set(std::size_t pair, const TrianglePoints& triangle_a, const TrianglePoints& triangle_b) {
    for (std::size_t corner = 0; corner < 3; ++corner) {
      for (int axis = 0; axis < 3; ++axis) {
        const std::size_t row = 3 * corner + static_cast<std::size_t>(axis);
        a[row][pair] = static_cast<Scalar>(triangle_a[corner][axis]);
        b[row][pair] = static_cast<Scalar>(triangle_b[corner][axis]);
      }
    }
  }
};

/// What the floating-point filter proves, a bit a pair. Pairs with neither bit are for `intersect_triangles`.
struct PairVerdicts {
  std::uint64_t apart = 0;     ///< no common point
  std::uint64_t crossing = 0;  ///< triangles in different planes that share a segment, not just a point

  constexpr bool operator==(const PairVerdicts&) const = default;
};

/// Verdicts on the pairs i < count <= capacity. Of a triangle with a coordinate that is not finite the bit
/// `apart` may be either, the bit `crossing` is clear. Equal on all instruction sets.
PairVerdicts filter_pairs(const TrianglePairBlock<float>& block, std::size_t count);
PairVerdicts filter_pairs(const TrianglePairBlock<double>& block, std::size_t count);

}  // namespace supple
