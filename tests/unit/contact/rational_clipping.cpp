#include "unit/contact/rational_clipping.hpp"

#include <algorithm>
#include <cmath>

namespace supple::truth {
namespace {

namespace mp = boost::multiprecision;

Rational exact_number(double value) {
  int exponent = 0;
  const auto mantissa = static_cast<std::int64_t>(std::ldexp(std::frexp(value, &exponent), 53));
  exponent -= 53;
  const mp::cpp_int power = mp::cpp_int(1) << std::abs(exponent);
  return exponent < 0 ? Rational(mp::cpp_int(mantissa), power) : Rational(mp::cpp_int(mantissa) * power);
}

bool is_zero(const RationalPoint& v) {
  return v[0] == 0 && v[1] == 0 && v[2] == 0;
}

RationalPoint between(const RationalPoint& from, const RationalPoint& to, const Rational& part) {
  RationalPoint point;
  for (std::size_t i = 0; i < 3; ++i) point[i] = from[i] + part * (to[i] - from[i]);
  return point;
}

/// normal · x <= offset
struct HalfSpace {
  RationalPoint normal;
  Rational offset;

  HalfSpace(const RationalPoint& outward, const RationalPoint& through)
      : normal(outward), offset(dot(outward, through)) {}
  HalfSpace opposite() const {
    HalfSpace result = *this;
    for (Rational& component : result.normal) component = -component;
    result.offset = -result.offset;
    return result;
  }
};

std::vector<RationalPoint> extreme_corners(const TrianglePoints& triangle) {
  std::vector<RationalPoint> corners{rational(triangle[0]), rational(triangle[1]), rational(triangle[2])};
  if (!is_zero(cross(subtract(corners[1], corners[0]), subtract(corners[2], corners[0])))) return corners;
  std::sort(corners.begin(), corners.end());
  if (corners.front() == corners.back()) return {corners.front()};
  return {corners.front(), corners.back()};
}

void add_both_sides(std::vector<HalfSpace>& half_spaces, const RationalPoint& normal,
                    const RationalPoint& through) {
  half_spaces.emplace_back(normal, through);
  half_spaces.push_back(half_spaces.back().opposite());
}

std::vector<HalfSpace> half_spaces_of(const TrianglePoints& triangle) {
  const std::vector<RationalPoint> corners = extreme_corners(triangle);
  std::vector<HalfSpace> half_spaces;
  if (corners.size() == 1) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      RationalPoint normal{};
      normal[axis] = 1;
      add_both_sides(half_spaces, normal, corners[0]);
    }
  } else if (corners.size() == 2) {
    const RationalPoint direction = subtract(corners[1], corners[0]);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      RationalPoint unit{};
      unit[axis] = 1;
      const RationalPoint normal = cross(direction, unit);
      if (!is_zero(normal)) add_both_sides(half_spaces, normal, corners[0]);
    }
    half_spaces.emplace_back(direction, corners[1]);
    half_spaces.push_back(HalfSpace(direction, corners[0]).opposite());
  } else {
    const RationalPoint normal = cross(subtract(corners[1], corners[0]), subtract(corners[2], corners[0]));
    add_both_sides(half_spaces, normal, corners[0]);
    for (std::size_t i = 0; i < 3; ++i) {
      half_spaces.emplace_back(cross(subtract(corners[(i + 1) % 3], corners[i]), normal), corners[i]);
    }
  }
  return half_spaces;
}

std::vector<RationalPoint> clip(const std::vector<RationalPoint>& polygon, const HalfSpace& half_space) {
  std::vector<RationalPoint> result;
  const auto add = [&](const RationalPoint& point) {
    if (std::find(result.begin(), result.end(), point) == result.end()) result.push_back(point);
  };
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const RationalPoint &here = polygon[i], &next = polygon[(i + 1) % polygon.size()];
    const Rational beyond_here = dot(half_space.normal, here) - half_space.offset;
    const Rational beyond_next = dot(half_space.normal, next) - half_space.offset;
    if (beyond_here <= 0) add(here);
    if ((beyond_here < 0 && beyond_next > 0) || (beyond_here > 0 && beyond_next < 0)) {
      add(between(here, next, beyond_here / (beyond_here - beyond_next)));
    }
  }
  return result;
}

RationalPoint corner(const TrianglePoints& triangle, int i) {
  return rational(triangle[static_cast<std::size_t>(i % 3)]);
}

}  // namespace

RationalPoint rational(const Vec3d& point) {
  return {exact_number(point.x), exact_number(point.y), exact_number(point.z)};
}
RationalPoint subtract(const RationalPoint& a, const RationalPoint& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
RationalPoint cross(const RationalPoint& a, const RationalPoint& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Rational dot(const RationalPoint& a, const RationalPoint& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

std::vector<RationalPoint> clipped_extreme_points(const TrianglePoints& a, const TrianglePoints& b) {
  std::vector<RationalPoint> polygon = extreme_corners(a);
  for (const HalfSpace& half_space : half_spaces_of(b)) polygon = clip(polygon, half_space);
  return polygon;
}

bool in_relative_interior(const RationalPoint& point, const TrianglePoints& triangle, Feature feature) {
  if (feature.kind == FeatureKind::vertex) return point == corner(triangle, feature.index);
  if (feature.kind == FeatureKind::edge) {
    const RationalPoint from = corner(triangle, feature.index), to = corner(triangle, feature.index + 1);
    const RationalPoint direction = subtract(to, from), offset = subtract(point, from);
    const Rational part = dot(offset, direction);
    return is_zero(cross(direction, offset)) && part > 0 && part < dot(direction, direction);
  }
  const RationalPoint normal = cross(subtract(corner(triangle, 1), corner(triangle, 0)),
                                     subtract(corner(triangle, 2), corner(triangle, 0)));
  if (dot(normal, subtract(point, corner(triangle, 0))) != 0) return false;
  for (int i = 0; i < 3; ++i) {
    const RationalPoint edge = subtract(corner(triangle, i + 1), corner(triangle, i));
    if (dot(cross(edge, subtract(point, corner(triangle, i))), normal) <= 0) return false;
  }
  return true;
}

RationalPoint exact_meeting_point(const TrianglePoints& a, Feature on_a, const TrianglePoints& b,
                                  Feature on_b) {
  if (on_a.kind == FeatureKind::vertex) return corner(a, on_a.index);
  if (on_b.kind == FeatureKind::vertex) return corner(b, on_b.index);
  if (on_a.kind == FeatureKind::face) return exact_meeting_point(b, on_b, a, on_a);
  const RationalPoint from = corner(a, on_a.index), to = corner(a, on_a.index + 1);
  RationalPoint normal, origin;
  if (on_b.kind == FeatureKind::face) {
    origin = corner(b, 0);
    normal = cross(subtract(corner(b, 1), origin), subtract(corner(b, 2), origin));
  } else {
    // The plane through the other edge that is perpendicular to the plane of both edges.
    origin = corner(b, on_b.index);
    const RationalPoint direction = subtract(corner(b, on_b.index + 1), origin);
    normal = cross(direction, cross(direction, subtract(to, from)));
  }
  const Rational first = dot(normal, subtract(from, origin)), second = dot(normal, subtract(to, origin));
  return between(from, to, first / (first - second));
}

}  // namespace supple::truth
