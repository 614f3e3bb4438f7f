#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/parallel.hpp"
#include "supple/queries.hpp"
#include "supple/triangle_intersection.hpp"
#include "verify/algebra/distance_algebra.hpp"
#include "verify/brute_force_contacts.hpp"
#include "verify/brute_force_proximity.hpp"
#include "verify/plain_surface.hpp"

// Answers to queries, decided for `verify` over all triangles by rationals and integers. Double precision
// only discards what boxes or distances prove, with a slack that exceeds its rounding. Shares no code with
// the queries.
namespace supple {

/// The objects that a query sees, in canonical order.
struct PlainScene {
  std::vector<ObjectId> ids;
  std::vector<PlainSurface> surfaces;
};

struct ExactNearest {
  std::size_t surface = 0;
  std::uint32_t triangle = 0;  ///< the user's number
  ExactDistance distance;      ///< of the point and the triangle
};
/// The nearest triangle of a finite point within the distance, closed; of several, the first surface and
/// triangle.
std::optional<ExactNearest> nearest_by_brute_force(const Vec3d& point, std::span<const PlainSurface> surfaces,
                                                   double max_distance);

struct ExactHit {
  std::size_t surface = 0;
  std::uint32_t triangle = 0;  ///< the user's number
  Rational t;
};
/// All triangles on a ray, by the smallest t ≥ 0, then by surface and triangle. None when a number of the ray
/// is not finite or its direction is zero.
std::vector<ExactHit> hits_by_brute_force(const Ray& ray, std::span<const PlainSurface> surfaces);

/// Whether a triangle shares a point with a box or a sphere, as `Scene::overlaps` defines them.
bool overlaps_by_brute_force(const QueryBox& box, const BoxedCorners& triangle);
bool overlaps_by_brute_force(const QuerySphere& sphere, const BoxedCorners& triangle);

/// The first contact of two objects, or their nearest features when they do not intersect.
struct ExactPair {
  std::optional<TrianglePair> contact;
  NearElements nearest;
};
/// Nothing when they are farther apart than `max_distance`, or when one has no finite triangle.
std::optional<ExactPair> nearest_pair_by_brute_force(const PlainObject& a, const PlainObject& b,
                                                     double max_distance, const Parallel& parallel);

}  // namespace supple
