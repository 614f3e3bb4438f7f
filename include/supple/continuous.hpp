#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "supple/types.hpp"

namespace supple {

// Continuous collision: vertices go on straight paths from `start` (t = 0) to `end` (t = 1), and with them
// edges and faces. Elements are closed sets; edges and faces may collapse to less at any time.

/// A vertex and a face: v, f0, f1, f2 at both ends of the step.
struct VertexFaceMotion {
  std::array<Vec3d, 4> start, end;
};

/// Two edges: a0, a1, b0, b1 at both ends of the step.
struct EdgeEdgeMotion {
  std::array<Vec3d, 4> start, end;
};

/// A reported time is never later than the true first contact, and at most this much earlier, the step being
/// 1. Mostly it is some units in the last place early.
inline constexpr double toi_tolerance = 0x1p-30;

struct ImpactOptions {
  /// The elements touch when their distance is at most this, finite and ≥ 0.
  double min_separation = 0;
  /// Decide by exact arithmetic what floating point cannot. Otherwise such pairs are reported as touching
  /// `within_tolerance`, which bounds the time that a pair can take.
  bool exact = true;
};

enum class ImpactCertainty : std::uint8_t {
  certain,           ///< proven: the elements touch
  within_tolerance,  ///< they come so close that floating point cannot tell; only with `exact` off
};

/// The first moment at which two elements touch.
struct Impact {
  /// In [0, 1]; see `toi_tolerance`. Exactly 0 when they touch from the start.
  double toi = 0;
  ImpactCertainty certainty = ImpactCertainty::certain;
  /// Where on the elements, as weights of the four vertices: 1 and the barycentric coordinates in the face,
  /// or 1 - s, s, 1 - r, r along the two edges. Rounded.
  std::array<double, 4> barycentric{};
  /// Midway between the two points, at `toi`. Rounded.
  Vec3d point;
  /// Unit vector that points from the face to the side of the vertex before the impact, or from edge b to the
  /// side of edge a: pushing the vertex, or edge a, along it parts them. Zero only where nothing tells a
  /// direction.
  Vec3d normal;
};

/// The first impact within the step, or nothing, as exact arithmetic decides on the given coordinates,
/// whatever finite numbers they are: also for motion within one plane, parallel edges, collapsed faces and no
/// motion at all. Elements with a coordinate that is not finite touch nothing.
///
/// Throws `Error` when `min_separation` is negative or not finite. Takes about 0.1 µs for elements that stay
/// apart and 0.3 µs for others; where only exact arithmetic can tell, some microseconds, and some hundreds of
/// them with a separation. Allocates memory only in that case. Coordinates that differ by more than 2^100 in
/// size can take milliseconds there, the worst of them tenths of a second.
std::optional<Impact> first_impact(const VertexFaceMotion& motion, const ImpactOptions& options = {});
std::optional<Impact> first_impact(const EdgeEdgeMotion& motion, const ImpactOptions& options = {});

/// The true first time of contact lies in [low, high]: neighbouring doubles, or the same.
struct TimeBracket {
  double low = 0, high = 0;
  constexpr bool operator==(const TimeBracket&) const = default;
};

/// The same question answered by algebra alone, for checking: polynomials with integer coefficients of
/// unlimited size, their roots isolated, and the conditions' signs taken at the roots. Unrelated code without
/// any floating-point arithmetic. Takes a fraction of a microsecond for most elements that stay apart, some
/// tens of microseconds for others, some hundreds with a separation, and tenths of a second at worst when
/// coordinates range from 1e-300 to 1e300.
std::optional<TimeBracket> first_contact_by_algebra(const VertexFaceMotion& motion,
                                                    double min_separation = 0);
std::optional<TimeBracket> first_contact_by_algebra(const EdgeEdgeMotion& motion, double min_separation = 0);

}  // namespace supple
