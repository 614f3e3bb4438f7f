#include "contact/impact/parting.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>

#include "geometry/numbers/integer_points.hpp"
#include "geometry/numbers/wide_integer.hpp"

namespace supple {
namespace {

template <std::size_t limbs>
WideInteger<limbs> times(const WideInteger<limbs>& a, const WideInteger<limbs>& b) {
  return WideInteger<limbs>(product(a, b));
}

/// A polynomial of degree up to 3. Coefficients after the degree are not read.
template <class Integer>
struct StepPolynomial {
  std::array<Integer, 4> c{};
  std::size_t degree = 0;

  friend StepPolynomial operator+(const StepPolynomial& p, const StepPolynomial& q) { return sum(p, q, 1); }
  friend StepPolynomial operator-(const StepPolynomial& p, const StepPolynomial& q) { return sum(p, q, -1); }
  friend StepPolynomial operator*(const StepPolynomial& p, const StepPolynomial& q) {
    StepPolynomial result;
    result.degree = p.degree + q.degree;
    for (std::size_t i = 0; i <= p.degree; ++i) {
      for (std::size_t k = 0; k <= q.degree; ++k) result.c[i + k] += times(p.c[i], q.c[k]);
    }
    return result;
  }
  /// The sign just after the start: that of the first coefficient that is not 0.
  int sign_after_start() const {
    for (std::size_t i = 0; i <= degree; ++i) {
      if (const int first = sign(c[i]); first != 0) return first;
    }
    return 0;
  }

 private:
  static StepPolynomial sum(const StepPolynomial& p, const StepPolynomial& q, int sign) {
    StepPolynomial result;
    result.degree = std::max(p.degree, q.degree);
    for (std::size_t i = 0; i <= result.degree; ++i) {
      if (i <= p.degree) result.c[i] = p.c[i];
      if (i <= q.degree && sign > 0) result.c[i] += q.c[i];
      if (i <= q.degree && sign < 0) result.c[i] -= q.c[i];
    }
    return result;
  }
};

template <class Integer>
using Path = std::array<StepPolynomial<Integer>, 3>;
template <class Integer>
using Corners = std::array<Path<Integer>, 3>;

template <class Integer>
Path<Integer> operator-(const Path<Integer>& u, const Path<Integer>& v) {
  return {u[0] - v[0], u[1] - v[1], u[2] - v[2]};
}
template <class Integer>
StepPolynomial<Integer> dot(const Path<Integer>& u, const Path<Integer>& v) {
  return u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
}
template <class Integer>
Path<Integer> cross(const Path<Integer>& u, const Path<Integer>& v) {
  return {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
}
template <class Integer>
bool is_zero(const Path<Integer>& path) {
  return std::ranges::all_of(path, [](const auto& p) { return p.sign_after_start() == 0; });
}
template <class Integer>
Corners<Integer> at_start(Corners<Integer> corners) {
  for (Path<Integer>& corner : corners) {
    for (StepPolynomial<Integer>& p : corner) p.degree = 0;
  }
  return corners;
}
template <class Integer>
Path<Integer> side(const Corners<Integer>& corners, std::size_t i) {
  return corners[(i + 1) % 3] - corners[i];
}
template <class Integer>
Path<Integer> normal(const Corners<Integer>& corners) {
  return cross(side(corners, 0), side(corners, 1));
}

/// On which sides of each other points are along a direction, just after the start.
struct Sides {
  bool above = false, below = false;

  bool are_mixed() const { return above && below; }
  bool are_equal() const { return !above && !below; }
};
/// The sides of points from origins.
template <class Integer>
Sides sides_of(const Corners<Integer>& points, std::span<const Path<Integer>> origins,
               const Path<Integer>& n) {
  Sides sides;
  for (const Path<Integer>& p : points) {
    for (const Path<Integer>& q : origins) {
      const int sign = dot(n, p - q).sign_after_start();
      sides.above = sides.above || sign > 0;
      sides.below = sides.below || sign < 0;
    }
  }
  return sides;
}

template <class Integer>
bool separated_along_sides(const Corners<Integer>& a, const Corners<Integer>& b) {
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Path<Integer> n = cross(side(a, i), side(b, k));
      if (!is_zero(n) && !sides_of<Integer>(a, b, n).are_mixed()) return true;
    }
  }
  return false;
}

/// Whether no line along a side of `a`, in the plane across n, separates two triangles of this plane.
template <class Integer>
bool overlap_within_sides(const Corners<Integer>& a, const Corners<Integer>& b, const Path<Integer>& n) {
  for (std::size_t i = 0; i < 3; ++i) {
    if (is_zero(side(a, i))) continue;
    const Path<Integer> outward = cross(side(a, i), n);
    const Sides own = sides_of<Integer>(a, {&a[i], 1}, outward),
                others = sides_of<Integer>(b, {&a[i], 1}, outward);
    if ((!own.above && !others.below) || (!own.below && !others.above)) return false;
  }
  return true;
}

using Numbers = std::array<double, 36>;

/// `numbers` are the corners at the start and at the end, of one triangle and then of the other.
template <class Integer>
bool part(const Numbers& numbers, int lowest, bool moves_a, bool moves_b) {
  std::array<Corners<Integer>, 2> corners;
  for (std::size_t n = 0; n < 18; ++n) {
    const std::size_t at = n % 9 + n / 9 * 18;
    StepPolynomial<Integer>& p = corners[n / 9][n % 9 / 3][n % 3];
    p.c[0] = to_integer<Integer>(numbers[at], lowest);
    p.c[1] = to_integer<Integer>(numbers[at + 9], lowest) - p.c[0];
    p.degree = sign(p.c[1]) != 0 ? 1 : 0;
  }
  const auto& [a, b] = corners;
  const Path<Integer> normal_a = normal(a), normal_b = normal(b);
  const bool is_face_a = !is_zero(normal_a), is_face_b = !is_zero(normal_b);
  const Sides of_a = sides_of<Integer>(a, {&b[0], 1}, normal_b),
              of_b = sides_of<Integer>(b, {&a[0], 1}, normal_a);
  if ((is_face_a || is_face_b) && !(is_face_b && !of_a.are_mixed()) && !(is_face_a && !of_b.are_mixed()) &&
      !separated_along_sides(a, b))
    return false;
  // Do they lie flat on each other at the start?
  const Corners<Integer> start_a = at_start(a), start_b = at_start(b);
  const Path<Integer> flat_a = normal(start_a), flat_b = normal(start_b);
  Path<Integer> n = is_zero(flat_b) ? flat_a : flat_b;
  for (std::size_t i = 0; i < 9 && is_zero(n); ++i) n = cross(side(start_a, i / 3), side(start_b, i % 3));
  if (is_zero(n) || !sides_of<Integer>(start_a, start_b, n).are_equal()) return true;
  if (!overlap_within_sides(start_a, start_b, n) || !overlap_within_sides(start_b, start_a, n)) return true;
  if (is_zero(flat_a) && is_zero(flat_b)) return sides_of<Integer>(a, b, n).are_equal();
  // They slide, or one is on the outer side of the other.
  const bool a_is_outside = !is_zero(flat_b) && !of_a.below, b_is_outside = !is_zero(flat_a) && !of_b.below;
  if (is_zero(flat_a) || is_zero(flat_b) || dot(flat_a, flat_b).sign_after_start() < 0)
    return a_is_outside || b_is_outside;
  if (moves_a && moves_b) return a_is_outside && b_is_outside;
  return moves_a ? a_is_outside : b_is_outside;
}

}  // namespace

bool part_after_start(const MovingTriangle& a, const MovingTriangle& b) {
  Numbers numbers;
  std::size_t count = 0;
  for (const MovingTriangle* const triangle : {&a, &b}) {
    for (const auto* moment : {&triangle->start, &triangle->end}) {
      for (const Vec3d& p : *moment) {
        for (int axis = 0; axis < 3; ++axis) numbers[count++] = p[axis];
      }
    }
  }
  // The largest numbers are sums of fewer than 256 products of three or four differences.
  const BitRange range(numbers);
  constexpr auto most = [](int limbs) { return (limbs * 64 - 1 - 8) / 4 - 2; };
  if (range.width <= most(5)) return part<WideInteger<5>>(numbers, range.lowest, a.moves, b.moves);
  return range.width <= most(12) && part<WideInteger<12>>(numbers, range.lowest, a.moves, b.moves);
}

}  // namespace supple
