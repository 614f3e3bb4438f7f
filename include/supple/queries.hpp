#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>

#include "supple/call_limits.hpp"
#include "supple/contact.hpp"
#include "supple/description.hpp"
#include "supple/types.hpp"

namespace supple {

// Questions to the objects of a scene at their present positions: `Scene::closest`, `Scene::cast`,
// `Scene::overlaps`, `Scene::inside`. An object on a path is at its end.

/// The objects that a query sees.
struct QueryFilter {
  std::optional<ObjectId> object{};  ///< only this object; nothing: all objects of the scene
  std::uint32_t mask = 0xffffffff;   ///< objects whose `ObjectOptions::group` has a bit in common with it
};

/// Options of `Scene::closest`.
struct ClosestOptions {
  QueryFilter filter{};
  /// Points without a triangle within this distance, closed, have no result; ≥ 0.
  double max_distance = std::numeric_limits<double>::infinity();
  /// The distance is negative where the point is inside the object of the nearest triangle. The surfaces must
  /// be closed, as for `Scene::inside`.
  bool signed_distance = false;
  CallLimits limits{};
};

/// The nearest triangle of a point. Exact arithmetic decides which one it is; of several at the same distance
/// it is the one with the smallest object, then the smallest number.
struct ClosestPoint {
  ObjectId object;
  std::uint32_t triangle = 0;  ///< the user's number
  Feature feature;             ///< the smallest part of the triangle that holds the closest point; exact
  /// Within 4 units in the last place; infinite where no double holds it. Negative for a signed distance
  /// inside.
  double distance = 0;
  /// The closest point by the triangle's corners, each coordinate within 2^-50.
  std::array<double, 3> barycentric{};
  Vec3d point;  ///< rounded
  /// Unit vector from the closest point to the query's point. On the triangle: its normal, by the right-hand
  /// rule.
  Vec3d normal;

  constexpr bool operator==(const ClosestPoint&) const = default;
};

/// The points origin + t · direction with t ≥ 0. The direction need not be a unit vector.
struct Ray {
  Vec3d origin, direction;
};

/// Options of `Scene::cast`.
struct CastOptions {
  QueryFilter filter{};
  /// Also counts all triangles on the ray, which takes longer.
  bool count_hits = false;
  CallLimits limits{};
};

/// The first triangle on a ray, as a closed set: its edges and corners count. Exact arithmetic decides which
/// triangle it is; of several at the same t it is the one with the smallest object, then the smallest number.
struct RayHit {
  ObjectId object;
  std::uint32_t triangle = 0;  ///< the user's number
  /// The smallest t ≥ 0 at which the point of the ray is in the triangle, within 4 units in the last place.
  double t = 0;
  Vec3d point;                          ///< origin + t · direction, rounded
  std::array<double, 3> barycentric{};  ///< of the triangle's point nearest to `point`
  std::uint64_t hits = 1;               ///< triangles on the whole ray; 1 without `CastOptions::count_hits`

  constexpr bool operator==(const RayHit&) const = default;
};

/// One of the triangles on a ray; see `Scene::cast_all`.
struct ListedRayHit {
  std::uint32_t query = 0;  ///< the place of the ray in the list of queries
  RayHit hit;               ///< `RayHit::hits` is the number of triangles on the ray

  constexpr bool operator==(const ListedRayHit&) const = default;
};

/// The points p with min ≤ p ≤ max on each axis.
struct QueryBox {
  Vec3d min, max;
};

/// The points within `radius` of the center, closed.
struct QuerySphere {
  Vec3d center;
  double radius = 0;
};

/// A triangle that shares a point with a box or a sphere. Exact.
struct Overlap {
  std::uint32_t query = 0;  ///< the place of the box or sphere in the list of queries
  ObjectId object;
  std::uint32_t triangle = 0;  ///< the user's number

  constexpr auto operator<=>(const Overlap&) const = default;
};

/// Where a point is with respect to closed surfaces.
enum class Containment : std::uint8_t {
  outside,
  on,      ///< in a triangle
  inside,  ///< a ray from the point crosses the surface an odd number of times
};
template <>
inline constexpr std::array words<Containment>{"outside", "on", "inside"};

}  // namespace supple
