#include "contact/separating_normal.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace supple {
namespace {

/// Squared sine of an angle below which two edges count as parallel.
constexpr double parallel_squared_sine = 0x1p-40;
/// Squared distance from a plane, relative to the size, below which triangles count as coplanar.
constexpr double flat_squared_distance = 0x1p-64;
/// Within this range the tenth power of a size, the largest product below, is a normal number.
constexpr double least_size = 0x1p-80, most_size = 0x1p80;

double largest_component(const Vec3d& v) {
  return std::max({std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)});
}

/// A triangle relative to corner 0 of triangle a.
struct RelativeTriangle {
  TrianglePoints corners, edges;  // edge i goes from corner i to the next one
  std::array<double, 3> squared_lengths;
  Vec3d normal;
  double squared_normal;  // 0 for a triangle that counts as a segment or a point

  RelativeTriangle(const TrianglePoints& triangle, const Vec3d& origin) {
    for (std::size_t i = 0; i < 3; ++i) corners[i] = triangle[i] - origin;
    for (std::size_t i = 0; i < 3; ++i) {
      edges[i] = triangle[(i + 1) % 3] - triangle[i];
      squared_lengths[i] = squared_norm(edges[i]);
    }
    normal = cross(edges[0], edges[1]);
    squared_normal = squared_norm(normal);
    const auto [s, t, u] = squared_lengths;
    const double longest_two = std::max({s * t, t * u, u * s});
    if (!(squared_normal > parallel_squared_sine * longest_two)) squared_normal = 0;
  }

  double size() const {
    double size = 0;
    for (const Vec3d& corner : corners) size = std::max(size, largest_component(corner));
    return size;
  }
};

/// The best of the directions considered so far. All lengths along a direction are multiples of its length.
class LeastPenetration {
 public:
  explicit LeastPenetration(double size) : flat_(flat_squared_distance * size * size) {}

  /// Triangle a has to move by `forward` along the direction, or by `backward` against it, to be separated.
  void consider(const Vec3d& direction, double squared_length, double forward, double backward) {
    const bool is_forward = forward <= backward;
    const double most = is_forward ? backward : forward;
    const double depth = std::max(is_forward ? forward : backward, 0.0);
    if (is_flat_ || !(depth * depth * squared_length_ < squared_depth_ * squared_length)) return;
    is_flat_ = most * most <= flat_ * squared_length;
    squared_depth_ = depth * depth;
    squared_length_ = squared_length;
    direction_ = is_forward || is_flat_ ? direction : -direction;
  }

  /// The triangles lie in one plane: the first direction perpendicular to it stays.
  bool is_flat() const { return is_flat_; }
  bool has_direction() const { return direction_ != Vec3d{}; }
  Vec3d direction() const { return direction_ / std::sqrt(squared_length_); }

 private:
  double flat_;
  bool is_flat_ = false;
  double squared_depth_ = 1, squared_length_ = 0;  // infinitely deep
  Vec3d direction_;
};

/// A unit vector perpendicular to the longest edge, or the x axis when there is none.
Vec3d perpendicular(const RelativeTriangle& a, const RelativeTriangle& b) {
  Vec3d longest;
  for (const RelativeTriangle* const triangle : {&a, &b}) {
    for (const Vec3d& edge : triangle->edges) {
      if (squared_norm(edge) > squared_norm(longest)) longest = edge;
    }
  }
  if (longest == Vec3d{}) return {1, 0, 0};
  int axis = 0;
  for (int i = 1; i < 3; ++i) {
    if (std::fabs(longest[i]) < std::fabs(longest[axis])) axis = i;
  }
  Vec3d unit;
  unit[axis] = 1;
  const Vec3d direction = cross(longest, unit);
  return direction / norm(direction);
}

/// Directions from the normal of a triangle: that triangle is flat, the other one reaches from the least to
/// the largest of three heights above it.
struct Heights {
  double least, most;

  Heights(const RelativeTriangle& flat, const RelativeTriangle& other) {
    const double p = dot(flat.normal, other.corners[0] - flat.corners[0]);
    const double q = dot(flat.normal, other.corners[1] - flat.corners[0]);
    const double r = dot(flat.normal, other.corners[2] - flat.corners[0]);
    least = std::min({p, q, r});
    most = std::max({p, q, r});
  }
};

Vec3d normal_in_range(const RelativeTriangle& a, const RelativeTriangle& b, double size) {
  LeastPenetration best(size);
  if (b.squared_normal > 0) {
    const Heights of_a(b, a);
    best.consider(b.normal, b.squared_normal, -of_a.least, of_a.most);
  }
  if (a.squared_normal > 0 && !best.is_flat()) {
    const Heights of_b(a, b);
    best.consider(a.normal, a.squared_normal, of_b.most, -of_b.least);
  }
  // Along edge_a × edge_b each edge is flat. The third corner of a lies -edge_b · normal_a from edge_a, for
  // all three edges of a, and the third corner of b lies edge_a · normal_b from edge_b.
  for (std::size_t j = 0; j < 3 && !best.is_flat(); ++j) {
    const double third_a = -dot(b.edges[j], a.normal);
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3d direction = cross(a.edges[i], b.edges[j]);
      const double squared_length = squared_norm(direction);
      if (!(squared_length > parallel_squared_sine * (a.squared_lengths[i] * b.squared_lengths[j]))) continue;
      const double third_b = dot(a.edges[i], b.normal);
      const double offset = dot(direction, b.corners[j] - a.corners[i]);
      best.consider(direction, squared_length, offset + std::max(third_b, 0.0) - std::min(third_a, 0.0),
                    std::max(third_a, 0.0) - offset - std::min(third_b, 0.0));
    }
  }
  return best.has_direction() ? best.direction() : perpendicular(a, b);
}

/// The power of two nearest to the largest extent along an axis, as an exponent.
int exponent_of_extent(const TrianglePoints& a, const TrianglePoints& b) {
  double half_extent = 0;
  for (const TrianglePoints* const triangle : {&a, &b}) {
    for (const Vec3d& p : *triangle)
      half_extent = std::max(half_extent, largest_component(p * 0.5 - a[0] * 0.5));
  }
  // Half of the least number is 0.
  return half_extent > 0 ? std::ilogb(half_extent) + 1 : -1074;
}

TrianglePoints scaled(const TrianglePoints& triangle, int exponent) {
  TrianglePoints result;
  for (std::size_t i = 0; i < 3; ++i) {
    for (int axis = 0; axis < 3; ++axis) result[i][axis] = std::ldexp(triangle[i][axis], exponent);
  }
  return result;
}

}  // namespace

Vec3d separating_normal(const TrianglePoints& a, const TrianglePoints& b) {
  const RelativeTriangle relative_a(a, a[0]), relative_b(b, a[0]);
  const double size = std::max(relative_a.size(), relative_b.size());
  if ((size >= least_size && size <= most_size) || size == 0)
    return normal_in_range(relative_a, relative_b, size);
  const int exponent = -exponent_of_extent(a, b);
  const TrianglePoints near_a = scaled(a, exponent), near_b = scaled(b, exponent);
  const RelativeTriangle scaled_a(near_a, near_a[0]), scaled_b(near_b, near_a[0]);
  return normal_in_range(scaled_a, scaled_b, std::max(scaled_a.size(), scaled_b.size()));
}

}  // namespace supple
