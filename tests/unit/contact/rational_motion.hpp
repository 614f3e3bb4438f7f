#pragma once

#include <algorithm>
#include <array>

#include "supple/continuous.hpp"
#include "unit/contact/rational_clipping.hpp"

// Positions of moving elements and distances between them at a rational time, in rational arithmetic.

namespace supple::truth {

inline std::array<RationalPoint, 4> positions_at(const std::array<Vec3d, 4>& start,
                                                 const std::array<Vec3d, 4>& end, const Rational& time) {
  std::array<RationalPoint, 4> result;
  for (std::size_t i = 0; i < 4; ++i) {
    const RationalPoint from = rational(start[i]), to = rational(end[i]);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      result[i][axis] = from[axis] + time * (to[axis] - from[axis]);
    }
  }
  return result;
}

inline Rational clamped(const Rational& value) {
  return value < 0 ? Rational(0) : value > 1 ? Rational(1) : value;
}

inline RationalPoint along(const RationalPoint& from, const RationalPoint& direction, const Rational& part) {
  RationalPoint point = from;
  for (std::size_t axis = 0; axis < 3; ++axis) point[axis] += part * direction[axis];
  return point;
}

inline Rational squared_distance(const RationalPoint& p, const RationalPoint& q) {
  const RationalPoint difference = subtract(p, q);
  return dot(difference, difference);
}

inline Rational squared_distance_to_edge(const RationalPoint& p, const RationalPoint& a,
                                         const RationalPoint& b) {
  const RationalPoint edge = subtract(b, a);
  const Rational length = dot(edge, edge);
  if (length == 0) return squared_distance(p, a);
  return squared_distance(p, along(a, edge, clamped(dot(subtract(p, a), edge) / length)));
}

/// The four points are a vertex and a face.
inline Rational squared_distance_to_face(const std::array<RationalPoint, 4>& p) {
  Rational smallest = squared_distance_to_edge(p[0], p[1], p[2]);
  smallest = std::min(smallest, squared_distance_to_edge(p[0], p[2], p[3]));
  smallest = std::min(smallest, squared_distance_to_edge(p[0], p[3], p[1]));
  const RationalPoint normal = cross(subtract(p[2], p[1]), subtract(p[3], p[1]));
  const Rational square = dot(normal, normal);
  if (square == 0) return smallest;
  const Rational height = dot(subtract(p[0], p[1]), normal) / square;
  const RationalPoint foot = along(p[0], normal, -height);
  for (std::size_t i = 1; i < 4; ++i) {
    const RationalPoint &from = p[i], &to = p[i % 3 + 1];
    if (dot(cross(subtract(to, from), subtract(foot, from)), normal) < 0) return smallest;
  }
  return std::min(smallest, squared_distance(p[0], foot));
}

/// The four points are the end points of two edges.
inline Rational squared_distance_of_edges(const std::array<RationalPoint, 4>& p) {
  Rational smallest =
      std::min(squared_distance_to_edge(p[0], p[2], p[3]), squared_distance_to_edge(p[1], p[2], p[3]));
  smallest = std::min(smallest, squared_distance_to_edge(p[2], p[0], p[1]));
  smallest = std::min(smallest, squared_distance_to_edge(p[3], p[0], p[1]));
  const RationalPoint a = subtract(p[1], p[0]), b = subtract(p[3], p[2]), between = subtract(p[2], p[0]);
  const Rational aa = dot(a, a), ab = dot(a, b), bb = dot(b, b);
  const Rational determinant = aa * bb - ab * ab;
  if (determinant == 0) return smallest;
  const Rational s = (dot(between, a) * bb - dot(between, b) * ab) / determinant;
  const Rational r = (dot(between, a) * ab - dot(between, b) * aa) / determinant;
  if (s < 0 || s > 1 || r < 0 || r > 1) return smallest;
  return std::min(smallest, squared_distance(along(p[0], a, s), along(p[2], b, r)));
}

inline Rational squared_distance_at(const VertexFaceMotion& motion, const Rational& time) {
  return squared_distance_to_face(positions_at(motion.start, motion.end, time));
}
inline Rational squared_distance_at(const EdgeEdgeMotion& motion, const Rational& time) {
  return squared_distance_of_edges(positions_at(motion.start, motion.end, time));
}

}  // namespace supple::truth
