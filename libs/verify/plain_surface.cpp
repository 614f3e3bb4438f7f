#include "verify/plain_surface.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <optional>
#include <tuple>
#include <utility>

#include "geometry/numbers/number_vector.hpp"
#include "geometry/vector.hpp"

namespace supple {
namespace {

using sturm::Integer;
using IntegerVector = NumberVector<Integer>;

constexpr double no_bound = std::numeric_limits<double>::infinity();

/// A point and the corners of a triangle, in units of 2^lowest.
std::array<IntegerVector, 4> integers_of(const Vec3d& point, const TrianglePoints& corners, int& lowest) {
  const std::array<Vec3d, 4> points{point, corners[0], corners[1], corners[2]};
  lowest = std::numeric_limits<int>::max();
  for (const Vec3d& p : points)
    lowest = std::min({lowest, sturm::lowest_bit(p.x), sturm::lowest_bit(p.y), sturm::lowest_bit(p.z)});
  std::array<IntegerVector, 4> integers;
  for (std::size_t i = 0; i < 4; ++i) {
    for (int axis = 0; axis < 3; ++axis)
      integers[i][static_cast<std::size_t>(axis)] = sturm::to_integer(points[i][axis], lowest);
  }
  if (lowest == std::numeric_limits<int>::max()) lowest = 0;
  return integers;
}

/// The sign of a number with an error; nothing when it is not known.
std::optional<int> sign_of(double value, double error) {
  if (value > error) return 1;
  return value < -error ? std::optional(-1) : std::nullopt;
}

/// Sign of (b - a) x (p - a) in the y-z plane.
int turn_of(const Vec3d& a, const Vec3d& b, const Vec3d& p) {
  const double first = (b.y - a.y) * (p.z - a.z), second = (b.z - a.z) * (p.y - a.y);
  const auto sign = sign_of(first - second, 0x1p-49 * (std::fabs(first) + std::fabs(second)) + 0x1p-1000);
  if (sign) return *sign;
  int lowest = 0;
  const auto [x, from, to, same] = integers_of(p, {a, b, b}, lowest);
  const IntegerVector u = minus(to, from), w = minus(x, from);
  return Integer(u[1] * w[2] - u[2] * w[1]).sign();
}

/// The same, where p is moved by (e, e²) for an infinitely small e > 0.
int turn_beside(const Vec3d& a, const Vec3d& b, const Vec3d& p) {
  if (const int turn = turn_of(a, b, p)) return turn;
  if (a.z != b.z) return a.z > b.z ? 1 : -1;
  return (b.y > a.y) - (b.y < a.y);
}

/// Whether the ray in the direction of x from beside the point crosses the triangle, which does not contain
/// the point. `side` is that of the point.
bool crosses_ahead(const TrianglePoints& t, const Vec3d& p, int side) {
  const int turn = turn_beside(t[0], t[1], p);
  if (turn == 0 || turn_beside(t[1], t[2], p) != turn || turn_beside(t[2], t[0], p) != turn) return false;
  return side * turn < 0;
}

/// Numbers between which a distance is.
struct Bounds {
  double lower = 0, upper = no_bound;
};

/// About the point of the segment from `a` along `u` that is closest to the origin.
Vec3d closest_on_edge(const Vec3d& a, const Vec3d& u) {
  const double whole = dot(u, u);
  return whole > 0 ? a + std::clamp(-dot(a, u) / whole, 0.0, 1.0) * u : a;
}

/// The distance is at most that of a point of the triangle, and at least that of a plane beyond which the
/// triangle lies. Where rounding leaves nothing certain, the bounds are 0 and infinite.
Bounds bounds_of_distance(const Vec3d& point, const TrianglePoints& corners) {
  TrianglePoints c;
  double largest = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    c[i] = corners[i] - point;
    largest = std::max(largest, largest_magnitude(c[i]));
  }
  if (largest == 0) return {0, 0};
  if (!std::isfinite(largest)) return {};
  const double factor = std::ldexp(1.0, -std::clamp(std::ilogb(largest), -1000, 1000));
  for (Vec3d& p : c) p = factor * p;
  const Vec3d u = c[1] - c[0], v = c[2] - c[0], n = cross(u, v);
  const double whole = dot(n, n), s = -dot(cross(c[0], v), n), t = -dot(cross(u, c[0]), n);
  Vec3d nearest = c[0];
  if (whole > 0 && s >= 0 && t >= 0 && s + t <= whole) {
    nearest = c[0] + (s / whole) * u + (t / whole) * v;
  } else {
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3d p = closest_on_edge(c[i], c[(i + 1) % 3] - c[i]);
      if (i == 0 || dot(p, p) < dot(nearest, nearest)) nearest = p;
    }
  }
  // Lengths are at most 4 here, and a sum of products has an error below 2^-50 of the product of two lengths.
  constexpr double slack = 0x1p-44;
  const double length = norm(nearest);
  const double ahead = std::min({dot(c[0], nearest), dot(c[1], nearest), dot(c[2], nearest)});
  return {length > 0 ? std::max(0.0, ahead / length - slack) / factor : 0, (length + slack) / factor};
}

double box_distance(const Vec3d& p, const QueryBox& box) {
  Vec3d gap;
  for (int axis = 0; axis < 3; ++axis)
    gap[axis] = std::max({box.min[axis] - p[axis], p[axis] - box.max[axis], 0.0});
  const double squared = dot(gap, gap);
  return squared > 0x1p-900 && squared < 0x1p900 ? std::sqrt(squared) : scaled_norm(gap);
}

}  // namespace

int side_of_plane(const TrianglePoints& t, const Vec3d& p) {
  const Vec3d u = t[1] - t[0], v = t[2] - t[0], w = p - t[0], m = absolute(u), n = absolute(v);
  const Vec3d size{m.y * n.z + m.z * n.y, m.z * n.x + m.x * n.z, m.x * n.y + m.y * n.x};
  const auto sign = sign_of(dot(cross(u, v), w), 0x1p-48 * dot(size, absolute(w)) + 0x1p-1000);
  if (sign) return *sign;
  int lowest = 0;
  const auto [x, a, b, c] = integers_of(p, t, lowest);
  return dot(cross(minus(b, a), minus(c, a)), minus(x, a)).sign();
}

Rational squared_distance_by_integers(const Vec3d& point, const TrianglePoints& corners) {
  int lowest = 0;
  const auto points = integers_of(point, corners, lowest);
  const auto& [p, a, b, c] = points;
  const auto exact = [&](Integer over, Integer under) {
    (lowest > 0 ? over : under) <<= 2 * std::abs(lowest);
    return Rational(over, under);
  };
  const IntegerVector u = minus(b, a), v = minus(c, a), w = minus(p, a), n = cross(u, v);
  if (const Integer whole = dot(n, n); whole != 0) {
    const Integer s = dot(cross(w, v), n), t = dot(cross(u, w), n);
    const Integer volume = dot(n, w);
    if (s >= 0 && t >= 0 && s + t <= whole) return exact(volume * volume, whole);
  }
  Integer least = 0, least_under = 0;
  const auto keep = [&](const Integer& over, const Integer& under) {
    if (least_under == 0 || over * least_under < least * under)
      std::tie(least, least_under) = std::tie(over, under);
  };
  for (std::size_t i = 1; i <= 3; ++i) {
    const IntegerVector edge = minus(points[i % 3 + 1], points[i]), to_point = minus(p, points[i]);
    const Integer whole = dot(edge, edge), along = dot(to_point, edge), squared = dot(to_point, to_point);
    keep(squared, 1);
    if (along > 0 && along < whole) keep(squared * whole - along * along, whole);
  }
  return exact(least, least_under);
}

PlainSurface::PlainSurface(const PlainObject& object) {
  std::vector<QueryBox> boxes;
  for (std::uint32_t t = 0; t < object.face_count; ++t) {
    if (object.triangles[t][0] == object.removed_vertex) continue;
    const TrianglePoints corners = object.corners(t);
    if (!std::ranges::all_of(corners, is_finite)) {
      has_inert = true;
      continue;
    }
    boxes.push_back(exact_box(corners));
    triangles.push_back({corners, boxes.back(), t});
  }
  tree = PlainTree(std::move(boxes));
}

Containment PlainSurface::containment(const Vec3d& p) const {
  bool is_inside = false, is_on = false;
  const auto is_ahead = [&](const QueryBox& box) {
    return p.y >= box.min.y && p.y <= box.max.y && p.z >= box.min.z && p.z <= box.max.z && p.x <= box.max.x;
  };
  tree.visit(p, is_ahead, [&](std::uint32_t i) {
    const BoxedCorners& t = triangles[i];
    const int side = side_of_plane(t.corners, p);
    if (side == 0 && p.x >= t.box.min.x && triangles_intersect_by_axes({p, p, p}, t.corners)) is_on = true;
    if (crosses_ahead(t.corners, p, side)) is_inside = !is_inside;
  });
  if (is_on) return Containment::on;
  return is_inside && !has_inert ? Containment::inside : Containment::outside;
}

PlainSurface::Nearest PlainSurface::nearest(const Vec3d& point, std::size_t guess) const {
  std::vector<std::pair<double, std::uint32_t>> candidates;
  double least = bounds_of_distance(point, triangles[guess].corners).upper;
  const auto is_in_reach = [&](const QueryBox& box) { return box_distance(point, box) <= increased(least); };
  tree.visit(point, is_in_reach, [&](std::uint32_t i) {
    const auto [lower, upper] = bounds_of_distance(point, triangles[i].corners);
    least = std::min(least, upper);
    candidates.emplace_back(lower, i);
  });
  std::optional<Nearest> best;
  for (const auto& [lower, i] : candidates) {
    if (lower > least) continue;
    Nearest found{triangles[i].triangle, squared_distance_by_integers(point, triangles[i].corners), i};
    const int side = best ? found.squared.compare(best->squared) : -1;
    if (side < 0 || (side == 0 && found.triangle < best->triangle)) best = std::move(found);
  }
  return *best;
}

double PlainSurface::bound_of_distance(const Vec3d& point, double bound) const {
  const auto is_in_reach = [&](const QueryBox& box) { return box_distance(point, box) < bound; };
  tree.visit(point, is_in_reach, [&](std::uint32_t i) {
    bound = std::min(bound, bounds_of_distance(point, triangles[i].corners).upper);
  });
  return bound;
}

}  // namespace supple
