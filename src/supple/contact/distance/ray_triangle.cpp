// Signs of the volumes that the ray's direction spans with the edges, as seen from the ray's origin, decide
// on which sides of the edges the ray passes: all on one side, or on an edge. When all three are zero, the
// ray lies in the triangle's plane, or the triangle has no area: then the edges decide.

#include "contact/distance/ray_triangle.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "geometry/numbers/double_double.hpp"
#include "geometry/numbers/integer_points.hpp"
#include "geometry/numbers/number_vector.hpp"
#include "geometry/numbers/quotient.hpp"
#include "geometry/vector.hpp"

namespace supple {
namespace {

template <class Number>
using Vector = NumberVector<Number>;

/// The direction, and the corners as seen from the origin.
template <class Number>
struct RayNumbers {
  Vector<Number> direction;
  std::array<Vector<Number>, 3> corners;

  /// Volumes that the direction spans with the edges opposite to the corners.
  std::array<Number, 3> sides() const {
    return {dot(direction, cross(corners[1], corners[2])), dot(direction, cross(corners[2], corners[0])),
            dot(direction, cross(corners[0], corners[1]))};
  }
  /// Divided by the sum of the sides, the parameter at the plane.
  Number volume() const { return dot(corners[0], cross(corners[1], corners[2])); }
};

template <class Number, class MakeNumber, class MakeDifference>
RayNumbers<Number> ray_numbers(const Ray& ray, const TrianglePoints& triangle, const MakeNumber& number,
                               const MakeDifference& difference) {
  RayNumbers<Number> result;
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    result.direction[a] = number(ray.direction[axis]);
    for (std::size_t corner = 0; corner < 3; ++corner)
      result.corners[corner][a] = difference(triangle[corner][axis], ray.origin[axis]);
  }
  return result;
}

RayNumbers<BoundedDouble> bounded_numbers(const Ray& ray, const TrianglePoints& triangle) {
  return ray_numbers<BoundedDouble>(
      ray, triangle,
      [](double x) {
        return BoundedDouble{x, 0};
      },
      BoundedDouble::difference);
}

/// All numbers are multiplied by the same power of two, which the parameter does not depend on.
RayNumbers<UnboundedInteger> integer_numbers(const Ray& ray, const TrianglePoints& triangle) {
  std::array<double, 15> all{};
  std::size_t i = 0;
  for (const Vec3d& p : {ray.origin, ray.direction, triangle[0], triangle[1], triangle[2]}) {
    for (int axis = 0; axis < 3; ++axis) all[i++] = p[axis];
  }
  const int lowest = BitRange(all).lowest;
  const auto number = [&](double x) { return to_integer<UnboundedInteger>(x, lowest); };
  return ray_numbers<UnboundedInteger>(ray, triangle, number, [&](double x, double origin) {
    return UnboundedInteger(number(x) - number(origin));
  });
}

struct IntegerFraction {
  UnboundedInteger numerator, denominator;  ///< the denominator is positive

  friend bool operator<(const IntegerFraction& a, const IntegerFraction& b) {
    return a.numerator * b.denominator < b.numerator * a.denominator;
  }
};

/// The part of the ray's line within a triangle in its plane.
class PlaneSearch {
 public:
  explicit PlaneSearch(const RayNumbers<UnboundedInteger>& numbers) : d_(numbers.direction) {
    for (std::size_t i = 0; i < 3; ++i) add_edge(numbers.corners[i], numbers.corners[(i + 1) % 3]);
  }
  /// The smallest parameter ≥ 0.
  std::optional<IntegerFraction> first() const {
    if (!has_part_ || last_.numerator < 0) return {};
    return first_.numerator < 0 ? IntegerFraction{0, 1} : first_;
  }

 private:
  using Integers = Vector<UnboundedInteger>;

  static bool is_zero(const Integers& v) { return v[0] == 0 && v[1] == 0 && v[2] == 0; }

  void add_edge(const Integers& p, const Integers& q) {
    const Integers edge = difference(q, p), across = cross(d_, edge), offset = cross(p, d_);
    if (is_zero(across)) {
      if (is_zero(offset)) {
        add({dot(p, d_), dot(d_, d_)});
        add({dot(q, d_), dot(d_, d_)});
      }
      return;
    }
    const UnboundedInteger whole = dot(across, across), along = dot(offset, across);
    if (along >= 0 && along <= whole) add({dot(cross(p, edge), across), whole});
  }
  void add(const IntegerFraction& parameter) {
    if (!has_part_ || parameter < first_) first_ = parameter;
    if (!has_part_ || last_ < parameter) last_ = parameter;
    has_part_ = true;
  }

  Integers d_;
  bool has_part_ = false;
  IntegerFraction first_, last_;
};

std::optional<IntegerFraction> exact_parameter(const Ray& ray, const TrianglePoints& triangle) {
  const RayNumbers<UnboundedInteger> numbers = integer_numbers(ray, triangle);
  const auto sides = numbers.sides();
  const bool has_positive = std::ranges::any_of(sides, [](const auto& side) { return side > 0; });
  const bool has_negative = std::ranges::any_of(sides, [](const auto& side) { return side < 0; });
  if (has_positive && has_negative) return {};
  if (!has_positive && !has_negative) return PlaneSearch(numbers).first();
  IntegerFraction t{numbers.volume(), sides[0] + sides[1] + sides[2]};
  if (has_negative) t = {-t.numerator, -t.denominator};
  if (t.numerator < 0) return {};
  return t;
}

bool is_in_range(double x) {
  return std::fabs(x) > 0x1p-300 && std::fabs(x) < 0x1p300;
}

/// So well known that pairs of doubles give all bits of the value.
bool is_well_known(const BoundedDouble& x) {
  return x.bound < 0x1p-8 * std::fabs(x.value) && is_in_range(x.value);
}

}  // namespace

std::optional<RayParameter> RayParameter::find(const Ray& ray, const TrianglePoints& triangle,
                                               bool& used_exact) {
  RayParameter result(ray, triangle);
  const RayNumbers<BoundedDouble> numbers = bounded_numbers(ray, triangle);
  const auto sides = numbers.sides();
  const std::array<int, 3> signs{sign_of(sides[0]), sign_of(sides[1]), sign_of(sides[2])};
  if (std::ranges::count(signs, 1) > 0 && std::ranges::count(signs, -1) > 0) return {};
  if (std::ranges::count(signs, unknown_sign) == 0) {
    const bool is_negative = signs[0] < 0;
    BoundedDouble volume = numbers.volume(), whole = sides[0] + sides[1] + sides[2];
    if (is_negative) volume.value = -volume.value, whole.value = -whole.value;
    const int side = sign_of(volume);
    if (side == -1) return {};
    if (side == 1 && sign_of(whole) == 1) {
      result.numerator_ = volume;
      result.denominator_ = whole;
      result.is_bounded_ = true;
      return result;
    }
  }
  used_exact = true;
  if (!exact_parameter(ray, triangle)) return {};
  return result;
}

double RayParameter::rounded() const {
  // Larger numbers times very small ones would lose the lower halves of pairs.
  double largest = largest_magnitude(ray_->direction);
  for (const Vec3d& corner : triangle_) largest = std::max(largest, largest_magnitude(corner - ray_->origin));
  if (largest < 0x1p200 && is_bounded_ && is_well_known(numerator_) && is_well_known(denominator_)) {
    const auto numbers = ray_numbers<DoubleDouble>(
        *ray_, triangle_, [](double x) { return DoubleDouble(x); },
        [](double x, double origin) { return exact_sum(x, -origin); });
    const auto sides = numbers.sides();
    return static_cast<double>(numbers.volume()) / static_cast<double>(sides[0] + sides[1] + sides[2]);
  }
  const IntegerFraction t = *exact_parameter(*ray_, triangle_);
  return Quotient(t.numerator, t.denominator).value();
}

double RayParameter::upper_bound() const {
  const bool is_known = is_bounded_ && is_well_known(numerator_) && is_well_known(denominator_);
  const double value = is_known
                           ? (numerator_.value + numerator_.bound) / (denominator_.value - denominator_.bound)
                           : rounded();
  return value * (1 + 0x1p-45) + 0x1p-1060;
}

int RayParameter::compare(const RayParameter& other, bool& used_exact) const {
  if (is_bounded_ && other.is_bounded_) {
    const int side = sign_of(numerator_ * other.denominator_ - other.numerator_ * denominator_);
    if (side != unknown_sign) return side;
  }
  used_exact = true;
  const IntegerFraction a = *exact_parameter(*ray_, triangle_),
                        b = *exact_parameter(*other.ray_, other.triangle_);
  return sign(UnboundedInteger(a.numerator * b.denominator - b.numerator * a.denominator));
}

}  // namespace supple
