#pragma once

#include <array>
#include <boost/multiprecision/cpp_int.hpp>
#include <span>

#include "supple/contact.hpp"
#include "supple/types.hpp"

namespace supple {

using Rational =
    boost::multiprecision::number<boost::multiprecision::cpp_rational_backend, boost::multiprecision::et_off>;

using RationalVector = std::array<Rational, 3>;

inline RationalVector exact(const Vec3d& v) {
  return {Rational(v.x), Rational(v.y), Rational(v.z)};
}
inline RationalVector minus(const RationalVector& a, const RationalVector& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
inline Rational dot_of(const RationalVector& a, const RationalVector& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline RationalVector cross_of(const RationalVector& a, const RationalVector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
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

/// Whether the inside of an edge crosses the inside of a face with corners not on one line, by the solution
/// of the equations in rationals.
bool cross_by_algebra(const std::array<Vec3d, 2>& edge, const std::array<Vec3d, 3>& face);

/// Whether the distance is within 4 units in the last place of the exact one.
bool is_accurate(double distance, const Rational& squared);
/// The root to at least 60 bits, rounded to double.
double rounded_root(const Rational& squared);

}  // namespace supple
