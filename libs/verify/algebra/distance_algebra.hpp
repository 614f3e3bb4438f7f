#pragma once

#include <array>
#include <boost/multiprecision/cpp_int.hpp>
#include <cstddef>
#include <span>

#include "geometry/numbers/number_vector.hpp"
#include "supple/contact.hpp"
#include "supple/types.hpp"
#include "verify/algebra/sturm.hpp"

namespace supple {

using Rational =
    boost::multiprecision::number<boost::multiprecision::cpp_rational_backend, boost::multiprecision::et_off>;

using RationalVector = NumberVector<Rational>;

inline RationalVector exact(const Vec3d& v) {
  return {Rational(v.x), Rational(v.y), Rational(v.z)};
}

/// The closest points of two elements, exactly.
struct ExactDistance {
  Rational squared;
  Feature on_a, on_b;
  std::array<Rational, 3> weights_a, weights_b;
};

/// Tries all pairs of features, for `verify` and for tests. Shares no code with the functions of
/// `distance.hpp`, which says what the features are where there are several. Elements have one to three
/// vertices with finite coordinates, at least one of them one vertex, or both two. Takes tens of microseconds
/// to milliseconds.
ExactDistance distance_by_algebra(std::span<const Vec3d> a, std::span<const Vec3d> b);

/// Whether two elements of together four vertices, of which the first `first_size` are those of the first,
/// are farther apart than the separation along some direction, at both ends of the step and so throughout.
/// Found in double precision with error bounds, for most elements that are apart.
bool clearly_apart(const std::array<Vec3d, 4>& start, const std::array<Vec3d, 4>& end, std::size_t first_size,
                   double separation);

/// Whether the inside of an edge crosses the inside of a face with corners not on one line, by the solution
/// of the equations in rationals.
bool cross_by_algebra(const std::array<Vec3d, 2>& edge, const std::array<Vec3d, 3>& face);

/// The square of a finite number.
Rational squared(double value);
/// Whether the distance is within 4 units in the last place of the root of a fraction, or infinite where no
/// double holds that. False for numbers that are negative or NaN.
bool is_accurate(double distance, const sturm::Integer& over, const sturm::Integer& under);
inline bool is_accurate(double distance, const Rational& squared) {
  return is_accurate(distance, numerator(squared), denominator(squared));
}
/// The root to at least 60 bits, rounded to double.
double rounded_root(const Rational& squared);

}  // namespace supple
