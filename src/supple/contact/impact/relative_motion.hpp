#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "geometry/vector.hpp"
#include "supple/continuous.hpp"
#include "supple/types.hpp"

namespace supple {

/// A vertex and a face, or two edges: all public motions as one type. A point or an edge is the face that it
/// spans.
struct ElementMotion {
  std::array<Vec3d, 4> start{}, end{};
  bool are_edges = false;

  ElementMotion() = default;
  ElementMotion(const VertexFaceMotion& motion) : start(motion.start), end(motion.end) {}
  ElementMotion(const EdgeEdgeMotion& motion) : start(motion.start), end(motion.end), are_edges(true) {}
  ElementMotion(const PointPointMotion& motion) {
    for (std::size_t i = 0; i < 4; ++i) {
      start[i] = motion.start[std::min<std::size_t>(i, 1)];
      end[i] = motion.end[std::min<std::size_t>(i, 1)];
    }
  }
  ElementMotion(const PointEdgeMotion& motion) {
    for (std::size_t i = 0; i < 4; ++i) {
      start[i] = motion.start[std::min<std::size_t>(i, 2)];
      end[i] = motion.end[std::min<std::size_t>(i, 2)];
    }
  }
};

inline double largest_coordinate(const ElementMotion& motion) {
  double largest = 0;
  for (std::size_t i = 0; i < 4; ++i)
    largest = std::max({largest, largest_magnitude(motion.start[i]), largest_magnitude(motion.end[i])});
  return largest;
}

/// Two elements relative to each other. The differences of their points are `m` - alpha `u` - beta `w`, where
/// (alpha, beta) runs over the triangle alpha, beta >= 0, alpha + beta <= 1 for a vertex and a face, and over
/// the unit square for two edges. All three vectors move linearly from `start` to `end`.
template <class Scalar>
struct RelativePlaces {
  Vec3<Scalar> m, u, w;
};
struct RelativeMotion {
  RelativePlaces<double> start, end;
  bool is_square = false;
};

inline RelativePlaces<double> relative_vertex_face(const std::array<Vec3d, 4>& p) {
  return {p[0] - p[1], p[2] - p[1], p[3] - p[1]};
}
inline RelativePlaces<double> relative_edge_edge(const std::array<Vec3d, 4>& p) {
  return {p[0] - p[2], p[0] - p[1], p[3] - p[2]};
}
inline RelativeMotion relative_motion(const ElementMotion& motion) {
  if (motion.are_edges) return {relative_edge_edge(motion.start), relative_edge_edge(motion.end), true};
  return {relative_vertex_face(motion.start), relative_vertex_face(motion.end), false};
}

/// The motion from time 0 to `until`. Its rounding errors are relative to the vectors, not to the positions.
inline RelativeMotion part_of_motion(RelativeMotion motion, float until) {
  auto& [start, end, is_square] = motion;
  end = {mix(start.m, end.m, until), mix(start.u, end.u, until), mix(start.w, end.w, until)};
  return motion;
}

}  // namespace supple
