#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <type_traits>
#include <vector>

#include "mesh/vertex_arrays.hpp"
#include "supple/triangle_intersection.hpp"
#include "supple/types.hpp"

namespace supple::truth {

template <class Scalar>
std::array<Vec3<Scalar>, 3> converted(const TrianglePoints& triangle) {
  std::array<Vec3<Scalar>, 3> result;
  for (std::size_t i = 0; i < 3; ++i) {
    for (int axis = 0; axis < 3; ++axis) result[i][axis] = static_cast<Scalar>(triangle[i][axis]);
  }
  return result;
}
template <class Scalar>
TrianglePoints widened(const std::array<Vec3<Scalar>, 3>& triangle) {
  TrianglePoints result;
  for (std::size_t i = 0; i < 3; ++i) result[i] = {triangle[i].x, triangle[i].y, triangle[i].z};
  return result;
}

/// Triangles in the arrays of an object; no two share vertices. Kernels must not read the fourth scalar.
template <class Scalar>
class TriangleList {
 public:
  void add(const std::array<Vec3<Scalar>, 3>& corners) {
    const auto first = static_cast<std::uint32_t>(positions_.size() / 4);
    // The vertices are numbered backwards to reveal errors in the indexing.
    for (std::size_t i = 3; i-- > 0;)
      positions_.insert(positions_.end(),
                        {corners[i].x, corners[i].y, corners[i].z, std::numeric_limits<Scalar>::quiet_NaN()});
    triangles_.push_back({first + 2, first + 1, first});
  }
  PlacedTriangles placed(const Vec3d& translation = {}) const {
    PlacedTriangles placed{{}, translation};
    placed.arrays.triangles = triangles_.data();
    if constexpr (std::is_same_v<Scalar, float>) placed.arrays.floats = {positions_.data(), 4};
    if constexpr (std::is_same_v<Scalar, double>) placed.arrays.doubles = {positions_.data(), 4};
    return placed;
  }

 private:
  std::vector<Scalar> positions_;
  std::vector<Triangle> triangles_;
};

/// Two lists and pairs with one triangle from each; the triangles of b are in reverse order.
template <class ScalarA, class ScalarB = ScalarA>
struct PairList {
  explicit PairList(std::size_t count) {
    for (std::uint32_t i = 0; i < count; ++i) pairs.push_back({i, static_cast<std::uint32_t>(count) - 1 - i});
  }
  void set(std::size_t pair, const std::array<Vec3<ScalarA>, 3>& of_a,
           const std::array<Vec3<ScalarB>, 3>& of_b) {
    corners_b.resize(pairs.size());
    corners_b[pairs[pair].b] = of_b;
    a.add(of_a);
    if (pair + 1 < pairs.size()) return;
    for (const auto& corners : corners_b) b.add(corners);
  }

  TriangleList<ScalarA> a;
  TriangleList<ScalarB> b;
  std::vector<std::array<Vec3<ScalarB>, 3>> corners_b;
  std::vector<TrianglePair> pairs;
};

}  // namespace supple::truth
