#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "supple/types.hpp"

namespace supple {

// Continuous collision: vertices move on straight paths from `start` (t = 0) to `end` (t = 1). Edges and
// faces move with their vertices. Elements are closed sets. Edges and faces may degenerate at any time.

// In two dimensions, z is 0 for all points.

/// Two points a and b, in this order, at both ends of the step.
struct PointPointMotion {
  std::array<Vec3d, 2> start, end;
};

/// A point p and an edge (e0, e1), in this order, at both ends of the step.
struct PointEdgeMotion {
  std::array<Vec3d, 3> start, end;
};

/// A vertex v and a face (f0, f1, f2), in this order, at both ends of the step.
struct VertexFaceMotion {
  std::array<Vec3d, 4> start, end;
};

/// Two edges (a0, a1) and (b0, b1), in this order, at both ends of the step.
struct EdgeEdgeMotion {
  std::array<Vec3d, 4> start, end;
};

/// A reported time is never later than the true first contact. It is earlier by at most `toi_tolerance` of
/// the step and `toi_relative_tolerance` of the true time, or 2^-1022 where that is more. Most times are
/// early by a few units in the last place.
inline constexpr double toi_tolerance = 0x1p-30, toi_relative_tolerance = 0x1p-20;

/// The most by which a reported time may be earlier than the true time `toi`.
constexpr double toi_tolerance_at(double toi) {
  const double relative = toi_relative_tolerance * toi;
  if (relative < 0x1p-1022) return 0x1p-1022;
  return relative < toi_tolerance ? relative : toi_tolerance;
}

/// When two elements touch, and which of their contacts are reported.
struct ImpactOptions {
  /// Elements count as touching when their distance is at most this value, finite and ≥ 0, in the unit of
  /// the coordinates.
  double min_separation = 0;
  /// Exact arithmetic decides pairs that floating point cannot decide. When this is off, such pairs are
  /// reported as touching `within_tolerance`, which bounds the time per pair.
  bool exact = true;
  /// Impacts with a later reported time are left out, and the search ends there: 0 to 1.
  double max_time = 1;
  /// Leaves out elements that are apart at the start, within the separation there, and part: up to `max_time`
  /// their distance keeps at least 1 - 2^-10 of that at the start. Has no effect without a separation.
  bool skip_parting = false;

  constexpr bool operator==(const ImpactOptions&) const = default;
};

/// Whether an impact is proven.
enum class ImpactCertainty : std::uint8_t {
  certain,  ///< proven: the elements touch
  /// So close that floating point cannot decide. Only when `exact` is off.
  within_tolerance,
};

/// The first contact of two elements. The certainty is exact; all numbers are rounded.
struct Impact {
  /// Time of impact in [0, 1]; see `toi_tolerance`. Positive when they are apart at the start, unless the
  /// true time is below every positive double or the impact is not `certain`.
  double toi = 0;
  ImpactCertainty certainty = ImpactCertainty::certain;
  /// Whether they touch at the start, at a distance of at most `min_separation`; `toi` is then 0. Exact.
  bool touching_at_start = false;
  /// Their distance at the start, to a relative error of 2^-20, at most the largest double. Exactly 0 when
  /// they share a point there.
  double start_distance = 0;
  /// The points that touch, in barycentric coordinates of the vertices: 1 and three coordinates in the face,
  /// 1 - s, s on edge a and 1 - r, r on edge b, 1 and 1 - s, s on the edge, or 1 and 1 for two points.
  std::array<double, 4> barycentric{};
  /// Midpoint of the two points at `toi`.
  Vec3d point;
  /// Unit vector from the face or edge to the vertex, from edge b to edge a, or from point b to point a. With
  /// a separation, between the closest points at `toi`. Where these coincide, normal to both elements, on the
  /// side of the vertex or edge a before the impact if there is one; elements that meet end to end on a line
  /// have its direction. Pushing the vertex, or edge a, along it separates them. Zero where none is defined.
  Vec3d normal;
};

/// The first impact within the step, or nothing when the elements stay apart, as exact arithmetic decides on
/// the given coordinates. All finite coordinates and all motions are allowed: also motions within one plane,
/// parallel edges, degenerate faces, and no motion. Elements with a coordinate that is not finite touch
/// nothing.
///
/// Throws `Error` when an option is out of its range. Takes about 0.1 µs for elements that stay apart and
/// 0.3 µs for others. When only exact arithmetic can decide, it takes a few microseconds, or a few
/// hundred with a separation, and allocates memory. Coordinates that differ by more than 2^100 in size can
/// then take milliseconds; docs/guarantees.md has a table.
std::optional<Impact> first_impact(const VertexFaceMotion& motion, const ImpactOptions& options = {});
std::optional<Impact> first_impact(const EdgeEdgeMotion& motion, const ImpactOptions& options = {});
/// Points and edges take some microseconds where they touch without a separation.
std::optional<Impact> first_impact(const PointPointMotion& motion, const ImpactOptions& options = {});
std::optional<Impact> first_impact(const PointEdgeMotion& motion, const ImpactOptions& options = {});

/// The true first time of contact lies in [low, high]. The two are neighbouring doubles, or equal.
struct TimeBracket {
  double low = 0, high = 0;
  constexpr bool operator==(const TimeBracket&) const = default;
};

/// Decides the same question by exact algebra, for checking: Sturm sequences of polynomials with integer
/// coefficients of any size. It shares no code with `first_impact` or `Scene::detect`, at any separation.
/// Throws `Error` when `min_separation` is negative or not finite.
///
/// Takes about 0.5 µs for most elements that stay apart, 0.1 to 1 ms for others, and seconds or more when
/// coordinates range from 1e-300 to 1e300. It always ends.
std::optional<TimeBracket> first_contact_by_algebra(const VertexFaceMotion& motion,
                                                    double min_separation = 0);
std::optional<TimeBracket> first_contact_by_algebra(const EdgeEdgeMotion& motion, double min_separation = 0);
std::optional<TimeBracket> first_contact_by_algebra(const PointPointMotion& motion,
                                                    double min_separation = 0);
std::optional<TimeBracket> first_contact_by_algebra(const PointEdgeMotion& motion, double min_separation = 0);

}  // namespace supple
