#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "contact/intersection/separating_normal.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "contact/intersection/separating_normal-inl.hpp"
#include "contact/intersection/separating_normal.hpp"
#include "core/packed_lanes-inl.hpp"
#include "geometry/vector.hpp"
#include "geometry/vector3-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace supple::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

/// Writes x, y and z of the normals. Returns a bit for each pair that has none.
std::uint64_t find_normals_of_rows(const IntersectingPairs& pairs,
                                   double (*normals)[IntersectingPairs::capacity]) {
  using Tag = hn::CappedTag<double, IntersectingPairs::most_lanes>;
  const Tag d;
  const std::uint64_t all_lanes = (std::uint64_t{1} << hn::Lanes(d)) - 1;
  std::uint64_t without = 0;
  for (std::size_t first = 0; first < pairs.size(); first += hn::Lanes(d)) {
    Corners<Tag> a, b;
    const auto load = [&](std::size_t row) HWY_ATTR { return hn::LoadU(d, pairs.row(row) + first); };
    for (std::size_t i = 0; i < 3; ++i) {
      a[i] = {load(3 * i), load(3 * i + 1), load(3 * i + 2)};
      b[i] = {load(3 * i + 9), load(3 * i + 10), load(3 * i + 11)};
    }
    Vector3<Tag> normal;
    const auto has_normal = find_normals<Tag>(a, b, normal);
    hn::StoreU(normal.x, d, normals[0] + first);
    hn::StoreU(normal.y, d, normals[1] + first);
    hn::StoreU(normal.z, d, normals[2] + first);
    without |= (mask_bits(d, hn::Not(has_normal)) & all_lanes) << first;
  }
  return without;
}

}  // namespace
}  // namespace supple::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace supple {

HWY_EXPORT(find_normals_of_rows);

namespace {

/// A unit vector perpendicular to the longest edge.
Vec3d perpendicular(const TrianglePoints& a, const TrianglePoints& b) {
  Vec3d longest;
  for (const TrianglePoints* const triangle : {&a, &b}) {
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3d edge = (*triangle)[(i + 1) % 3] - (*triangle)[i];
      if (squared_norm(edge) > squared_norm(longest)) longest = edge;
    }
  }
  const Vec3d direction = cross(longest, shortest_axis(longest));
  return direction / norm(direction);
}

/// Triangles of any size, or on one line: brings them to a size of about 1 first.
Vec3d special_normal(const TrianglePoints& a, const TrianglePoints& b) {
  double half_extent = 0;
  bool is_point = true;
  for (const TrianglePoints* const triangle : {&a, &b}) {
    for (const Vec3d& p : *triangle) {
      half_extent = std::max(half_extent, largest_magnitude(p * 0.5 - a[0] * 0.5));
      is_point = is_point && p == a[0];
    }
  }
  if (is_point) return {1, 0, 0};
  // Half of the smallest number is 0.
  const int exponent = half_extent > 0 ? -std::ilogb(half_extent) - 1 : 1074;
  IntersectingPairs pair;
  pair.add({scaled(a[0], exponent), scaled(a[1], exponent), scaled(a[2], exponent)},
           {scaled(b[0], exponent), scaled(b[1], exponent), scaled(b[2], exponent)});
  pair.pad();
  double normals[3][IntersectingPairs::capacity];
  if ((HWY_DYNAMIC_DISPATCH(find_normals_of_rows)(pair, normals) & 1) != 0)
    return perpendicular(pair.a(0), pair.b(0));
  return {normals[0][0], normals[1][0], normals[2][0]};
}

}  // namespace

void IntersectingPairs::add(const TrianglePoints& a, const TrianglePoints& b) {
  for (int i = 0; i < 3; ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      values_[3 * i + axis][count_] = a[i][axis];
      values_[9 + 3 * i + axis][count_] = b[i][axis];
    }
  }
  ++count_;
}

void IntersectingPairs::pad() {
  for (std::size_t i = count_; i % most_lanes != 0; ++i) {
    for (double* const row : values_) row[i] = row[count_ - 1];
  }
}

TrianglePoints IntersectingPairs::points(std::size_t first_row, std::size_t pair) const {
  TrianglePoints points;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t row = first_row + 3 * i;
    points[i] = {values_[row][pair], values_[row + 1][pair], values_[row + 2][pair]};
  }
  return points;
}

void separating_normals(IntersectingPairs& pairs, Vec3d* normals) {
  pairs.pad();
  double components[3][IntersectingPairs::capacity];
  const std::uint64_t without = HWY_DYNAMIC_DISPATCH(find_normals_of_rows)(pairs, components);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    normals[i] = (without >> i & 1) != 0 ? special_normal(pairs.a(i), pairs.b(i))
                                         : Vec3d{components[0][i], components[1][i], components[2][i]};
  }
}

}  // namespace supple
#endif
