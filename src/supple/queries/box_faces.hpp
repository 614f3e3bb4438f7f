#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "narrow_phase/query_kernels.hpp"
#include "supple/triangle_intersection.hpp"

namespace supple {

/// Whether the boxes share no point.
inline bool are_apart(const QueryBox& p, const QueryBox& q) {
  for (int axis = 0; axis < 3; ++axis) {
    if (p.min[axis] > q.max[axis] || p.max[axis] < q.min[axis]) return true;
  }
  return false;
}

/// A box, exactly: its points, and the twelve triangles of its faces.
class BoxFaces {
 public:
  explicit BoxFaces(const QueryBox& box) : box_(box) {
    std::array<Vec3d, 8> corners;
    for (std::uint32_t i = 0; i < 8; ++i)
      corners[i] = {(i & 1) != 0 ? box.max.x : box.min.x, (i & 2) != 0 ? box.max.y : box.min.y,
                    (i & 4) != 0 ? box.max.z : box.min.z};
    constexpr std::uint8_t faces[6][4] = {{0, 2, 6, 4}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                          {2, 3, 7, 6}, {0, 1, 3, 2}, {4, 5, 7, 6}};
    for (std::size_t f = 0; f < 6; ++f) {
      const auto& [a, b, c, d] = faces[f];
      triangles_[2 * f] = {corners[a], corners[b], corners[c]};
      triangles_[2 * f + 1] = {corners[a], corners[c], corners[d]};
    }
  }

  /// Whether the triangle shares a point with the box: a corner inside, or a point on a face.
  bool meet(const TrianglePoints& triangle) const {
    if (are_apart(box_around(triangle), box_)) return false;
    const auto has = [&](const Vec3d& p) {
      return box_.min.x <= p.x && p.x <= box_.max.x && box_.min.y <= p.y && p.y <= box_.max.y &&
             box_.min.z <= p.z && p.z <= box_.max.z;
    };
    return std::any_of(triangle.begin(), triangle.end(), has) ||
           std::any_of(triangles_.begin(), triangles_.end(),
                       [&](const TrianglePoints& face) { return triangles_intersect(face, triangle); });
  }

 private:
  QueryBox box_;
  std::array<TrianglePoints, 12> triangles_;
};

}  // namespace supple
