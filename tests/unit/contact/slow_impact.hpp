#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>

#include "supple/continuous.hpp"
#include "unit/contact/rational_clipping.hpp"

// Finds when moving elements first touch, from their distance instead of polynomials in time.
namespace supple::truth {

template <class Real>
using Point = std::array<Real, 3>;

template <class Real>
Point<Real> combine(const Point<Real>& a, const Real& weight, const Point<Real>& b) {
  return {a[0] + weight * b[0], a[1] + weight * b[1], a[2] + weight * b[2]};
}
template <class Real>
Point<Real> offset(const Point<Real>& from, const Point<Real>& to) {
  return combine<Real>(to, Real(-1), from);
}
template <class Real>
Real inner_product(const Point<Real>& a, const Point<Real>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

template <class Real>
Real squared_distance_to_segment(const Point<Real>& p, const Point<Real>& a, const Point<Real>& b) {
  const Point<Real> along = offset(a, b), away = offset(a, p);
  const Real length = inner_product(along, along), part = inner_product(along, away);
  const Real weight = length > 0 ? std::clamp<Real>(part / length, Real(0), Real(1)) : Real(0);
  const Point<Real> nearest = combine<Real>(away, -weight, along);
  return inner_product(nearest, nearest);
}

/// The squared distance of `m` from the plane α u + β w, if `allowed` accepts the nearest point's α and β.
template <class Real, class Allowed>
std::optional<Real> squared_distance_inside(const Point<Real>& m, const Point<Real>& u, const Point<Real>& w,
                                            Allowed allowed) {
  const Real uu = inner_product(u, u), uw = inner_product(u, w), ww = inner_product(w, w);
  const Real mu = inner_product(m, u), mw = inner_product(m, w), area = uu * ww - uw * uw;
  if (area <= 0) return {};
  const Real alpha = (mu * ww - mw * uw) / area, beta = (mw * uu - mu * uw) / area;
  if (!allowed(alpha, beta)) return {};
  const Point<Real> rest = combine<Real>(combine<Real>(m, -alpha, u), -beta, w);
  return inner_product(rest, rest);
}

template <class Real>
Real squared_distance(const VertexFaceMotion&, const std::array<Point<Real>, 4>& p) {
  const Real sides =
      std::min({squared_distance_to_segment(p[0], p[1], p[2]), squared_distance_to_segment(p[0], p[2], p[3]),
                squared_distance_to_segment(p[0], p[3], p[1])});
  const auto inside =
      squared_distance_inside(offset(p[1], p[0]), offset(p[1], p[2]), offset(p[1], p[3]),
                              [](const Real& a, const Real& b) { return a >= 0 && b >= 0 && a + b <= 1; });
  return inside ? std::min(sides, *inside) : sides;
}
template <class Real>
Real squared_distance(const EdgeEdgeMotion&, const std::array<Point<Real>, 4>& p) {
  const Real ends = std::min(
      {squared_distance_to_segment(p[0], p[2], p[3]), squared_distance_to_segment(p[1], p[2], p[3]),
       squared_distance_to_segment(p[2], p[0], p[1]), squared_distance_to_segment(p[3], p[0], p[1])});
  const auto inside = squared_distance_inside(
      offset(p[2], p[0]), offset(p[1], p[0]), offset(p[2], p[3]),
      [](const Real& a, const Real& b) { return a >= 0 && a <= 1 && b >= 0 && b <= 1; });
  return inside ? std::min(ends, *inside) : ends;
}

template <class Real, class Motion>
Real squared_distance_at(const Motion& motion, const Real& time) {
  std::array<Point<Real>, 4> points;
  for (std::size_t i = 0; i < 4; ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      const Real start(motion.start[i][axis]), end(motion.end[i][axis]);
      points[i][static_cast<std::size_t>(axis)] = start + time * (end - start);
    }
  }
  return squared_distance(motion, points);
}

template <class Motion>
bool touch_at(const Motion& motion, double time) {
  return squared_distance_at(motion, Rational(time)) == 0;
}

/// The first time at which elements of about unit size are within `near`, if any. Each step is too short to
/// cross the remaining distance.
template <class Motion>
std::optional<double> advance_until_near(const Motion& motion, double near) {
  double speed = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const Vec3d v = (motion.end[i] - motion.start[i]) - (motion.end[j] - motion.start[j]);
      speed = std::max(speed, std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z));
    }
  }
  for (double time = 0;;) {
    const double distance = std::sqrt(squared_distance_at(motion, time));
    if (distance <= near) return time;
    if (time == 1 || speed == 0) return {};
    time = std::min(1.0, time + (distance - near / 2) / speed);
  }
}

}  // namespace supple::truth
