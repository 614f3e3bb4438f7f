#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/parallel.hpp"
#include "supple/contact.hpp"
#include "supple/options.hpp"
#include "supple/penetration.hpp"
#include "supple/proximity.hpp"
#include "supple/queries.hpp"
#include "supple/triangle_intersection.hpp"
#include "supple/verify.hpp"
#include "verify/algebra/distance_algebra.hpp"
#include "verify/brute_force_elements.hpp"
#include "verify/plain_surface.hpp"

namespace supple {

/// Returns all intersecting pairs of triangles of two objects at rest, sorted. For an object with itself
/// (`same_object`), these are pairs with a < b that share no vertex id, or that meet beyond what they share
/// with `Neighbours::exact`. Triangles with a coordinate that is not finite intersect nothing.
///
/// Each pair is decided by comparing exact boxes or by exact integer arithmetic.
std::vector<TrianglePair> intersecting_pairs_by_brute_force(const PlainObject& a, const PlainObject& b,
                                                            bool same_object, const Parallel& parallel);

/// Two elements, named as in `ContinuousContact`.
struct TouchingElements {
  ElementPairKind kind = ElementPairKind::vertex_face;
  std::array<std::uint32_t, 2> element_a{}, element_b{};
  TimeBracket time;
  /// The definition leaves a little room for rounding, within which both answers are right.
  bool may_be_missing = false;
};

struct BruteForceImpacts {
  std::vector<TouchingElements> touching;  ///< in canonical order
  std::uint64_t pairs_checked = 0;
};

/// Returns all pairs of elements of these kinds that touch within the step. Each pair is decided by comparing
/// the exact boxes of the elements at both ends or by algebra. For an object with itself (`same_object`),
/// pairs that share a vertex id are left out. Elements with a coordinate that is not finite touch nothing;
/// vertices that no triangle uses are not elements.
BruteForceImpacts find_impacts_by_brute_force(const PlainObject& a, const PlainObject& b, bool same_object,
                                              const ImpactOptions& options, ElementKinds kinds,
                                              const Parallel& parallel);

/// Appends the differences between reported contacts and the truth, both in canonical order: contacts that
/// are missed or added, and times that are later than the truth or more than `toi_tolerance_at` earlier.
///
/// With `ContinuousListing::first`, a contact may be missing when both of its elements have a contact in
/// `all_reported`, of all pairs of objects, that is not later.
void compare_impacts(const ObjectPair& pair, std::span<const ContinuousContact> reported,
                     std::span<const TouchingElements> truth, ContinuousListing listing,
                     std::span<const ContinuousContact> all_reported,
                     std::vector<ContinuousDifference>& differences);

/// Two features or elements within reach, named as in `ProximityPair`.
struct NearElements {
  FeatureKind kind_a = FeatureKind::vertex, kind_b = FeatureKind::vertex;
  std::array<std::uint32_t, 2> element_a{}, element_b{};
  Feature on_a, on_b;
  Rational squared;
};

struct BruteForceProximity {
  std::vector<NearElements> near;  ///< in canonical order
  std::uint64_t pairs_checked = 0;
};

/// Returns all pairs within reach of objects at rest. Exact boxes, directions in double precision along which
/// elements are apart by far more than rounding, or rationals decide each pair of elements.
BruteForceProximity find_proximity_by_brute_force(const PlainObject& a, const PlainObject& b,
                                                  bool same_object, double reach, ProximityListing listing,
                                                  ElementKinds kinds, const Parallel& parallel);

/// Appends the differences between reported pairs and the truth, both in canonical order.
void compare_proximity(const ObjectPair& pair, std::span<const ProximityPair> reported,
                       std::span<const NearElements> truth, std::vector<ProximityDifference>& differences);

/// A vertex of one object that is inside another or on its surface.
struct ExactPenetration {
  std::uint32_t vertex = 0;
  Containment where = Containment::inside;
  std::uint32_t triangle = 0;  ///< the nearest one, if inside; the smallest of several
  Rational squared_depth;
};

struct BruteForcePenetrations {
  std::vector<ExactPenetration> vertices;  ///< ascending
  std::vector<ContainedPart> parts;
  std::uint64_t pairs_checked = 0;  ///< of a vertex and a triangle
};

/// Tests the vertices of `inner` against the triangles of `outer`, a closed surface, by integers. Double
/// precision with error bounds only discards what is clearly farther away or beside the vertex. `touching`
/// are the triangles of `inner` that intersect `outer`, ascending.
BruteForcePenetrations find_penetrations_by_brute_force(const PlainObject& inner, const PlainObject& outer,
                                                        std::span<const std::uint32_t> touching,
                                                        const Parallel& parallel);

/// Appends the differences between the truth and what was reported for one object inside another.
void compare_penetrations(const ObjectPair& pair, std::span<const Penetration> inside,
                          std::span<const std::uint32_t> on_surface, std::span<const ContainedPart> parts,
                          const BruteForcePenetrations& truth,
                          std::vector<PenetrationDifference>& differences);

/// What `verify_curves` knows of one of two objects.
struct CurveSideTruth {
  const PlainObject* object = nullptr;
  /// Its vertices inside the other object, which is solid; none when it is not.
  std::span<const ExactPenetration> inside;
};

/// Checks the curves of two objects by what follows from their definition, and appends a difference for each
/// that fails: the normal is a unit vector, the depth is at least 0, and a vertex inside the other object
/// leaves it on its way along the normal, after at most the depth (within 2^-30 of it and 2^-40 of the
/// coordinates). So the depth is also at least that of the vertex. Rationals decide this for vertices that
/// edges without contacts connect and that contacts of only one curve surround; for about 256 of them for
/// each curve and object.
void verify_curves(const ObjectPair& pair, const std::array<CurveSideTruth, 2>& sides,
                   const DetectResult& result, std::vector<PenetrationDifference>& differences);

/// Checks the manifolds of two objects by what follows from their definition, and appends a difference for
/// each that fails: at its curve, or at its nearest pair. The normal and the depth are those of the record
/// (or where surfaces touch, of length 1), each of the one to four points is a point of the contact with its
/// depth, and the deepest one is as deep as the contact. `verify_curves` checks that the way along the normal
/// leads out.
void verify_manifolds(const ObjectPair& pair, const std::array<const PlainObject*, 2>& objects,
                      const DetectResult& result, VerifyReport& report);

// Answers to queries, decided for `verify` over all triangles by rationals and integers. Double precision
// only discards what boxes or distances prove, with a slack that exceeds its rounding. Shares no code with
// the queries.

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
