#include "answers/manifold/manifold_points.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/vector.hpp"

namespace supple {

/// Returns the size of the patch.
double PointChoice::project(std::span<const ManifoldCandidate> candidates, const Vec3d& normal) {
  double largest = 0;
  for (const ManifoldCandidate& c : candidates)
    largest = std::max({largest, largest_magnitude(c.position), std::fabs(c.depth)});
  // One bit more, so that differences do not overflow.
  const double factor = largest > 0 ? std::ldexp(1.0, std::min(-std::ilogb(largest) - 1, 1023)) : 1;
  const Vec3d n = normal == Vec3d{} ? Vec3d{0, 0, 1} : normal;
  const Vec3d size = absolute(n);
  const Vec3d axis = size.x <= size.y && size.x <= size.z ? Vec3d{1, 0, 0}
                     : size.y <= size.z                   ? Vec3d{0, 1, 0}
                                                          : Vec3d{0, 0, 1};
  const Vec3d along = cross(axis, n), x = along / norm(along), y = cross(n, x);
  const Vec3d origin = factor * candidates.front().position;
  points_.clear();
  double low_x = 0, high_x = 0, low_y = 0, high_y = 0;
  for (const ManifoldCandidate& candidate : candidates) {
    const Vec3d p = factor * candidate.position - origin;
    const Point& point = points_.emplace_back(Point{dot(x, p), dot(y, p), factor * candidate.depth});
    low_x = std::min(low_x, point.x);
    high_x = std::max(high_x, point.x);
    low_y = std::min(low_y, point.y);
    high_y = std::max(high_y, point.y);
  }
  return std::max(high_x - low_x, high_y - low_y);
}

ManifoldChoice PointChoice::choose(std::span<const ManifoldCandidate> candidates, const Vec3d& normal) {
  constexpr double rounding = 0x1p-40;  // of coordinates, which are scaled to at most 1
  const double least = std::max(0x1p-10 * project(candidates, normal), rounding);
  ManifoldChoice choice;
  auto& chosen = choice.chosen;
  const auto at = [&](std::size_t i) -> const Point& { return points_[chosen[i]]; };
  // The point with the largest value of those that are at least `least` away; the first of several.
  const auto add_best = [&](double nearest, const auto& away_of, const auto& value_of) {
    double best = -std::numeric_limits<double>::infinity();
    const double none = best;
    for (std::uint32_t i = 0; i < points_.size(); ++i) {
      const double away = away_of(points_[i]);
      if (!(away > nearest) || !(value_of(away, points_[i]) > best)) continue;
      best = value_of(away, points_[i]);
      chosen[choice.count] = i;
    }
    choice.count += best == none ? 0 : 1;
    return best != none;
  };
  const auto add_farthest = [&](const auto& distance) {
    return add_best(least, distance, [](double away, const Point& p) { return away + p.depth; });
  };
  const auto distance_from = [](const Point& from) {
    return [from](const Point& p) {
      return std::sqrt((p.x - from.x) * (p.x - from.x) + (p.y - from.y) * (p.y - from.y));
    };
  };
  const auto left_of = [&](const Point& from, const Point& to) {
    const double length = distance_from(from)(to), x = (to.x - from.x) / length, y = (to.y - from.y) / length;
    return [from, x, y](const Point& p) { return x * (p.y - from.y) - y * (p.x - from.x); };
  };
  Point middle{0, 0, points_[0].depth};  // with the largest depth
  for (const Point& p : points_) {
    middle.x += p.x / static_cast<double>(points_.size());
    middle.y += p.y / static_cast<double>(points_.size());
    middle.depth = std::max(middle.depth, p.depth);
  }
  add_best(
      -rounding, [&](const Point& p) { return p.depth - middle.depth; },
      [&](double, const Point& p) { return distance_from(middle)(p); });
  if (!add_farthest(distance_from(at(0)))) return choice;
  const auto line = left_of(at(0), at(1));
  if (!add_farthest([&](const Point& p) { return std::fabs(line(p)); })) return choice;
  if (line(at(2)) < 0) std::swap(chosen[1], chosen[2]);
  const std::array sides{left_of(at(0), at(1)), left_of(at(1), at(2)), left_of(at(2), at(0))};
  if (!add_farthest([&](const Point& p) { return -std::min({sides[0](p), sides[1](p), sides[2](p)}); }))
    return choice;
  // Between the ends of the edge that it is outside of.
  const std::uint32_t last = chosen[3];
  const auto is_less = [&](const auto& p, const auto& q) { return p(points_[last]) < q(points_[last]); };
  const auto edge = std::min_element(sides.begin(), sides.end(), is_less) - sides.begin();
  std::copy_backward(chosen.begin() + edge + 1, chosen.begin() + 3, chosen.begin() + 4);
  chosen[static_cast<std::size_t>(edge) + 1] = last;
  return choice;
}

}  // namespace supple
