#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "supple/scene.hpp"

namespace supple {

/// A pair on which `verify` and the last `Scene::detect` differ.
struct Difference {
  ObjectId object_a, object_b;
  std::uint32_t triangle_a = 0, triangle_b = 0;
  /// True: the pair intersects and was not reported. False: it was reported and does not intersect.
  bool missed = false;

  constexpr bool operator==(const Difference&) const = default;
};

/// A pair of elements on which `verify` and the last `Scene::detect` differ.
struct ContinuousDifference {
  /// What is wrong with the pair.
  enum class Fault : std::uint8_t {
    missed,  ///< the pair touches and was not reported
    added,   ///< reported as certain, but does not touch
    late,   ///< reported with a time after the first contact, or as apart at the start while they touch there
    early,  ///< earlier than `toi_tolerance_at` allows, or as touching at the start while they are apart
  };
  ObjectId object_a, object_b;
  ElementPairKind kind = ElementPairKind::vertex_face;
  std::array<std::uint32_t, 2> element_a{}, element_b{};
  Fault fault = Fault::missed;

  constexpr bool operator==(const ContinuousDifference&) const = default;
};

/// A pair of features or elements on which `verify` and the last `Scene::detect` differ.
struct ProximityDifference {
  /// What is wrong with the pair.
  enum class Fault : std::uint8_t {
    missed,   ///< the pair is within the margins and was not reported
    added,    ///< reported, but not within the margins, or not of closest features, or twice
    inexact,  ///< reported with other features than those that are closest, or with an inaccurate distance
  };
  ObjectId object_a, object_b;
  FeatureKind kind_a = FeatureKind::vertex, kind_b = FeatureKind::vertex;
  std::array<std::uint32_t, 2> element_a{}, element_b{};
  Fault fault = Fault::missed;

  constexpr bool operator==(const ProximityDifference&) const = default;
};

/// A vertex of a on which `verify` and the last `Scene::detect` differ: inside b, on its surface, the
/// smallest vertex of a contained part, or inside b within a curve.
struct PenetrationDifference {
  /// What is wrong with the vertex.
  enum class Fault : std::uint8_t {
    missed,   ///< inside, on the surface or contained, and not reported as that
    added,    ///< reported, but not so
    inexact,  ///< reported with another triangle than the nearest, or with an inaccurate depth; or it does
              ///< not leave b when it moves along the normal of the curve by its depth
  };
  ObjectId object_a, object_b;
  std::uint32_t vertex = 0;
  Fault fault = Fault::missed;

  constexpr bool operator==(const PenetrationDifference&) const = default;
};

/// Result of `verify`: exact brute force over every triangle pair of the scene for intersections, and
/// over every vertex-face and edge-edge pair for continuous contacts and for proximity, and over every vertex
/// and triangle for penetrations and contained parts. Curves follow from the intersections; their normals and
/// depths must lead vertices inside a solid out of it. Manifolds must have the normal and the depth of their
/// curve or nearest pair, and points of it with their depths, among them the deepest; where not, the
/// difference names the smallest contact of the curve, or the nearest pair.
struct VerifyReport {
  std::uint64_t triangle_pairs_checked = 0;
  std::uint64_t intersecting_pairs = 0;
  std::uint64_t element_pairs_checked = 0;
  std::uint64_t touching_element_pairs = 0;
  std::uint64_t proximity_pairs_checked = 0;                   ///< pairs of elements
  std::uint64_t near_pairs = 0;                                ///< in the listing of the last `detect`
  std::uint64_t vertex_triangle_pairs_checked = 0;             ///< for penetration
  std::uint64_t inside_vertices = 0;                           ///< inside solids
  bool stopped = false;                                        ///< by `CallLimits::stop`, so not complete
  std::vector<Difference> differences;                         ///< sorted
  std::vector<ContinuousDifference> continuous_differences;    ///< sorted
  std::vector<ProximityDifference> proximity_differences;      ///< sorted
  std::vector<PenetrationDifference> penetration_differences;  ///< sorted by objects
  std::uint64_t difference_count() const {
    return differences.size() + continuous_differences.size() + proximity_differences.size() +
           penetration_differences.size();
  }
  bool agrees() const { return difference_count() == 0; }
};

/// An answer that differs from that of exact brute force; see `verify_closest`.
struct WrongAnswer {
  /// The place of the query in its list. For distances, the place of the pair among all pairs of objects that
  /// are tested, in ascending order.
  std::uint64_t query = 0;
  std::string found, expected;  ///< the answer, and that of brute force, in words

  bool operator==(const WrongAnswer&) const = default;
};

/// Recomputes the last `detect`, all kinds of contacts that it found, by exact arithmetic over all pairs of
/// triangles or elements, and lists every difference. It shares no octrees and no filters with `detect`; a
/// tree of exact boxes excludes pairs that are apart. Quadratic at worst: about a second for two meshes of
/// 70,000 triangles, also with penetration. Throws `Error` when an object or option changed since the last
/// `detect`, and when that call was stopped, truncated, or found no kind of contacts. A stop ends it after
/// the pair of objects that it compares.
VerifyReport verify(const Scene& scene, const CallLimits& limits = {});

// Checks of answers. Each takes the arguments of a query and its answer at the present positions. It
// decides the query again by exact arithmetic over all triangles, without octrees and without code of the
// search, and lists every wrong answer, ascending by query. An answer is right when its objects, triangles,
// elements, features, counts and places are exact, its distance or t is within 4 units in the last place,
// and barycentric coordinates of closest points are within 2^-50. Points, normals, and the barycentric
// coordinates of rays and of pairs are not compared. All run on all threads of the scene. They throw
// `Error` as the query does, and when a list is not ordered by query. 1,000 points or rays on 70,000
// triangles take seconds.

/// Decides a query of this name again by exact brute force and returns its wrong answers.
std::vector<WrongAnswer> verify_closest(const Scene& scene, std::span<const Vec3d> points,
                                        std::span<const std::optional<ClosestPoint>> results,
                                        const ClosestOptions& options = {});
std::vector<WrongAnswer> verify_cast(const Scene& scene, std::span<const Ray> rays,
                                     std::span<const std::optional<RayHit>> results,
                                     const CastOptions& options = {});
std::vector<WrongAnswer> verify_cast_all(const Scene& scene, std::span<const Ray> rays,
                                         std::span<const ListedRayHit> hits, const QueryFilter& filter = {});
std::vector<WrongAnswer> verify_overlaps(const Scene& scene, std::span<const QueryBox> boxes,
                                         std::span<const Overlap> found, const QueryFilter& filter = {});
std::vector<WrongAnswer> verify_overlaps(const Scene& scene, std::span<const QuerySphere> spheres,
                                         std::span<const Overlap> found, const QueryFilter& filter = {});
std::vector<WrongAnswer> verify_inside(const Scene& scene, std::span<const Vec3d> points,
                                       std::span<const Containment> results, const QueryFilter& filter = {});
/// For objects that intersect, the distance must be 0, and the elements must share a point and belong to
/// the triangles of the first contact.
std::vector<WrongAnswer> verify_distance(const Scene& scene, ObjectId a, ObjectId b,
                                         const std::optional<ProximityPair>& found);
std::vector<WrongAnswer> verify_distances(const Scene& scene, double max_distance,
                                          std::span<const ProximityPair> found);
std::vector<WrongAnswer> verify_any_contact(const Scene& scene, ObjectId a, ObjectId b, bool found);

}  // namespace supple
