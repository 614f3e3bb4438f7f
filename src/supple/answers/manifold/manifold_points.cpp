#include "answers/manifold/manifold_points.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "geometry/vector.hpp"

namespace supple {
namespace {

/// A point in the plane at right angles to a normal.
struct PlanePoint {
  double x = 0, y = 0;
};

PlanePoint operator-(PlanePoint p, PlanePoint q) {
  return {p.x - q.x, p.y - q.y};
}
double length(PlanePoint p) {
  return std::sqrt(p.x * p.x + p.y * p.y);
}

/// The candidates in a plane, scaled by a power of two so that nothing overflows or vanishes.
class Plane {
 public:
  Plane(std::span<const ManifoldCandidate> candidates, const Vec3d& normal) : candidates_(candidates) {
    double largest = 0;
    for (const ManifoldCandidate& c : candidates)
      largest = std::max({largest, largest_magnitude(c.position), std::fabs(c.depth)});
    // One bit more, so that differences do not overflow.
    exponent_ = largest > 0 ? -std::ilogb(largest) - 1 : 0;
    origin_ = scaled(candidates.front().position, exponent_);
    const Vec3d n = normal == Vec3d{} ? Vec3d{0, 0, 1} : normal;
    const Vec3d size = absolute(n);
    const Vec3d axis = size.x <= size.y && size.x <= size.z ? Vec3d{1, 0, 0}
                       : size.y <= size.z                   ? Vec3d{0, 1, 0}
                                                            : Vec3d{0, 0, 1};
    const Vec3d along = cross(axis, n);
    x_ = along / norm(along);
    y_ = cross(n, x_);
  }

  PlanePoint point(std::size_t i) const {
    const Vec3d p = scaled(candidates_[i].position, exponent_) - origin_;
    return {dot(x_, p), dot(y_, p)};
  }
  double depth(std::size_t i) const { return std::ldexp(candidates_[i].depth, exponent_); }
  std::size_t size() const { return candidates_.size(); }

  /// The candidate with the largest sum of `distance(point)` and its depth, of those that are farther than
  /// `least`; the first of several.
  template <class Distance>
  std::optional<std::uint32_t> farthest(double least, const Distance& distance) const {
    std::optional<std::uint32_t> found;
    double best = -std::numeric_limits<double>::infinity();
    for (std::uint32_t i = 0; i < size(); ++i) {
      const double away = distance(point(i));
      if (!(away > least) || !(away + depth(i) > best)) continue;
      best = away + depth(i);
      found = i;
    }
    return found;
  }

 private:
  std::span<const ManifoldCandidate> candidates_;
  int exponent_ = 0;
  Vec3d origin_, x_, y_;
};

/// How far a point is to the left of the line through p and q.
double left_of(PlanePoint p, PlanePoint q, PlanePoint point) {
  const PlanePoint along = q - p, to = point - p;
  return (along.x * to.y - along.y * to.x) / length(along);
}

/// The radius of the candidates around their mean.
double radius_of(const Plane& plane, PlanePoint& mean) {
  for (std::size_t i = 0; i < plane.size(); ++i) {
    mean.x += plane.point(i).x / static_cast<double>(plane.size());
    mean.y += plane.point(i).y / static_cast<double>(plane.size());
  }
  double radius = 0;
  for (std::size_t i = 0; i < plane.size(); ++i) radius = std::max(radius, length(plane.point(i) - mean));
  return radius;
}

/// Returns the candidate farthest from the mean among the deepest ones, to an accuracy of `least`.
std::uint32_t first_point(const Plane& plane, PlanePoint mean, double least) {
  double deepest = plane.depth(0);
  for (std::size_t i = 1; i < plane.size(); ++i) deepest = std::max(deepest, plane.depth(i));
  std::uint32_t first = 0;
  double best = -1;
  for (std::uint32_t i = 0; i < plane.size(); ++i) {
    const double away = length(plane.point(i) - mean);
    if (plane.depth(i) < deepest - least || away <= best) continue;
    best = away;
    first = i;
  }
  return first;
}

}  // namespace

ManifoldChoice choose_points(std::span<const ManifoldCandidate> candidates, const Vec3d& normal) {
  constexpr double least_share = 0x1p-10;
  constexpr double rounding = 0x1p-40;  // of coordinates, which are scaled to at most 1
  const Plane plane(candidates, normal);
  PlanePoint mean;
  const double least = std::max(least_share * radius_of(plane, mean), rounding);
  ManifoldChoice choice;
  auto& chosen = choice.chosen;
  const auto add = [&](std::optional<std::uint32_t> found) {
    if (found) chosen[choice.count++] = *found;
    return found.has_value();
  };
  const auto at = [&](std::size_t i) { return plane.point(chosen[i]); };
  add(first_point(plane, mean, least));
  if (!add(plane.farthest(least, [&](PlanePoint p) { return length(p - at(0)); }))) return choice;
  if (!add(plane.farthest(least, [&](PlanePoint p) { return std::fabs(left_of(at(0), at(1), p)); })))
    return choice;
  if (left_of(at(0), at(1), at(2)) < 0) std::swap(chosen[1], chosen[2]);
  const auto side = [&](std::size_t edge, PlanePoint p) { return -left_of(at(edge), at((edge + 1) % 3), p); };
  const auto outside = [&](PlanePoint p) { return std::max({side(0, p), side(1, p), side(2, p)}); };
  const auto last = plane.farthest(least, outside);
  if (!last) return choice;
  std::size_t edge = 0;
  for (const std::size_t other : {1u, 2u}) {
    if (side(other, plane.point(*last)) > side(edge, plane.point(*last))) edge = other;
  }
  // Between the ends of the edge that it is outside of.
  std::copy_backward(chosen.begin() + static_cast<std::ptrdiff_t>(edge) + 1, chosen.begin() + 3,
                     chosen.begin() + 4);
  chosen[edge + 1] = *last;
  choice.count = 4;
  return choice;
}

}  // namespace supple
