#include "contact/intersection/meeting_point.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <utility>

#include "geometry/exact_predicates.hpp"
#include "geometry/numbers/integer_points.hpp"
#include "geometry/plane_filter.hpp"

namespace supple {
namespace {

/// Distances of an edge's end points from the plane or line that it crosses, up to a common factor.
struct Distances {
  double first, second;
};

struct Edge {
  Vec3d first, second;  // in lexicographic order

  Edge(const TrianglePoints& triangle, int index)
      : first(triangle[index]), second(triangle[(index + 1) % 3]) {
    if (lexicographically_less(second, first)) std::swap(first, second);
  }
};

bool less(const Edge& a, const Edge& b) {
  if (a.first != b.first) return lexicographically_less(a.first, b.first);
  return lexicographically_less(a.second, b.second);
}

Distances distances_from_plane(const Edge& edge, const TrianglePoints& triangle) {
  const auto& [r, s, t] = triangle;
  const FilteredPlane plane(r, s, t);
  const Filtered first = plane.side(edge.first), second = plane.side(edge.second);
  const double sum = std::fabs(first.value) + std::fabs(second.value);
  if (std::max(first.bound, second.bound) < accepted_distance_error * sum && std::isfinite(sum)) {
    return {std::fabs(first.value), std::fabs(second.value)};
  }
  const std::array points{r, s, t, edge.first, edge.second};
  return with_integers(points, std::array{0, 1, 2}, [](const auto& i) {
    const auto u = difference(i[1], i[0]), v = difference(i[2], i[0]);
    const auto [p_distance, q_distance] = relative_magnitudes(determinant(u, v, difference(i[3], i[0])),
                                                              determinant(u, v, difference(i[4], i[0])));
    return Distances{p_distance, q_distance};
  });
}

Distances distances_from_line(const Edge& edge, const Edge& other) {
  Distances best{0, 0};
  for (int axis = 0; axis < 3; ++axis) {
    const Filtered first = filtered_turn(other.first, other.second, edge.first, axis);
    const Filtered second = filtered_turn(other.first, other.second, edge.second, axis);
    const double sum = std::fabs(first.value) + std::fabs(second.value);
    const bool accurate =
        std::max(first.bound, second.bound) < accepted_distance_error * sum && std::isfinite(sum);
    if (accurate && sum > best.first + best.second) best = {std::fabs(first.value), std::fabs(second.value)};
  }
  for (int axis = 0; best.first + best.second == 0; ++axis) {
    assert(axis < 3 && "the edges are not parallel");
    const std::array points{edge.first, edge.second, other.first, other.second};
    best = with_integers(points, std::array{(axis + 1) % 3, (axis + 2) % 3}, [](const auto& i) {
      const auto u = difference(i[3], i[2]);
      const auto [p_distance, q_distance] =
          relative_magnitudes(determinant(u, difference(i[0], i[2])), determinant(u, difference(i[1], i[2])));
      return Distances{p_distance, q_distance};
    });
  }
  return best;
}

/// The point at the fraction `part`, 0 to 1/2, of the way.
double interpolate(double from, double to, double part) {
  const double extent = to - from;
  if (std::isfinite(extent)) return from + part * extent;
  return 4 * (from / 4 + part * (to / 4 - from / 4));
}

Vec3d crossing(const Edge& edge, const Distances& distances) {
  const bool nearer_first = distances.first <= distances.second;
  const Vec3d& from = nearer_first ? edge.first : edge.second;
  const Vec3d& to = nearer_first ? edge.second : edge.first;
  const double part = std::min(distances.first, distances.second) / (distances.first + distances.second);
  return {interpolate(from.x, to.x, part), interpolate(from.y, to.y, part), interpolate(from.z, to.z, part)};
}

/// The exact point is in the box of `points`, so clamping the rounded point cannot increase its error.
template <std::size_t count>
Vec3d clamp_to_box(Vec3d point, const std::array<Vec3d, count>& points) {
  for (int axis = 0; axis < 3; ++axis) {
    double low = points[0][axis], high = low;
    for (const Vec3d& other : points) {
      low = std::min(low, other[axis]);
      high = std::max(high, other[axis]);
    }
    point[axis] = std::clamp(point[axis], low, high);
  }
  return point;
}

Vec3d edge_edge_point(Edge edge, Edge other) {
  if (less(other, edge)) std::swap(edge, other);
  const Vec3d point = crossing(edge, distances_from_line(edge, other));
  return clamp_to_box(clamp_to_box(point, std::array{edge.first, edge.second}),
                      std::array{other.first, other.second});
}

Vec3d edge_face_point(const Edge& edge, const TrianglePoints& triangle) {
  const Vec3d point = crossing(edge, distances_from_plane(edge, triangle));
  // Adding 0 turns -0 into 0, because the vector kernel cannot tell them apart.
  return clamp_to_box(clamp_to_box(point, std::array{edge.first, edge.second}), triangle) + Vec3d{};
}

}  // namespace

Vec3d meeting_point(const TrianglePoints& a, Feature on_a, const TrianglePoints& b, Feature on_b) {
  if (on_a.kind == FeatureKind::vertex) return a[on_a.index];
  if (on_b.kind == FeatureKind::vertex) return b[on_b.index];
  if (on_a.kind == FeatureKind::edge && on_b.kind == FeatureKind::edge) {
    return edge_edge_point(Edge(a, on_a.index), Edge(b, on_b.index));
  }
  return on_a.kind == FeatureKind::edge ? edge_face_point(Edge(a, on_a.index), b)
                                        : edge_face_point(Edge(b, on_b.index), a);
}

}  // namespace supple
