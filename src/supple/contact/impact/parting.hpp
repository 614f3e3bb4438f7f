#pragma once

#include <array>

#include "supple/types.hpp"

namespace supple {

/// A triangle whose corners move on straight lines; an edge or a point is one with repeated corners.
struct MovingTriangle {
  std::array<Vec3d, 3> start, end;
  bool moves = true;  ///< its object does
};

/// Whether two triangles that touch at the start part or slide, decided exactly for the time just after it: a
/// plane separates them then, which both may touch. Triangles that lie flat on each other, so that the start
/// does not say on which side each of them is, must also leave a face towards its outer side: one of two that
/// face each other, or else that of the object at rest, or both.
///
/// False also for coordinates that span more than 187 bits, from the largest number to the last bit of the
/// most precise one.
///
/// Two edges of no triangle that cross each other have no side; they part only when they slide in one plane.
bool part_after_start(const MovingTriangle& a, const MovingTriangle& b);

}  // namespace supple
