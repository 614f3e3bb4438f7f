#include "contact/fixed_point_rejection.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstdlib>
#include <limits>

#include "geometry/integer_points.hpp"

namespace supple {
namespace {

/// The numbers rounded down to multiples of a power of two and divided by it, so that all are below 2^56:
/// true differences are less than 1 away from those of the integers.
class FixedPoint {
 public:
  explicit FixedPoint(const MotionNumbers& numbers) {
    const BitRange range(numbers);
    unit_ = range.lowest + range.width - bits;
    exact = range.width <= bits;
    for (std::size_t i = 0; i < 24; ++i) points_[i / 12][i % 12 / 3][i % 3] = rounded_down(numbers[i]);
    separation = -rounded_down(-numbers[24]);
  }

  const Vector3<std::int64_t>& at(std::size_t moment, std::size_t vertex) const {
    return points_[moment][vertex];
  }

  static constexpr int bits = 56;
  bool exact;               ///< nothing was lost by rounding
  std::int64_t separation;  ///< rounded up

 private:
  std::int64_t rounded_down(double value) const {
    const Dyadic dyadic(value);
    if (dyadic.mantissa == 0) return 0;
    const int shift = dyadic.exponent - unit_;
    const auto mantissa = static_cast<std::int64_t>(dyadic.mantissa);
    if (shift >= 0) return dyadic.negative ? -(mantissa << shift) : mantissa << shift;
    if (shift < -63) return dyadic.negative ? -1 : 0;
    return (dyadic.negative ? -mantissa : mantissa) >> -shift;
  }

  int unit_;
  std::array<std::array<Vector3<std::int64_t>, 4>, 2> points_;
};

/// Whether at both ends of the step, hence throughout, all vertices of one element are farther than the
/// separation to the same side of all those of the other.
bool apart_along_an_axis(const FixedPoint& fixed, std::size_t first_size) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::int64_t above = std::numeric_limits<std::int64_t>::max(), below = above;
    for (std::size_t moment = 0; moment < 2; ++moment) {
      for (std::size_t i = 0; i < first_size; ++i) {
        for (std::size_t j = first_size; j < 4; ++j) {
          const std::int64_t difference = fixed.at(moment, i)[axis] - fixed.at(moment, j)[axis];
          above = std::min(above, difference);
          below = std::min(below, -difference);
        }
      }
    }
    if (std::max(above, below) > fixed.separation) return true;
  }
  return false;
}

/// Not below the square root of a number below 2^42.
std::int64_t root_rounded_up(std::int64_t square) {
  std::int64_t root = 0;
  for (std::int64_t bit = 1 << 20; bit > 0; bit >>= 1) {
    if ((root + bit) * (root + bit) < square) root += bit;
  }
  return root + 1;
}

/// As `apart_along_an_axis` along a direction with entries of at most 2^20; false along (0, 0, 0).
bool apart_along(const Vector3<std::int64_t>& direction, const FixedPoint& fixed, std::size_t first_size) {
  std::int64_t sum = 0, square = 0;
  for (const std::int64_t value : direction) sum += std::abs(value), square += value * value;
  if (sum == 0) return false;
  Int128 above = std::numeric_limits<std::int64_t>::max(), below = above;
  above <<= 32, below <<= 32;
  for (std::size_t moment = 0; moment < 2; ++moment) {
    std::array<Int128, 4> along{};
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        along[i] += Int128{fixed.at(moment, i)[axis]} * direction[axis];
      }
    }
    for (std::size_t i = 0; i < first_size; ++i) {
      for (std::size_t j = first_size; j < 4; ++j) {
        above = std::min(above, along[i] - along[j]);
        below = std::min(below, along[j] - along[i]);
      }
    }
  }
  // Each coordinate of a difference may be off by 1.
  return std::max(above, below) >= Int128{fixed.separation} * root_rounded_up(square) + sum;
}

/// About the same direction, with entries of at most 2^20.
Vector3<std::int64_t> shortened(Vector3<std::int64_t> v) {
  std::uint64_t all = 0;
  for (const std::int64_t value : v) all |= static_cast<std::uint64_t>(std::abs(value));
  const int excess = std::max(0, 44 - std::countl_zero(all));
  for (std::int64_t& value : v) value >>= excess;
  return v;
}

/// Tries directions that tell many elements apart: the normals of both, in the middle of the step, or
/// across one edge of an element, or between two vertices.
bool apart_along_a_direction(const FixedPoint& fixed, std::size_t first_size) {
  const auto path = [&](std::size_t from, std::size_t to) {
    Vector3<std::int64_t> result;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      result[axis] =
          fixed.at(0, to)[axis] - fixed.at(0, from)[axis] + fixed.at(1, to)[axis] - fixed.at(1, from)[axis];
    }
    return shortened(result);
  };
  const auto across = [](const Vector3<std::int64_t>& u, const Vector3<std::int64_t>& v) {
    Vector3<std::int64_t> result;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
      result[i] = u[j] * v[k] - u[k] * v[j];
    }
    return shortened(result);
  };
  const auto u = path(first_size == 1 ? 2 : 0, 1), v = path(2, 3);
  const Vector3<std::int64_t> normal = across(u, v);
  if (apart_along(normal, fixed, first_size) || apart_along(across(normal, u), fixed, first_size) ||
      apart_along(across(normal, v), fixed, first_size)) {
    return true;
  }
  if (first_size == 1 && apart_along(across(normal, path(1, 3)), fixed, first_size)) return true;
  for (std::size_t i = 0; i < first_size; ++i) {
    for (std::size_t j = first_size; j < 4; ++j) {
      if (apart_along(path(j, i), fixed, first_size)) return true;
    }
  }
  return false;
}

/// Entries below 2^57.
Vector3<Int128> cross(const Vector3<std::int64_t>& u, const Vector3<std::int64_t>& v) {
  Vector3<Int128> result;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
    result[i] = Int128{u[j]} * v[k] - Int128{u[k]} * v[j];
  }
  return result;
}

/// u · v / 2^64 up to an error below 1, rounded down. Entries of u below 2^116, of v below 2^57.
Int128 high_part_of_dot(const Vector3<Int128>& u, const Vector3<std::int64_t>& v) {
  Int128 high = 0, low = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    high += (u[i] >> 64) * v[i];
    low += Int128{static_cast<std::uint64_t>(u[i])} * v[i];
  }
  return high + (low >> 64);
}

/// Whether the four vertices are never in one plane: det(w, u, v), a cubic in t, has Bernstein coefficients
/// of one sign.
bool never_coplanar(const FixedPoint& fixed, std::size_t first_size) {
  std::array<Vector3<std::int64_t>, 2> u, v, w;
  for (std::size_t moment = 0; moment < 2; ++moment) {
    u[moment] = difference(fixed.at(moment, 1), fixed.at(moment, first_size == 1 ? 2 : 0));
    v[moment] = difference(fixed.at(moment, 3), fixed.at(moment, 2));
    w[moment] = difference(fixed.at(moment, 0), fixed.at(moment, 2));
  }
  // Rounding may change one entry of each product of three by 1, the others being below 2^57: a determinant
  // by less than 2^119, three of them by less than 2^121.
  const Int128 limit = fixed.exact ? 1 : Int128{1} << 57;
  const Vector3<Int128> n0 = cross(u[0], v[0]);
  const Int128 first = high_part_of_dot(n0, w[0]);
  if (first < limit && first >= -limit) return false;
  const auto same_side = [&](const Int128& value) { return first > 0 ? value >= limit : value < -limit; };
  const Vector3<Int128> n1 = cross(u[1], v[1]);
  if (!same_side(high_part_of_dot(n1, w[1]))) return false;
  Vector3<Int128> mixed = cross(u[0], v[1]);
  const Vector3<Int128> other = cross(u[1], v[0]);
  for (std::size_t i = 0; i < 3; ++i) mixed[i] += other[i];
  return same_side(high_part_of_dot(n0, w[1]) + high_part_of_dot(mixed, w[0])) &&
         same_side(high_part_of_dot(n1, w[0]) + high_part_of_dot(mixed, w[1]));
}

}  // namespace

bool stay_apart_in_fixed_point(const MotionNumbers& numbers, std::size_t first_size) {
  const FixedPoint fixed(numbers);
  return apart_along_an_axis(fixed, first_size) ||
         (numbers.back() == 0 && never_coplanar(fixed, first_size)) ||
         apart_along_a_direction(fixed, first_size);
}

}  // namespace supple
