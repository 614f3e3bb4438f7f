#include "files/polygon/outline.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "geometry/numbers/integer_points.hpp"
#include "geometry/vector.hpp"

namespace supple {
namespace {

/// Twice the area of the outline along each axis, computed with rounding from corners that are scaled to
/// coordinates of at most 1.
struct RoundedAreas {
  Vec3d area;
  Vec3d bound;  ///< of the error
  double scale = 1;

  explicit RoundedAreas(std::span<const Vec3d> corners) {
    double largest = 0;
    for (const Vec3d& p : corners)
      largest = std::max({largest, std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)});
    if (largest > 0x1p-900) scale = std::ldexp(1.0, -std::ilogb(largest) - 1);
    const Vec3d origin = corners[0] * scale;
    Vec3d magnitude{}, previous = corners[1] * scale - origin;
    for (std::size_t k = 2; k < corners.size(); ++k) {
      const Vec3d next = corners[k] * scale - origin;
      for (int axis = 0; axis < 3; ++axis) {
        const int x = (axis + 1) % 3, y = (axis + 2) % 3;
        const double left = previous[x] * next[y], right = previous[y] * next[x];
        area[axis] += left - right;
        magnitude[axis] += std::fabs(left) + std::fabs(right);
      }
      previous = next;
    }
    // A term goes through 4 roundings and at most n sums; the scaled coordinates and the products lose less
    // than 2^-1070 when they underflow.
    const auto count = static_cast<double>(corners.size());
    for (int axis = 0; axis < 3; ++axis) bound[axis] = (count + 8) * (0x1p-52 * magnitude[axis] + 0x1p-1070);
  }
};

int largest_axis(const auto& values) {
  return values[0] >= values[1] && values[0] >= values[2] ? 0 : values[1] >= values[2] ? 1 : 2;
}

/// The axis of the largest area, and the sign of this area; none when all three are zero.
Projection exact_areas(std::span<const Vec3d> corners) {
  BitExtent extent;
  for (const Vec3d& p : corners) {
    for (int axis = 0; axis < 3; ++axis) extent.include(p[axis]);
  }
  if (extent.bits() == 0) return {};
  const auto point = [&](std::size_t k) {
    Vector3<UnboundedInteger> result;
    for (int axis = 0; axis < 3; ++axis)
      result[static_cast<std::size_t>(axis)] = to_integer<UnboundedInteger>(corners[k][axis], extent.bottom);
    return result;
  };
  std::array<UnboundedInteger, 3> areas;
  Vector3<UnboundedInteger> previous = point(corners.size() - 1);
  for (std::size_t k = 0; k < corners.size(); ++k) {
    Vector3<UnboundedInteger> next = point(k);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::size_t x = (axis + 1) % 3, y = (axis + 2) % 3;
      areas[axis] += previous[x] * next[y] - previous[y] * next[x];
    }
    previous = std::move(next);
  }
  const int axis = largest_axis(std::array{UnboundedInteger(abs(areas[0])), UnboundedInteger(abs(areas[1])),
                                           UnboundedInteger(abs(areas[2]))});
  const int turn = sign(areas[static_cast<std::size_t>(axis)]);
  return turn == 0 ? Projection{} : Projection{axis, turn};
}

/// A view in which some three corners do not lie on one line.
Projection any_view(std::span<const Vec3d> corners) {
  const auto other =
      std::find_if(corners.begin(), corners.end(), [&](const Vec3d& p) { return p != corners[0]; });
  if (other == corners.end()) return {};
  bool used_exact = false;
  for (const Vec3d& p : corners) {
    if (const Projection projection = find_projection(corners[0], *other, p, used_exact)) return projection;
  }
  return {};
}

Projection find_view(std::span<const Vec3d> corners) {
  const RoundedAreas rounded(corners);
  const Vec3d size = absolute(rounded.area);
  const int axis = largest_axis(std::array{size.x, size.y, size.z});
  if (size[axis] > rounded.bound[axis]) return {axis, rounded.area[axis] > 0 ? 1 : -1};
  if (const Projection exact = exact_areas(corners)) return exact;
  return any_view(corners);
}

}  // namespace

OutlineView::OutlineView(std::span<const Vec3d> corners)
    : corners_(corners), projection_(find_view(corners)) {}

bool is_bent(std::span<const Vec3d> corners) {
  const RoundedAreas areas(corners);
  Vec3d least = corners[0] * areas.scale, most = least;
  double lowest = 0, highest = 0;
  const Vec3d origin = least;
  for (const Vec3d& corner : corners) {
    const Vec3d p = corner * areas.scale;
    for (int axis = 0; axis < 3; ++axis) {
      least[axis] = std::min(least[axis], p[axis]);
      most[axis] = std::max(most[axis], p[axis]);
    }
    const double height = dot(areas.area, p - origin);
    lowest = std::min(lowest, height);
    highest = std::max(highest, height);
  }
  const Vec3d extent = most - least;
  return (highest - lowest) / 2 > norm(areas.area) * std::max({extent.x, extent.y, extent.z}) / 1000;
}

}  // namespace supple
