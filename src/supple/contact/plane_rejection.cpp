#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "contact/plane_rejection.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "contact/plane_rejection.hpp"
#include "geometry/plane_filter.hpp"

HWY_BEFORE_NAMESPACE();
namespace supple::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

// At most eight lanes, so that their mask is one byte.
using Lanes = hn::CappedTag<double, 8>;
using Vector = hn::Vec<Lanes>;

struct Vector3 {
  Vector x, y, z;
};

using Coordinates = const double (*)[TrianglePairBlock::capacity];

Vector3 load(Coordinates triangle, std::size_t corner, std::size_t first) {
  const Lanes d;
  return {hn::Load(d, triangle[3 * corner] + first), hn::Load(d, triangle[3 * corner + 1] + first),
          hn::Load(d, triangle[3 * corner + 2] + first)};
}
Vector3 subtract(const Vector3& a, const Vector3& b) {
  return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}
Vector dot(const Vector3& a, const Vector3& b) {
  return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
}
Vector largest_magnitude(Vector a, Vector b, Vector c) {
  return hn::Max(hn::Max(hn::Abs(a), hn::Abs(b)), hn::Abs(c));
}

/// As `FilteredPlane` and `FilteredSides` compute it.
hn::Mask<Lanes> separated(Coordinates plane, Coordinates triangle, std::size_t first) {
  const Lanes d;
  const Vector3 origin = load(plane, 0, first);
  const Vector3 u = subtract(load(plane, 1, first), origin), v = subtract(load(plane, 2, first), origin);
  const Vector3 left{hn::Mul(u.y, v.z), hn::Mul(u.z, v.x), hn::Mul(u.x, v.y)};
  const Vector3 right{hn::Mul(u.z, v.y), hn::Mul(u.x, v.z), hn::Mul(u.y, v.x)};
  const Vector3 normal = subtract(left, right);
  const Vector3 magnitude{hn::Add(hn::Abs(left.x), hn::Abs(right.x)),
                          hn::Add(hn::Abs(left.y), hn::Abs(right.y)),
                          hn::Add(hn::Abs(left.z), hn::Abs(right.z))};

  const Vector3 w0 = subtract(load(triangle, 0, first), origin);
  const Vector3 w1 = subtract(load(triangle, 1, first), origin);
  const Vector3 w2 = subtract(load(triangle, 2, first), origin);
  const Vector3 reach{largest_magnitude(w0.x, w1.x, w2.x), largest_magnitude(w0.y, w1.y, w2.y),
                      largest_magnitude(w0.z, w1.z, w2.z)};
  const Vector underflow = hn::Set(d, underflow_error);
  const Vector bound = hn::Add(hn::Add(hn::Mul(hn::Set(d, volume_error), dot(magnitude, reach)),
                                       hn::Mul(underflow, hn::Add(hn::Add(reach.x, reach.y), reach.z))),
                               underflow);
  const Vector side0 = dot(normal, w0), side1 = dot(normal, w1), side2 = dot(normal, w2);
  const Vector lowest = hn::Min(hn::Min(side0, side1), side2);
  const Vector highest = hn::Max(hn::Max(side0, side1), side2);
  return hn::Gt(hn::Max(lowest, hn::Neg(highest)), bound);
}

std::uint64_t planes_separate(const TrianglePairBlock& block, std::size_t count) {
  const Lanes d;
  std::uint64_t result = 0;
  for (std::size_t first = 0; first < count; first += hn::Lanes(d)) {
    const auto mask = hn::Or(separated(block.a, block.b, first), separated(block.b, block.a, first));
    std::uint8_t bits[8] = {};
    hn::StoreMaskBits(d, mask, bits);
    result |= std::uint64_t{bits[0]} << first;
  }
  return count < 64 ? result & ((std::uint64_t{1} << count) - 1) : result;
}

}  // namespace
}  // namespace supple::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace supple {

HWY_EXPORT(planes_separate);

std::uint64_t planes_separate(const TrianglePairBlock& block, std::size_t count) {
  return HWY_DYNAMIC_DISPATCH(planes_separate)(block, count);
}

std::uint64_t planes_separate_scalar(const TrianglePairBlock& block, std::size_t count) {
  const auto triangle = [](const auto& rows, std::size_t pair) {
    TrianglePoints points;
    for (std::size_t row = 0; row < 9; ++row) points[row / 3][static_cast<int>(row % 3)] = rows[row][pair];
    return points;
  };
  std::uint64_t result = 0;
  for (std::size_t pair = 0; pair < count; ++pair) {
    const TrianglePoints a = triangle(block.a, pair), b = triangle(block.b, pair);
    const bool separated =
        FilteredSides(FilteredPlane(b), a).separated() || FilteredSides(FilteredPlane(a), b).separated();
    result |= std::uint64_t{separated} << pair;
  }
  return result;
}

}  // namespace supple
#endif
