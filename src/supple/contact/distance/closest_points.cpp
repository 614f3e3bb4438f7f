#include "contact/distance/closest_points.hpp"

#include <algorithm>

namespace supple {
namespace {

ClosestPoints at(const RelativePlaces<double>& places, double alpha, double beta) {
  const Vec3d difference = places.m - alpha * places.u - beta * places.w;
  return {alpha, beta, difference, dot(difference, difference)};
}

/// Where the segment from the origin along `edge` is nearest to the point `from`: a part of the edge, 0 to 1.
double nearest_part(const Vec3d& from, const Vec3d& edge) {
  const double squared_length = dot(edge, edge);
  return squared_length > 0 ? std::clamp(dot(from, edge) / squared_length, 0.0, 1.0) : 0;
}

}  // namespace

ClosestPoints closest_points(const RelativePlaces<double>& places, bool is_square) {
  const auto& [m, u, w] = places;
  const double uu = dot(u, u), uw = dot(u, w), ww = dot(w, w), um = dot(u, m), wm = dot(w, m);
  const double determinant = uu * ww - uw * uw;
  ClosestPoints best = at(places, nearest_part(m, u), 0);
  const auto keep_closer = [&](double alpha, double beta) {
    const ClosestPoints other = at(places, alpha, beta);
    if (other.squared_distance < best.squared_distance) best = other;
  };
  if (determinant > 0) {
    const double alpha = (um * ww - wm * uw) / determinant, beta = (wm * uu - um * uw) / determinant;
    const bool inside = alpha >= 0 && beta >= 0 && (is_square ? alpha <= 1 && beta <= 1 : alpha + beta <= 1);
    if (inside) keep_closer(alpha, beta);
    // Nothing is closer, up to rounding. Elements that are nearly parallel also need their borders.
    if (inside && determinant > 0x1p-20 * uu * ww) return best;
  }
  keep_closer(0, nearest_part(m, w));
  if (is_square) {
    keep_closer(nearest_part(m - w, u), 1);
    keep_closer(1, nearest_part(m - u, w));
  } else {
    const double part = nearest_part(m - u, w - u);
    keep_closer(1 - part, part);
  }
  return best;
}

}  // namespace supple
