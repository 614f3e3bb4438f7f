// Two triangles: the decision and the points against separating axes with integers.

#include <algorithm>
#include <cmath>

#include "supple/triangle_intersection.hpp"
#include "support/byte_reader.hpp"
#include "support/check.hpp"

namespace {

using namespace supple;
using fuzz::check;

bool in_box(const Vec3d& point, const TrianglePoints& triangle) {
  for (int axis = 0; axis < 3; ++axis) {
    const auto [low, high] = std::minmax({triangle[0][axis], triangle[1][axis], triangle[2][axis]});
    if (!(low <= point[axis] && point[axis] <= high)) return false;
  }
  return true;
}

/// Copies corners of one triangle to the other, so that many inputs share vertices and edges.
void share_corners(fuzz::ByteReader& bytes, TrianglePoints& a, TrianglePoints& b) {
  const std::uint8_t shared = bytes.byte();
  for (std::size_t i = 0; i < 3; ++i) {
    if ((shared >> i & 1) != 0 && (shared & 0xc0) == 0) b[i] = a[(i + (shared >> 3)) % 3];
  }
}

void check_points(const TriangleIntersection& found, const TrianglePoints& a, const TrianglePoints& b) {
  const unsigned count = found.point_count;
  switch (found.kind) {
    case IntersectionKind::point:
      check(count == 1, "a point has one extreme point");
      break;
    case IntersectionKind::segment:
      check(count == 2, "a segment has two extreme points");
      break;
    case IntersectionKind::polygon:
      check(count >= 3 && count <= 6, "a polygon has three to six extreme points");
      break;
  }
  for (const ContactPoint& point : found.extreme_points())
    check(in_box(point.position, a) && in_box(point.position, b), "a point is outside of a triangle's box");
  const Vec3d n = found.normal;
  check(std::abs(n.x * n.x + n.y * n.y + n.z * n.z - 1) < 1e-12, "the normal is not a unit vector");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::ByteReader bytes(data, size);
  fuzz::CoordinateReader coordinate(bytes);
  TrianglePoints a, b;
  for (TrianglePoints* const triangle : {&a, &b}) {
    for (Vec3d& corner : *triangle) corner = coordinate.point();
  }
  share_corners(bytes, a, b);
  const bool expected = triangles_intersect_by_axes(a, b);
  check(triangles_intersect(a, b) == expected, "the decision is wrong");
  check(triangles_intersect(b, a) == expected, "the decision depends on the order of the triangles");
  check(triangles_intersect({a[1], a[2], a[0]}, {b[2], b[1], b[0]}) == expected,
        "the decision depends on the order of the corners");
  const TriangleIntersection found = intersect_triangles(a, b);
  check(found.intersects == expected, "the decision with points is wrong");
  if (expected) check_points(found, a, b);
  return 0;
}
