#pragma once

#include <cstddef>

#include "supple/triangle_intersection.hpp"

namespace supple {

/// Pairs of triangles that intersect, collected for `separating_normals`.
class IntersectingPairs {
 public:
  static constexpr std::size_t capacity = 64;
  static constexpr std::size_t most_lanes = 8;  ///< of a vector of coordinates
  static_assert(capacity % most_lanes == 0);

  void clear() { count_ = 0; }
  std::size_t size() const { return count_; }
  void add(const TrianglePoints& a, const TrianglePoints& b);
  TrianglePoints a(std::size_t pair) const { return points(0, pair); }
  TrianglePoints b(std::size_t pair) const { return points(9, pair); }
  /// Row 3 c + axis has a coordinate of corner c of each a; the rows from 9 on have those of b.
  const double* row(std::size_t index) const { return values_[index]; }
  /// Repeats the last pair up to the next multiple of `most_lanes`, so that whole vectors can be read.
  void pad();

 private:
  TrianglePoints points(std::size_t first_row, std::size_t pair) const;

  double values_[18][capacity];
  std::size_t count_ = 0;
};

/// `TriangleIntersection::normal` of each pair. The same bits on all instruction sets.
void separating_normals(IntersectingPairs& pairs, Vec3d* normals);

}  // namespace supple
