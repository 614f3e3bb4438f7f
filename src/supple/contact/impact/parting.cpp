#include "contact/impact/parting.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>

#include "geometry/numbers/bounded_double.hpp"
#include "geometry/numbers/double_double.hpp"
#include "geometry/numbers/integer_points.hpp"
#include "geometry/numbers/number_vector.hpp"
#include "geometry/numbers/wide_integer.hpp"

namespace supple {
namespace {

/// A double and a bound of its error, which is 0 as long as operations are exact: coordinates of grids and
/// coordinates that are equal keep their zeros. For multiples of 2^-700 below 2^500.
struct TrackedDouble {
  double value = 0, bound = 0;

  TrackedDouble& operator+=(const TrackedDouble& other) {
    const DoubleDouble sum = exact_sum(value, other.value);
    return *this = {sum.high, (bound + other.bound + std::fabs(sum.low)) * (1 + 0x1p-49)};
  }
  TrackedDouble& operator-=(const TrackedDouble& other) { return *this += {-other.value, other.bound}; }
};
TrackedDouble times(const TrackedDouble& a, const TrackedDouble& b) {
  const DoubleDouble product = exact_product(a.value, b.value);
  const double error = std::fabs(a.value) * b.bound + a.bound * (std::fabs(b.value) + b.bound);
  return {product.high, (error + std::fabs(product.low)) * (1 + 0x1p-49)};
}
int sign_of(const TrackedDouble& n) {
  if (std::fabs(n.value) > n.bound) return n.value > 0 ? 1 : -1;
  return n.value == 0 && n.bound == 0 ? 0 : unknown_sign;
}

template <std::size_t limbs>
WideInteger<limbs> times(const WideInteger<limbs>& a, const WideInteger<limbs>& b) {
  return WideInteger<limbs>(product(a, b));
}
template <std::size_t limbs>
int sign_of(const WideInteger<limbs>& n) {
  return sign(n);
}

/// A polynomial of degree up to 3. Coefficients after the degree are not read.
template <class Number>
struct StepPolynomial {
  std::array<Number, 4> c{};
  std::size_t degree = 0;

  friend StepPolynomial operator+(StepPolynomial p, const StepPolynomial& q) {
    for (; p.degree < q.degree; p.c[p.degree] = {}) ++p.degree;
    for (std::size_t i = 0; i <= q.degree; ++i) p.c[i] += q.c[i];
    return p;
  }
  /// Without leading zeros: the sides of a triangle that does not turn have none.
  friend StepPolynomial operator-(StepPolynomial p, const StepPolynomial& q) {
    for (; p.degree < q.degree; p.c[p.degree] = {}) ++p.degree;
    for (std::size_t i = 0; i <= q.degree; ++i) p.c[i] -= q.c[i];
    while (p.degree > 0 && sign_of(p.c[p.degree]) == 0) --p.degree;
    return p;
  }
  friend StepPolynomial operator*(const StepPolynomial& p, const StepPolynomial& q) {
    StepPolynomial result;
    result.degree = p.degree + q.degree;
    for (std::size_t i = 0; i <= p.degree; ++i) {
      for (std::size_t k = 0; k <= q.degree; ++k) result.c[i + k] += times(p.c[i], q.c[k]);
    }
    return result;
  }
};

/// On which sides of each other points are along a direction, just after the start.
struct Sides {
  bool above = false, below = false;

  bool are_mixed() const { return above && below; }
  bool are_equal() const { return !above && !below; }
};

using AllCoordinates = std::array<double, 36>;

template <class Number>
class Parting {
 public:
  /// The corners at the start and at the end, of one triangle and then of the other.
  template <class ToNumber>
  Parting(const AllCoordinates& coordinates, const ToNumber& to_number) {
    for (std::size_t n = 0; n < 18; ++n) {
      const std::size_t at = n % 9 + n / 9 * 18;
      StepPolynomial<Number>& p = corners_[n / 9][n % 9 / 3][n % 3];
      p.c[0] = to_number(coordinates[at]);
      p.c[1] = to_number(coordinates[at + 9]);
      p.c[1] -= p.c[0];
      p.degree = coordinates[at] != coordinates[at + 9] ? 1 : 0;
    }
  }

  /// Nothing when a sign is not known.
  std::optional<bool> part(bool moves_a, bool moves_b) const {
    const bool result = do_part(moves_a, moves_b);
    return is_known_ ? std::optional(result) : std::nullopt;
  }

 private:
  using Path = NumberVector<StepPolynomial<Number>>;
  using Corners = std::array<Path, 3>;

  /// The sign just after the start: that of the first coefficient that is not 0.
  int sign_after_start(const StepPolynomial<Number>& p) const {
    for (std::size_t i = 0; i <= p.degree; ++i) {
      if (const int first = sign_of(p.c[i]); first != 0) {
        is_known_ = is_known_ && first != unknown_sign;
        return first;
      }
    }
    return 0;
  }
  bool is_zero(const Path& path) const {
    return std::ranges::all_of(path, [&](const auto& p) { return sign_after_start(p) == 0; });
  }
  static Path difference(const Path& u, const Path& v) { return {u[0] - v[0], u[1] - v[1], u[2] - v[2]}; }
  static Corners at_start(Corners corners) {
    for (Path& corner : corners) {
      for (StepPolynomial<Number>& p : corner) p.degree = 0;
    }
    return corners;
  }
  static Path side(const Corners& corners, std::size_t i) {
    return difference(corners[(i + 1) % 3], corners[i]);
  }
  static Path normal(const Corners& corners) { return cross(side(corners, 0), side(corners, 1)); }

  /// The sides of points from origins.
  Sides sides_of(std::span<const Path> points, std::span<const Path> origins, const Path& n) const {
    Sides sides;
    for (const Path& p : points) {
      for (const Path& q : origins) {
        const int sign = sign_after_start(dot(n, difference(p, q)));
        sides.above = sides.above || sign > 0;
        sides.below = sides.below || sign < 0;
      }
    }
    return sides;
  }
  /// Both ends of a side are at one place along a normal to it, so one of them is enough.
  bool are_separated_along_sides() const {
    const auto& [a, b] = corners_;
    for (std::size_t i = 0; i < 9; ++i) {
      const Path n = cross(side(a, i / 3), side(b, i % 3));
      const std::array<Path, 2> of_a{a[i / 3], a[(i / 3 + 2) % 3]}, of_b{b[i % 3], b[(i % 3 + 2) % 3]};
      if (!is_zero(n) && !sides_of(of_a, of_b, n).are_mixed()) return true;
    }
    return false;
  }
  /// Whether no line along a side of `a`, in the plane across n, separates two triangles of this plane.
  bool overlap_within_sides(const Corners& a, const Corners& b, const Path& n) const {
    for (std::size_t i = 0; i < 3; ++i) {
      if (is_zero(side(a, i))) continue;
      const Path outward = cross(side(a, i), n);
      const Sides own = sides_of({&a[(i + 2) % 3], 1}, {&a[i], 1}, outward),
                  others = sides_of(b, {&a[i], 1}, outward);
      if ((!own.above && !others.below) || (!own.below && !others.above)) return false;
    }
    return true;
  }
  bool do_part(bool moves_a, bool moves_b) const;

  std::array<Corners, 2> corners_;
  mutable bool is_known_ = true;
};

template <class Number>
bool Parting<Number>::do_part(bool moves_a, bool moves_b) const {
  const auto& [a, b] = corners_;
  const Path normal_a = normal(a), normal_b = normal(b);
  const bool is_face_a = !is_zero(normal_a), is_face_b = !is_zero(normal_b);
  const Sides of_a = sides_of(a, {&b[0], 1}, normal_b), of_b = sides_of(b, {&a[0], 1}, normal_a);
  if ((is_face_a || is_face_b) && !(is_face_b && !of_a.are_mixed()) && !(is_face_a && !of_b.are_mixed()) &&
      !are_separated_along_sides())
    return false;
  // Do they lie flat on each other at the start?
  const Corners start_a = at_start(a), start_b = at_start(b);
  const Path flat_a = normal(start_a), flat_b = normal(start_b);
  Path n = is_zero(flat_b) ? flat_a : flat_b;
  for (std::size_t i = 0; i < 9 && is_zero(n); ++i) n = cross(side(start_a, i / 3), side(start_b, i % 3));
  if (is_zero(n) || !sides_of(start_a, start_b, n).are_equal()) return true;
  if (!overlap_within_sides(start_a, start_b, n) || !overlap_within_sides(start_b, start_a, n)) return true;
  if (is_zero(flat_a) && is_zero(flat_b)) return sides_of(a, b, n).are_equal();
  // They slide, or one is on the outer side of the other.
  const bool a_is_outside = !is_zero(flat_b) && !of_a.below, b_is_outside = !is_zero(flat_a) && !of_b.below;
  if (is_zero(flat_a) || is_zero(flat_b) || sign_after_start(dot(flat_a, flat_b)) < 0)
    return a_is_outside || b_is_outside;
  if (moves_a && moves_b) return a_is_outside && b_is_outside;
  return moves_a ? a_is_outside : b_is_outside;
}

}  // namespace

bool part_after_start(const MovingTriangle& a, const MovingTriangle& b) {
  AllCoordinates coordinates;
  std::size_t count = 0;
  for (const MovingTriangle* const triangle : {&a, &b}) {
    for (const auto* moment : {&triangle->start, &triangle->end}) {
      for (const Vec3d& p : *moment) {
        for (int axis = 0; axis < 3; ++axis) coordinates[count++] = p[axis];
      }
    }
  }
  // The largest numbers are sums of fewer than 256 products of three or four differences.
  constexpr auto most = [](int limbs) { return (limbs * 64 - 1 - 8) / 4 - 2; };
  const BitRange range(coordinates);
  if (range.width > most(12)) return false;
  // Products of up to four differences are multiples of 2^-608 and below 2^364.
  if (range.lowest >= -152 && range.lowest + range.width <= 90) {
    const Parting<TrackedDouble> tracked(coordinates, [](double x) { return TrackedDouble{x}; });
    if (const std::optional<bool> known = tracked.part(a.moves, b.moves)) return *known;
  }
  const auto exactly = [&]<class Integer>(Integer) {
    const auto to_number = [&](double x) { return to_integer<Integer>(x, range.lowest); };
    return *Parting<Integer>(coordinates, to_number).part(a.moves, b.moves);
  };
  return range.width <= most(5) ? exactly(WideInteger<5>()) : exactly(WideInteger<12>());
}

}  // namespace supple
