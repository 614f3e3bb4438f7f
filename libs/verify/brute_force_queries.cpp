#include "verify/brute_force_queries.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "geometry/vector.hpp"

namespace supple {
namespace {

/// More than a distance that was computed in double precision, whose squares may underflow.
double increased(double distance) {
  return distance * (1 + 0x1p-40) + 0x1p-500;
}

/// Calls `visit(surface, triangle)` for all triangles in canonical order.
template <class Visit>
void for_each_triangle(std::span<const PlainSurface> surfaces, const Visit& visit) {
  for (std::size_t s = 0; s < surfaces.size(); ++s) {
    for (const BoxedCorners& t : surfaces[s].triangles) visit(s, t);
  }
}

}  // namespace

std::optional<ExactNearest> nearest_by_brute_force(const Vec3d& point, std::span<const PlainSurface> surfaces,
                                                   double max_distance) {
  std::optional<PlainSurface::Nearest> nearest;
  std::size_t nearest_surface = 0;
  for (std::size_t s = 0; s < surfaces.size(); ++s) {
    if (surfaces[s].triangles.empty()) continue;
    PlainSurface::Nearest found = surfaces[s].nearest(point);
    if (nearest && found.squared.compare(nearest->squared) >= 0) continue;
    nearest = std::move(found);
    nearest_surface = s;
  }
  const bool is_bounded = max_distance <= std::numeric_limits<double>::max();
  if (!nearest || (is_bounded && nearest->squared.value() > squared(max_distance))) return {};
  const TrianglePoints& corners = surfaces[nearest_surface].triangles[nearest->place].corners;
  return ExactNearest{nearest_surface, nearest->triangle, distance_by_algebra({&point, 1}, corners)};
}

namespace {

/// A bound of the coordinate of a point along one of the axes of a ray, relative to the origin of the ray.
struct AlongAxis {
  double value = 0, error = 0;

  bool is_negative() const { return value < -error; }
  bool is_positive() const { return value > error; }
};

AlongAxis along(const Vec3d& axis, const Vec3d& to_point) {
  const double x = axis.x * to_point.x, y = axis.y * to_point.y, z = axis.z * to_point.z;
  return {x + y + z, 0x1p-48 * (std::fabs(x) + std::fabs(y) + std::fabs(z)) + 0x1p-1060};
}

/// The largest part of a direction, by axis.
int main_axis(const Vec3d& d) {
  const double x = std::fabs(d.x), y = std::fabs(d.y), z = std::fabs(d.z);
  return x >= y && x >= z ? 0 : y >= z ? 1 : 2;
}

/// Two vectors that are exactly perpendicular to a direction and independent.
std::array<Vec3d, 2> across(const Vec3d& d) {
  const int main = main_axis(d), first = (main + 1) % 3, second = (main + 2) % 3;
  std::array<Vec3d, 2> axes;
  axes[0][first] = d[main];
  axes[0][main] = -d[first];
  axes[1][second] = d[main];
  axes[1][main] = -d[second];
  return axes;
}

/// Whether all corners are on one side of the line of the ray, along one of the axes across it, or all behind
/// its origin.
bool clearly_misses(const Ray& ray, const std::array<Vec3d, 2>& axes, const TrianglePoints& corners) {
  for (const Vec3d& axis : {axes[0], axes[1], ray.direction}) {
    bool are_negative = true, are_positive = axis != ray.direction;
    for (const Vec3d& corner : corners) {
      const AlongAxis place = along(axis, corner - ray.origin);
      are_negative = are_negative && place.is_negative();
      are_positive = are_positive && place.is_positive();
    }
    if (are_negative || are_positive) return true;
  }
  return false;
}

/// The smallest t ≥ 0 of the line's points in the triangle. The triangle is projected along the line, where
/// the line is the point 0. What it shares with the triangle is a segment, whose ends are at corners or on
/// edges, or one point inside.
std::optional<Rational> first_parameter(const Ray& ray, const std::array<Vec3d, 2>& axes,
                                        const TrianglePoints& corners) {
  const RationalVector direction = exact(ray.direction);
  const Rational squared = dot(direction, direction);
  std::array<std::array<Rational, 2>, 3> flat;
  std::array<Rational, 3> t;
  for (std::size_t i = 0; i < 3; ++i) {
    const RationalVector to_corner = minus(exact(corners[i]), exact(ray.origin));
    for (std::size_t k = 0; k < 2; ++k) flat[i][k] = dot(exact(axes[k]), to_corner);
    t[i] = dot(direction, to_corner) / squared;
  }
  const auto turn = [&](std::size_t i, std::size_t k) {
    return flat[i][0] * flat[k][1] - flat[i][1] * flat[k][0];
  };
  const std::array<Rational, 3> parts{turn(1, 2), turn(2, 0), turn(0, 1)};
  if (const Rational whole = parts[0] + parts[1] + parts[2]; whole != 0) {
    const bool is_outside = std::ranges::any_of(
        parts, [&](const Rational& part) { return part != 0 && part.sign() != whole.sign(); });
    if (is_outside) return {};
    const Rational place = (parts[0] * t[0] + parts[1] * t[1] + parts[2] * t[2]) / whole;
    return place >= 0 ? std::optional(place) : std::nullopt;
  }
  std::vector<Rational> ends;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t k = (i + 1) % 3;
    if (flat[i][0] == 0 && flat[i][1] == 0) {
      ends.push_back(t[i]);
    } else if (turn(i, k) == 0) {
      const Rational opposite = flat[i][0] * flat[k][0] + flat[i][1] * flat[k][1];
      if (opposite >= 0) continue;
      const Rational part = opposite / (opposite - flat[i][0] * flat[i][0] - flat[i][1] * flat[i][1]);
      ends.push_back(t[k] + part * (t[i] - t[k]));
    }
  }
  if (ends.empty()) return {};
  const auto [least, greatest] = std::ranges::minmax(ends);
  return greatest >= 0 ? std::optional(std::max(least, Rational(0))) : std::nullopt;
}

}  // namespace

std::vector<ExactHit> hits_by_brute_force(const Ray& ray, std::span<const PlainSurface> surfaces) {
  std::vector<ExactHit> hits;
  if (!is_finite(ray.origin) || !is_finite(ray.direction) || ray.direction == Vec3d{}) return hits;
  const std::array<Vec3d, 2> axes = across(ray.direction);
  for_each_triangle(surfaces, [&](std::size_t surface, const BoxedCorners& triangle) {
    if (clearly_misses(ray, axes, triangle.corners)) return;
    if (auto t = first_parameter(ray, axes, triangle.corners))
      hits.push_back({surface, triangle.triangle, *std::move(t)});
  });
  std::ranges::sort(hits, [](const ExactHit& p, const ExactHit& q) {
    return std::tie(p.t, p.surface, p.triangle) < std::tie(q.t, q.surface, q.triangle);
  });
  return hits;
}

namespace {

/// The part of a convex polygon on one side of a plane across an axis.
std::vector<RationalVector> clipped(const std::vector<RationalVector>& polygon, std::size_t axis,
                                    const Rational& limit, bool keeps_less) {
  const auto is_kept = [&](const RationalVector& p) {
    return keeps_less ? p[axis] <= limit : p[axis] >= limit;
  };
  std::vector<RationalVector> result;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const RationalVector &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
    if (is_kept(p)) result.push_back(p);
    if (is_kept(p) == is_kept(q)) continue;
    const Rational part = (limit - p[axis]) / (q[axis] - p[axis]);
    RationalVector cut;
    for (std::size_t k = 0; k < 3; ++k) cut[k] = k == axis ? limit : p[k] + part * (q[k] - p[k]);
    result.push_back(cut);
  }
  return result;
}

}  // namespace

bool overlaps_by_brute_force(const QueryBox& box, const BoxedCorners& triangle) {
  if (!is_finite(box.min) || !is_finite(box.max)) return false;
  for (int axis = 0; axis < 3; ++axis) {
    if (box.min[axis] > box.max[axis]) return false;
    if (triangle.min[axis] > box.max[axis] || triangle.max[axis] < box.min[axis]) return false;
  }
  const auto has = [&](const Vec3d& p) {
    return box.min.x <= p.x && p.x <= box.max.x && box.min.y <= p.y && p.y <= box.max.y && box.min.z <= p.z &&
           p.z <= box.max.z;
  };
  if (std::ranges::any_of(triangle.corners, has)) return true;
  std::vector<RationalVector> polygon;
  for (const Vec3d& corner : triangle.corners) polygon.push_back(exact(corner));
  for (int axis = 0; axis < 3; ++axis) {
    const auto k = static_cast<std::size_t>(axis);
    polygon = clipped(polygon, k, Rational(box.min[axis]), false);
    polygon = clipped(polygon, k, Rational(box.max[axis]), true);
  }
  return !polygon.empty();
}

bool overlaps_by_brute_force(const QuerySphere& sphere, const BoxedCorners& triangle) {
  if (!is_finite(sphere.center) || !std::isfinite(sphere.radius) || sphere.radius < 0) return false;
  const double bound = increased(sphere.radius);
  for (int axis = 0; axis < 3; ++axis) {
    const double center = sphere.center[axis];
    if (triangle.min[axis] - center > bound || center - triangle.max[axis] > bound) return false;
  }
  const bool has_corner_inside = std::ranges::any_of(triangle.corners, [&](const Vec3d& corner) {
    return increased(scaled_norm(corner - sphere.center)) < sphere.radius;
  });
  if (has_corner_inside) return true;
  return squared_distance_by_integers(sphere.center, triangle.corners).value() <= squared(sphere.radius);
}

namespace {

/// A distance that the objects are within: from a corner of one to the nearest one of the other, and back.
double bound_of_distance(const PlainSurface& a, const PlainSurface& b) {
  constexpr int turns = 4;
  Vec3d point = a.triangles.front().corners[0];
  double bound = 0;
  for (int i = 0; i < turns; ++i) {
    double least = std::numeric_limits<double>::infinity();
    Vec3d nearest = point;
    for (const BoxedCorners& t : (i % 2 == 0 ? b : a).triangles) {
      for (const Vec3d& corner : t.corners) {
        const Vec3d gap = corner - point;
        const double distance = scaled_norm(gap);
        if (distance < least) std::tie(least, nearest) = std::tuple(distance, corner);
      }
    }
    if (std::isinf(least)) return least;
    point = nearest;
    bound = least;
  }
  return increased(bound);
}

/// Triangles with a corner that is not finite are no part of the surface, so their other corners are none of
/// its elements.
PlainMovingObject finite_elements(const PlainObject& object) {
  PlainMovingObject plain{object.positions, object.positions, object.triangles};
  for (Triangle& triangle : plain.triangles) {
    for (const std::uint32_t v : triangle) {
      if (is_finite(object.positions[v])) continue;
      triangle = {v, v, v};
      break;
    }
  }
  return plain;
}

auto key_of(const NearElements& near) {
  return std::tie(near.squared, near.kind_a, near.kind_b, near.element_a, near.element_b);
}

}  // namespace

std::optional<ExactPair> nearest_pair_by_brute_force(const PlainObject& a, const PlainObject& b,
                                                     double max_distance, std::optional<double> guess,
                                                     const Parallel& parallel) {
  const auto contacts = intersecting_pairs_by_brute_force(a, b, false, parallel);
  if (!contacts.empty()) return ExactPair{contacts.front(), {}};
  const PlainSurface surface_a(a), surface_b(b);
  if (surface_a.triangles.empty() || surface_b.triangles.empty()) return {};
  const PlainMovingObject of_a = finite_elements(a), of_b = finite_elements(b);
  const auto nearest_within = [&](double reach) -> std::optional<ExactPair> {
    const auto found = find_proximity_by_brute_force(of_a, of_b, false, reach, ProximityListing::features,
                                                     ElementKinds::all, parallel);
    const auto least = std::ranges::min_element(
        found.near, [](const NearElements& p, const NearElements& q) { return key_of(p) < key_of(q); });
    return least != found.near.end() ? std::optional(ExactPair{{}, *least}) : std::nullopt;
  };
  const double bound = std::min(max_distance, bound_of_distance(surface_a, surface_b));
  if (guess && *guess >= 0 && increased(*guess) < bound) {
    if (auto nearest = nearest_within(increased(*guess))) return nearest;
  }
  return nearest_within(bound);
}

}  // namespace supple
