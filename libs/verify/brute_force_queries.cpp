#include "verify/brute_force.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "geometry/vector.hpp"

namespace supple {
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
  if (!nearest || (is_bounded && nearest->squared > squared(max_distance))) return {};
  const TrianglePoints& corners = surfaces[nearest_surface].triangles[nearest->place].corners;
  return ExactNearest{nearest_surface, nearest->triangle, distance_by_algebra({&point, 1}, corners)};
}

namespace {

/// Two vectors that are exactly perpendicular to a direction and independent.
std::array<Vec3d, 2> across(const Vec3d& d) {
  const int main = main_axis(absolute(d)), first = (main + 1) % 3, second = (main + 2) % 3;
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
    const auto are_beyond = [&](const Vec3d& outward) {
      return std::ranges::all_of(corners, [&](const Vec3d& corner) {
        const Vec3d p = corner - ray.origin;
        return dot(outward, p) > 0x1p-48 * dot(absolute(outward), absolute(p)) + 0x1p-1060;
      });
    };
    if (are_beyond(-axis) || (axis != ray.direction && are_beyond(axis))) return true;
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
  for (std::size_t surface = 0; surface < surfaces.size(); ++surface) {
    for (const BoxedCorners& triangle : surfaces[surface].triangles) {
      if (clearly_misses(ray, axes, triangle.corners)) continue;
      if (auto t = first_parameter(ray, axes, triangle.corners))
        hits.push_back({surface, triangle.triangle, *std::move(t)});
    }
  }
  std::ranges::sort(hits, [](const ExactHit& p, const ExactHit& q) {
    return std::tie(p.t, p.surface, p.triangle) < std::tie(q.t, q.surface, q.triangle);
  });
  return hits;
}

bool overlaps_by_brute_force(const QueryBox& box, const BoxedCorners& triangle) {
  if (!is_finite(box.min) || !is_finite(box.max)) return false;
  for (int axis = 0; axis < 3; ++axis) {
    if (box.min[axis] > box.max[axis]) return false;
    if (triangle.box.min[axis] > box.max[axis] || triangle.box.max[axis] < box.min[axis]) return false;
  }
  const auto has = [&](const Vec3d& p) {
    return box.min.x <= p.x && p.x <= box.max.x && box.min.y <= p.y && p.y <= box.max.y && box.min.z <= p.z &&
           p.z <= box.max.z;
  };
  if (std::ranges::any_of(triangle.corners, has)) return true;
  // Otherwise the triangle meets one of the faces, each of which is two triangles.
  const auto corner = [&](int bits) {
    return Vec3d{((bits & 1) != 0 ? box.max : box.min).x, ((bits & 2) != 0 ? box.max : box.min).y,
                 ((bits & 4) != 0 ? box.max : box.min).z};
  };
  for (int axis = 0; axis < 3; ++axis) {
    for (const int side : {0, 1 << axis}) {
      const Vec3d low = corner(side), high = corner(side | (7 ^ 1 << axis));
      for (const int other : {1 << (axis + 1) % 3, 1 << (axis + 2) % 3}) {
        if (triangles_intersect_by_axes({low, corner(side | other), high}, triangle.corners)) return true;
      }
    }
  }
  return false;
}

bool overlaps_by_brute_force(const QuerySphere& sphere, const BoxedCorners& triangle) {
  if (!is_finite(sphere.center) || !std::isfinite(sphere.radius) || sphere.radius < 0) return false;
  const double bound = increased(sphere.radius);
  for (int axis = 0; axis < 3; ++axis) {
    const double center = sphere.center[axis];
    if (triangle.box.min[axis] - center > bound || center - triangle.box.max[axis] > bound) return false;
  }
  const bool has_corner_inside = std::ranges::any_of(triangle.corners, [&](const Vec3d& corner) {
    return increased(scaled_norm(corner - sphere.center)) < sphere.radius;
  });
  if (has_corner_inside) return true;
  return squared_distance_by_integers(sphere.center, triangle.corners) <= squared(sphere.radius);
}

namespace {

/// Triangles with a corner that is not finite are no part of the surface, so their other corners are none of
/// its elements.
PlainObject finite_elements(PlainObject object) {
  for (Triangle& triangle : object.triangles) {
    const auto wrong = std::ranges::find_if_not(triangle, [&](auto v) { return is_finite(object.end[v]); });
    if (wrong != triangle.end()) triangle.fill(*wrong);
  }
  return object;
}

auto key_of(const NearElements& near) {
  return std::tie(near.squared, near.kind_a, near.kind_b, near.element_a, near.element_b);
}

}  // namespace

std::optional<ExactPair> nearest_pair_by_brute_force(const PlainObject& a, const PlainObject& b,
                                                     double max_distance, const Parallel& parallel) {
  const auto contacts = intersecting_pairs_by_brute_force(a, b, false, parallel);
  if (!contacts.empty()) return ExactPair{contacts.front(), {}};
  const PlainSurface surface_a(a), surface_b(b);
  if (surface_a.triangles.empty() || surface_b.triangles.empty()) return {};
  double bound = max_distance;
  for (const BoxedCorners& t : surface_a.triangles) {
    for (const Vec3d& corner : t.corners) bound = surface_b.bound_of_distance(corner, bound);
  }
  const auto found = find_proximity_by_brute_force(finite_elements(a), finite_elements(b), false,
                                                   std::min(max_distance, increased(bound)),
                                                   ProximityListing::features, ElementKinds::all, parallel);
  const auto least = std::ranges::min_element(
      found.near, [](const NearElements& p, const NearElements& q) { return key_of(p) < key_of(q); });
  return least != found.near.end() ? std::optional(ExactPair{{}, *least}) : std::nullopt;
}

}  // namespace supple
