#pragma once

#include <cstdint>

#include "supple/types.hpp"

namespace supple {

/// Whether something was there in the last step. What ends is no longer listed.
enum class Lasting : std::uint8_t { begin, stay };

/// What a manifold summarises.
enum class ManifoldSource : std::uint8_t { curve, pairs };

/// One of the points that span a manifold.
struct ManifoldPoint {
  std::uint64_t id = 0;  ///< of no other point of the scene
  Lasting lasting = Lasting::begin;
  /// A point of the curve, or a vertex that it encloses beyond the plane through its centroid at right angles
  /// to the normal; for pairs, the middle of the closest points.
  Vec3d position{};
  /// How far an enclosed vertex is beyond this plane, at most `Manifold::depth`; 0 for a point of the curve.
  /// Where no vertex is beyond the plane, all points have `Manifold::depth`. For pairs, minus the distance.
  double depth = 0;

  constexpr bool operator==(const ManifoldPoint&) const = default;
};

/// A patch of contacts of two objects, or of one object with itself, reduced to what a rigid body needs: one
/// normal, one depth, and at most four points that span it. With penetration, each `IntersectionCurve` is a
/// patch. Two objects without a curve have the patches of their proximity pairs: a patch has the nearest pair
/// that is in no patch yet, and all pairs in no patch whose normals are within 45 degrees of its normal. It
/// does not depend on how the surfaces are divided into triangles. A patch of two objects also replaces pairs
/// whose elements are as far apart along its normal as the nearest pair: for example an edge of a floor and
/// an edge of the side of a box that stands on it.
///
/// Where objects touch, or are as near as coordinates are rounded (2^-40 of their size), the points of a pair
/// give no direction. The surfaces around the points do: the direction in which a plane lies between both,
/// which is the normal of a face where there is such a face. So a box on a floor has the normal of the floor,
/// whichever of them is a. Surfaces that lie in the plane keep the side to which they look, closed ones
/// first. A pair where one surface fits into the other one has the normal of each face that keeps them apart,
/// so a box in a corner has a patch for each wall.
///
/// Pairs know nothing of depth. Two objects whose surfaces cut through each other have no manifold of pairs,
/// and a patch has none when the way between the points of its nearest pair starts inside a solid. So no
/// manifold moves a body deeper. Request penetration, too, where objects may overlap.
///
/// The points are the deepest one, the one farthest from it, and those that add most area. Of several deepest
/// ones (within 2^-40), the first is a corner of the patch. Of points that add as much, the deepest is taken.
/// Points that add less than 2^-10 of the distance of the first two are left out, so an edge has two points
/// and a vertex has one. They run counter-clockwise, seen from a.
///
/// A manifold keeps its id while it stays. Of all manifolds of two objects in two steps that follow each
/// other, those with most features in common are the same, then those whose points are nearest to each other.
/// (A feature is a vertex, edge or triangle of one object.) So the only manifold of two objects stays as long
/// as they have one; when a patch splits, one part stays and the others begin; when patches merge, one stays
/// and the others end. The points of a manifold that stays are matched in the same way. A step without
/// manifolds ends all.
struct Manifold {
  ObjectId a, b;         ///< equal for a patch of an object with itself
  std::uint64_t id = 0;  ///< of no other manifold of the scene
  Lasting lasting = Lasting::begin;
  ManifoldSource source = ManifoldSource::curve;
  /// Unit vector from b to a: that of the curve, or of the nearest pair, or of the surfaces where they touch.
  /// Zero when it is zero.
  Vec3d normal{};
  double depth = 0;               ///< that of the curve, or minus the distance of the nearest pair
  std::uint32_t first_point = 0;  ///< of `DetectResult::manifold_points`
  std::uint32_t point_count = 0;  ///< 1 to 4
  /// The index of the curve in `DetectResult::curves`, or of the nearest pair in
  /// `DetectResult::proximity_pairs`.
  std::uint32_t record = 0;

  constexpr bool operator==(const Manifold&) const = default;
};

/// A manifold of the last step that no manifold of this step continues.
struct EndedManifold {
  ObjectId a, b;  ///< they may be removed
  std::uint64_t id = 0;

  constexpr bool operator==(const EndedManifold&) const = default;
};

}  // namespace supple
