#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "mesh/vertex_arrays.hpp"
#include "supple/types.hpp"

namespace supple {

/// Triangles of an object, and what is added to each position as it is read.
struct PlacedTriangles {
  TriangleArrays arrays;
  Vec3d translation;
};

/// What the floating-point filter proves, a bit a pair. Pairs with neither bit are for `intersect_triangles`.
struct PairVerdicts {
  std::uint64_t apart = 0;     ///< no common point
  std::uint64_t crossing = 0;  ///< triangles in different planes that share a segment, not just a point

  constexpr bool operator==(const PairVerdicts&) const = default;
};

/// Pairs that are tested in one call.
constexpr std::size_t pair_filter_capacity = 64;

/// Verdicts on pairs of a triangle of `a` and one of `b`, as many as the capacity or fewer. In lanes of
/// floats where both objects have floats and are not translated, of doubles else. Of a triangle with a
/// coordinate that is not finite the bit `apart` may be either, the bit `crossing` is clear. Equal on all
/// instruction sets.
PairVerdicts filter_pairs(const PlacedTriangles& a, const PlacedTriangles& b,
                          std::span<const TrianglePair> pairs);

}  // namespace supple
