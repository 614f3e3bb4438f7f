#include "scene/brute_force_penetrations.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "geometry/vector.hpp"
#include "mesh/vertex_sets.hpp"
#include "scene/brute_force_proximity.hpp"
#include "supple/triangle_intersection.hpp"

namespace supple {
namespace {

/// Sign of (b - a) x (p - a) in the y-z plane, where p is moved by (e, e²) for an infinitely small e > 0.
int turn_beside(const Vec3d& a, const Vec3d& b, const Vec3d& p) {
  const Rational turn = (Rational(b.y) - Rational(a.y)) * (Rational(p.z) - Rational(a.z)) -
                        (Rational(b.z) - Rational(a.z)) * (Rational(p.y) - Rational(a.y));
  if (turn != 0) return turn.sign();
  if (a.z != b.z) return a.z > b.z ? 1 : -1;
  return (b.y > a.y) - (b.y < a.y);
}

int side_of_plane(const TrianglePoints& t, const Vec3d& p) {
  std::array<std::array<Rational, 3>, 3> rows;
  const std::array<Vec3d, 3> ends{t[1], t[2], p};
  for (std::size_t r = 0; r < 3; ++r) {
    for (int axis = 0; axis < 3; ++axis)
      rows[r][static_cast<std::size_t>(axis)] = Rational(ends[r][axis]) - Rational(t[0][axis]);
  }
  const auto& [u, v, w] = rows;
  const Rational determinant = (u[1] * v[2] - u[2] * v[1]) * w[0] + (u[2] * v[0] - u[0] * v[2]) * w[1] +
                               (u[0] * v[1] - u[1] * v[0]) * w[2];
  return determinant.sign();
}

/// Whether the ray in the direction of x from beside the point crosses the triangle, which does not contain
/// the point.
bool crosses_ahead(const TrianglePoints& t, const Vec3d& p) {
  const int turn = turn_beside(t[0], t[1], p);
  if (turn == 0 || turn_beside(t[1], t[2], p) != turn || turn_beside(t[2], t[0], p) != turn) return false;
  return side_of_plane(t, p) * turn < 0;
}

struct BoxedCorners {
  TrianglePoints corners;
  Vec3d min, max;
};

std::vector<BoxedCorners> boxed_corners(const PlainObject& object) {
  std::vector<BoxedCorners> result;
  for (const Triangle& triangle : object.triangles) {
    BoxedCorners boxed;
    for (std::size_t k = 0; k < 3; ++k) boxed.corners[k] = object.positions[triangle[k]];
    boxed.min = boxed.max = boxed.corners[0];
    for (const Vec3d& corner : boxed.corners) {
      for (int axis = 0; axis < 3; ++axis) {
        boxed.min[axis] = std::min(boxed.min[axis], corner[axis]);
        boxed.max[axis] = std::max(boxed.max[axis], corner[axis]);
      }
    }
    result.push_back(boxed);
  }
  return result;
}

Containment where_is(const Vec3d& p, std::span<const BoxedCorners> triangles) {
  bool is_inside = false;
  for (const BoxedCorners& t : triangles) {
    if (p.y < t.min.y || p.y > t.max.y || p.z < t.min.z || p.z > t.max.z || p.x > t.max.x) continue;
    if (p.x >= t.min.x && triangles_intersect_by_axes({p, p, p}, t.corners)) return Containment::on;
    if (crosses_ahead(t.corners, p)) is_inside = !is_inside;
  }
  return is_inside ? Containment::inside : Containment::outside;
}

double box_distance(const Vec3d& p, const BoxedCorners& t) {
  Vec3d gap;
  for (int axis = 0; axis < 3; ++axis)
    gap[axis] = std::max({t.min[axis] - p[axis], p[axis] - t.max[axis], 0.0});
  return std::sqrt(dot(gap, gap));
}

void find_nearest(const Vec3d& p, std::span<const BoxedCorners> triangles, ExactPenetration& found) {
  double bound = std::numeric_limits<double>::infinity();
  for (const BoxedCorners& t : triangles) {
    for (const Vec3d& corner : t.corners)
      bound = std::min(bound, std::sqrt(dot(corner - p, corner - p)) * (1 + 0x1p-40) + 0x1p-500);
  }
  std::optional<Rational> least;
  for (std::uint32_t i = 0; i < triangles.size(); ++i) {
    const BoxedCorners& t = triangles[i];
    if (box_distance(p, t) > bound || clearly_apart(std::span(&p, 1), t.corners, bound)) continue;
    const Rational squared = distance_by_algebra(std::span(&p, 1), t.corners).squared;
    if (least && squared >= *least) continue;
    least = squared;
    found.triangle = i;
    bound = std::min(bound, std::sqrt(squared.convert_to<double>()) * (1 + 0x1p-40) + 0x1p-500);
  }
  found.squared_depth = *least;
}

/// The connected parts with all vertices inside and no triangle that touches.
std::vector<ContainedPart> contained_parts(const PlainObject& inner, std::span<const std::uint32_t> touching,
                                           std::span<const ExactPenetration> found) {
  VertexSets sets(inner.positions.size());
  std::vector<std::uint8_t> is_used(inner.positions.size(), 0), is_excluded = is_used, is_inside = is_used;
  const auto is_finite_triangle = [&](const Triangle& triangle) {
    return std::all_of(triangle.begin(), triangle.end(),
                       [&](std::uint32_t v) { return is_finite(inner.positions[v]); });
  };
  for (const Triangle& triangle : inner.triangles) {
    if (!is_finite_triangle(triangle)) continue;
    for (const std::uint32_t v : triangle) {
      is_used[v] = 1;
      sets.join(triangle[0], v);
    }
  }
  for (const ExactPenetration& p : found) is_inside[p.vertex] = p.where == Containment::inside ? 1 : 0;
  for (const std::uint32_t t : touching) is_excluded[sets.root(inner.triangles[t][0])] = 1;
  std::vector<ContainedPart> parts(inner.positions.size());
  std::size_t part_count = 0;
  for (std::uint32_t v = 0; v < inner.positions.size(); ++v) {
    if (is_used[v] == 0) continue;
    const std::uint32_t root = sets.root(v);
    if (root == v) ++part_count;
    parts[root].vertex = root;
    ++parts[root].vertex_count;
    if (is_inside[v] == 0) is_excluded[root] = 1;
  }
  std::erase_if(parts, [&](const ContainedPart& part) {
    return part.vertex_count == 0 || is_excluded[part.vertex] != 0;
  });
  for (ContainedPart& part : parts) part.is_whole = parts.size() == part_count;
  return parts;
}

}  // namespace

BruteForcePenetrations find_penetrations_by_brute_force(const PlainObject& inner, const PlainObject& outer,
                                                        std::span<const std::uint32_t> touching,
                                                        const Parallel& parallel) {
  BruteForcePenetrations result;
  std::vector<std::uint8_t> is_used(inner.positions.size(), 0);
  for (const Triangle& triangle : inner.triangles) {
    const bool is_inert = std::any_of(triangle.begin(), triangle.end(),
                                      [&](std::uint32_t v) { return !is_finite(inner.positions[v]); });
    for (const std::uint32_t v : triangle) is_used[v] |= is_inert ? 0 : 1;
  }
  for (const Triangle& triangle : outer.triangles) {
    for (const std::uint32_t v : triangle) {
      if (!is_finite(outer.positions[v])) return result;
    }
  }
  const std::vector<BoxedCorners> triangles = boxed_corners(outer);
  std::vector<std::vector<ExactPenetration>> found(parallel.worker_count());
  parallel.for_ranges(inner.positions.size(), 64, [&](std::size_t begin, std::size_t end, std::uint32_t w) {
    for (std::size_t v = begin; v < end; ++v) {
      if (is_used[v] == 0) continue;
      ExactPenetration penetration{static_cast<std::uint32_t>(v), where_is(inner.positions[v], triangles), 0,
                                   0};
      if (penetration.where == Containment::outside) continue;
      if (penetration.where == Containment::inside) find_nearest(inner.positions[v], triangles, penetration);
      found[w].push_back(penetration);
    }
  });
  for (const auto& part : found) result.vertices.insert(result.vertices.end(), part.begin(), part.end());
  std::sort(result.vertices.begin(), result.vertices.end(),
            [](const auto& p, const auto& q) { return p.vertex < q.vertex; });
  result.parts = contained_parts(inner, touching, result.vertices);
  result.pairs_checked = inner.positions.size() * triangles.size();
  return result;
}

void compare_penetrations(const ObjectPair& pair, std::span<const Penetration> inside,
                          std::span<const std::uint32_t> on_surface, std::span<const ContainedPart> parts,
                          const BruteForcePenetrations& truth,
                          std::vector<PenetrationDifference>& differences) {
  using Fault = PenetrationDifference::Fault;
  const auto note = [&](std::uint32_t vertex, Fault fault) {
    differences.push_back({pair.a, pair.b, vertex, fault});
  };
  auto next_inside = inside.begin();
  auto next_on = on_surface.begin();
  for (const ExactPenetration& expected : truth.vertices) {
    for (; next_inside != inside.end() && next_inside->vertex < expected.vertex; ++next_inside)
      note(next_inside->vertex, Fault::added);
    for (; next_on != on_surface.end() && *next_on < expected.vertex; ++next_on) note(*next_on, Fault::added);
    const bool is_inside = next_inside != inside.end() && next_inside->vertex == expected.vertex;
    const bool is_on = next_on != on_surface.end() && *next_on == expected.vertex;
    const bool is_right_list =
        expected.where == Containment::inside ? is_inside && !is_on : is_on && !is_inside;
    if (!is_right_list)
      note(expected.vertex, Fault::missed);
    else if (is_inside && (next_inside->triangle != expected.triangle ||
                           !is_accurate(next_inside->depth, expected.squared_depth)))
      note(expected.vertex, Fault::inexact);
    if (is_inside) ++next_inside;
    if (is_on) ++next_on;
  }
  for (; next_inside != inside.end(); ++next_inside) note(next_inside->vertex, Fault::added);
  for (; next_on != on_surface.end(); ++next_on) note(*next_on, Fault::added);

  const auto is_same_part = [](const ContainedPart& p, const ContainedPart& q) {
    return p.vertex == q.vertex && p.vertex_count == q.vertex_count && p.is_whole == q.is_whole;
  };
  const auto note_parts = [&](std::span<const ContainedPart> from, std::span<const ContainedPart> without,
                              Fault fault) {
    for (const ContainedPart& part : from) {
      const bool is_known = std::any_of(without.begin(), without.end(), [&](const ContainedPart& other) {
        return is_same_part(part, other);
      });
      if (!is_known) note(part.vertex, fault);
    }
  };
  note_parts(truth.parts, parts, Fault::missed);
  note_parts(parts, truth.parts, Fault::added);
}

}  // namespace supple
