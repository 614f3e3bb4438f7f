#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "mesh/vertex_arrays.hpp"
#include "supple/types.hpp"

namespace supple {

/// What the floating-point filter proves, one bit for each pair. `intersect_triangles` decides pairs with
/// neither bit.
struct PairVerdicts {
  std::uint64_t apart = 0;     ///< no common point
  std::uint64_t crossing = 0;  ///< triangles in different planes that share a segment, not just a point

  constexpr bool operator==(const PairVerdicts&) const = default;
};

/// The greatest number of pairs in one call.
constexpr std::size_t pair_filter_capacity = 64;

/// Verdicts on at most `pair_filter_capacity` pairs of a triangle of `a` and one of `b`. Computes in floats
/// where both objects have floats and are not translated, and in doubles otherwise. For a triangle with a
/// coordinate that is not finite, the bit `apart` may be set or not, and the bit `crossing` is not set. The
/// same bits on all instruction sets.
PairVerdicts filter_pairs(const PlacedTriangles& a, const PlacedTriangles& b,
                          std::span<const TrianglePair> pairs);

}  // namespace supple
