#pragma once

#include <optional>

#include "contact/impact/relative_motion.hpp"

namespace supple {

/// The first time at which two elements touch, by integer arithmetic: exact for all finite coordinates, also
/// where elements coincide, collapse or stay in one plane. Nothing when they do not touch within the step or
/// a coordinate is not finite. `first_impact` calls it where floating point cannot decide.
///
/// Takes 1 to 10 µs while the coordinates of an axis span at most 124 bits, from the largest number to the
/// last bit of the most precise one. Wider spans, and polynomials with a double root where the elements come
/// near, take integers of any length: mostly below 100 µs, but milliseconds where some coordinates are 2^1000
/// times as large as others. docs/guarantees.md has a table.
std::optional<TimeBracket> exact_first_contact(const ElementMotion& motion);

/// For elements that touch at the start: the first time after it at which they touch again. Nothing when they
/// do not, and when their four vertices stay in one plane.
std::optional<TimeBracket> exact_next_contact(const ElementMotion& motion);

/// The first time at which two elements are at a distance of at most `separation` > 0. All numbers are
/// finite. Takes tens to hundreds of microseconds, and some milliseconds where coordinates range from 1e-300
/// to 1e300.
std::optional<TimeBracket> exact_first_contact(const ElementMotion& motion, double separation);

/// The distance that two elements keep in a safe step: the share `keep`, 0 to 1, of their distance D at the
/// start, or `separation` + `keep` (D - `separation`) where D is larger than the separation.
struct KeptDistance {
  double separation = 0, keep = 0;
};

/// The first time at which two elements are at a distance of at most the one that they keep: 0 when they
/// share a point at the start. Takes up to a few milliseconds where that distance is no rational number.
std::optional<TimeBracket> exact_first_contact(const ElementMotion& motion, const KeptDistance& kept);

}  // namespace supple
