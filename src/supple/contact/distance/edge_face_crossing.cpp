#include "contact/distance/edge_face_crossing.hpp"

#include <algorithm>
#include <cmath>

#include "contact/intersection/meeting_point.hpp"
#include "geometry/exact_predicates.hpp"
#include "geometry/numbers/integer_points.hpp"
#include "geometry/numbers/quotient.hpp"
#include "geometry/vector.hpp"

namespace supple {
namespace {

/// The magnitudes of the volumes of some fours of points as parts of their sum.
template <std::size_t count>
std::array<double, count> shares_of_volumes(const std::array<Vec3d, 5>& points,
                                            const std::array<std::array<std::size_t, 4>, count>& corners,
                                            bool& used_exact) {
  std::array<double, count> shares;
  double bound = 0, sum = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const auto [p, q, r, s] = corners[i];
    const Filtered volume = FilteredPlane(points[p], points[q], points[r]).side(points[s]);
    shares[i] = std::fabs(volume.value);
    bound = std::max(bound, volume.bound);
    sum += shares[i];
  }
  if (bound < accepted_distance_error * sum && std::isfinite(sum)) {
    for (double& share : shares) share /= sum;
    return shares;
  }
  used_exact = true;
  return with_integers(points, std::array{0, 1, 2}, [&]<class Points>(const Points& integers) {
    std::array<std::array<UnboundedInteger, 3>, 5> exact;
    for (std::size_t p = 0; p < 5; ++p) {
      for (std::size_t axis = 0; axis < 3; ++axis) exact[p][axis] = UnboundedInteger(integers[p][axis]);
    }
    std::array<UnboundedInteger, count> volumes;
    UnboundedInteger whole = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const auto [p, q, r, s] = corners[i];
      volumes[i] = abs(determinant(difference(exact[q], exact[p]), difference(exact[r], exact[p]),
                                   difference(exact[s], exact[p])));
      whole += volumes[i];
    }
    std::array<double, count> result;
    for (std::size_t i = 0; i < count; ++i) result[i] = Quotient(volumes[i], whole).value();
    return result;
  });
}

}  // namespace

bool edge_crosses_face(const EdgePoints& edge, const TrianglePoints& face, bool& used_exact) {
  const FilteredPlane plane(face);
  const Filtered first = plane.side(edge[0]), last = plane.side(edge[1]);
  if (first.certain() && last.certain() && first.sign() == last.sign()) return false;
  if (edge[0] == edge[1] || face[0] == face[1] || face[1] == face[2] || face[2] == face[0]) return false;
  for (const Vec3d& end : edge) {
    if (std::ranges::find(face, end) != face.end()) return false;
  }
  if (!std::ranges::all_of(edge, is_finite) || !std::ranges::all_of(face, is_finite)) return false;
  const auto side = [&](const Vec3d& end) { return orient3d(plane, face[1], face[2], end, used_exact); };
  if (side(edge[0]) * side(edge[1]) != -1) return false;
  const auto turn = [&](std::size_t i) {
    return orient3d(edge[0], edge[1], face[i], face[(i + 1) % 3], used_exact);
  };
  const int sign = turn(0);
  return sign != 0 && turn(1) == sign && turn(2) == sign;
}

EdgeFaceCrossing crossing_of(const EdgePoints& edge, const TrianglePoints& face, bool& used_exact) {
  using Corners = std::array<std::size_t, 4>;
  const std::array points{edge[0], edge[1], face[0], face[1], face[2]};
  EdgeFaceCrossing crossing;
  // The nearer the other end is to the plane, the more of the edge is on its side.
  crossing.on_edge =
      shares_of_volumes(points, std::array{Corners{2, 3, 4, 1}, Corners{2, 3, 4, 0}}, used_exact);
  crossing.on_face = shares_of_volumes(
      points, std::array{Corners{0, 1, 3, 4}, Corners{0, 1, 4, 2}, Corners{0, 1, 2, 3}}, used_exact);
  crossing.point = meeting_point({edge[0], edge[1], edge[1]}, {FeatureKind::edge, 0}, face, {});
  const FilteredPlane plane(face);
  const bool is_accurate = largest_magnitude(plane.normal) > 0x1p-26 * largest_magnitude(plane.magnitude);
  crossing.normal = is_accurate ? unit_normal(face) : point_triangle_distance(face[0], face)->normal;
  return crossing;
}

}  // namespace supple
