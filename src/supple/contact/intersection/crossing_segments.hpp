#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "mesh/vertex_arrays.hpp"
#include "supple/contact.hpp"
#include "supple/types.hpp"

namespace supple {

/// What `intersect_triangles` finds for pairs of triangles that cross in a segment, computed for several
/// pairs at a time.
class CrossingSegments {
 public:
  static constexpr std::size_t capacity = 64;  ///< the greatest number of pairs

  /// The results of the kernel, one column for each pair.
  struct Rows {
    double ends[2][3][capacity];  ///< [end][axis]
    /// The edge that ends the segment: 0 to 2 for an edge of a in the face of b, 3 to 5 for an edge of b in
    /// the face of a.
    double edges[2][capacity];
    double normals[3][capacity];
  };

  /// Finds the segments of at most `capacity` pairs of a triangle of `a` and one of `b` that have the bit
  /// `PairVerdicts::crossing`. The same bits on all instruction sets.
  void find(const PlacedTriangles& a, const PlacedTriangles& b, std::span<const TrianglePair> pairs);

  /// False where floating point does not suffice; `intersect_triangles` finds the segment of such a pair.
  bool is_known(std::size_t pair) const { return (known_ >> pair & 1) != 0; }
  /// The first (0) or second (1) end of a segment that is known.
  ContactPoint end(std::size_t which, std::size_t pair) const {
    constexpr Feature face{};
    const auto number = static_cast<std::uint8_t>(rows_.edges[which][pair]);
    const bool is_of_a = number < 3;
    const Feature edge{FeatureKind::edge, static_cast<std::uint8_t>(is_of_a ? number : number - 3)};
    const auto& [x, y, z] = rows_.ends[which];
    return {{x[pair], y[pair], z[pair]}, is_of_a ? edge : face, is_of_a ? face : edge};
  }
  Vec3d normal(std::size_t pair) const {
    return {rows_.normals[0][pair], rows_.normals[1][pair], rows_.normals[2][pair]};
  }

 private:
  std::uint64_t known_ = 0;
  Rows rows_;
};

}  // namespace supple
