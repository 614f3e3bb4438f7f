// The first contact of two moving elements, decided for `verify` by code that detection does not use.
//
// The points of one element differ from those of the other by x(t) - k, where k runs over a triangle (vertex
// and face) or a parallelogram (two edges) K(t). The elements touch when K has a point at a distance of at
// most d from x. K is the union of its corners, its open sides that have a length, and its interior where it
// has an area, and for each of these the question is a conjunction of polynomial conditions p(t) >= 0 and
// q(t) > 0. The first time of contact is therefore t = 0 or a root of one of the polynomials p, and it is
// enough to decide the conditions at these times. Sturm's theorem isolates the roots, and Sylvester's form of
// it gives the sign of a polynomial at a root. With d = 0 all times of contact are roots of the volume that
// the four vertices span, unless that is 0 throughout.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "geometry/numbers/number_vector.hpp"
#include "geometry/vector.hpp"
#include "supple/continuous.hpp"
#include "verify/algebra/distance_algebra.hpp"
#include "verify/algebra/sturm.hpp"

namespace supple {
namespace {

using sturm::Integer;
using sturm::lowest_bit;
using sturm::Polynomial;
using sturm::Root;
using sturm::to_integer;
using Path = NumberVector<Polynomial>;

/// A part of K and the conditions under which it has a point within the separation.
struct Part {
  std::vector<Polynomial> not_negative;  ///< the first tells whether its line or plane is near enough
  std::optional<Polynomial> positive;
};

struct Elements {
  std::vector<Part> parts{};
  Polynomial volume{};

  Elements(const std::array<Vec3d, 4>& start, const std::array<Vec3d, 4>& end, bool edges,
           double separation) {
    int lowest = lowest_bit(separation);
    for (const auto* moment : {&start, &end}) {
      for (const Vec3d& p : *moment)
        lowest = std::min({lowest, lowest_bit(p.x), lowest_bit(p.y), lowest_bit(p.z)});
    }
    std::array<Path, 4> vertices;
    for (std::size_t i = 0; i < 4; ++i) {
      for (int axis = 0; axis < 3; ++axis) {
        const Integer from = to_integer(start[i][axis], lowest), to = to_integer(end[i][axis], lowest);
        vertices[i][axis] = Polynomial{from, to - from} + Polynomial{};
      }
    }
    const Integer d = to_integer(separation, lowest);
    const Polynomial squared_separation = Polynomial{d * d} + Polynomial{};
    const Path x = minus(vertices[0], vertices[edges ? 2 : 1]);
    const Path u = minus(edges ? vertices[0] : vertices[2], vertices[1]);
    const Path w = minus(vertices[3], vertices[edges ? 2 : 1]);
    const Path to_u = minus(x, u), to_w = minus(x, w);
    // These take the vector from a corner.
    const auto add_corner = [&](const Path& from) {
      parts.push_back({{squared_separation - dot(from, from)}, {}});
    };
    const auto add_side = [&](const Path& from, const Path& side) {
      const Polynomial along = dot(from, side), whole = dot(side, side);
      const Path moment = cross(from, side);
      parts.push_back({{squared_separation * whole - dot(moment, moment), along, whole - along}, whole});
    };
    for (const Path* corner : {&x, &to_u, &to_w}) add_corner(*corner);
    add_side(x, u);
    add_side(x, w);
    if (edges) {
      add_corner(minus(to_u, w));
      add_side(to_u, w);
      add_side(to_w, u);
    } else {
      add_side(to_u, minus(w, u));
    }
    const Path normal = cross(u, w);
    volume = dot(x, normal);
    const Polynomial whole = dot(normal, normal);
    const Polynomial alpha = dot(cross(x, w), normal), beta = dot(cross(u, x), normal), rest = whole - alpha;
    Part inside{{squared_separation * whole - volume * volume, alpha, beta}, whole};
    if (edges) inside.not_negative.push_back(rest);
    inside.not_negative.push_back((edges ? whole : rest) - beta);
    parts.push_back(std::move(inside));
  }
};

template <class SignOf>
bool touches(const Part& part, SignOf&& sign_of) {
  return (!part.positive || sign_of(*part.positive) > 0) &&
         std::ranges::all_of(part.not_negative, [&](const Polynomial& p) { return sign_of(p) >= 0; });
}

std::optional<TimeBracket> first_contact(const Elements& elements, bool separated) {
  const sturm::Time start(0, 0);
  const auto touches_at_start = [&](const Part& part) {
    return touches(part, [&](const Polynomial& p) { return sign_at(p, start); });
  };
  if (std::ranges::any_of(elements.parts, touches_at_start)) return TimeBracket{0, 0};

  std::optional<TimeBracket> first;
  const auto consider = [&](const Polynomial& p, const std::vector<Part>& parts) {
    if (p.empty()) return;
    for (Root& root : roots_in_step(p)) {
      const auto [low, high] = root.neighbouring_doubles();
      if (first && low >= first->high) return;
      const auto touches_at_root = [&](const Part& part) {
        return touches(part, [&](const Polynomial& q) { return root.sign_of(q); });
      };
      if (!std::ranges::any_of(parts, touches_at_root)) continue;
      first = first ? TimeBracket{std::min(low, first->low), std::min(high, first->high)}
                    : TimeBracket{low, high};
      return;
    }
  };
  if (!separated && !elements.volume.empty()) {
    consider(elements.volume, elements.parts);
    return first;
  }
  for (const Part& part : elements.parts) {
    const Polynomial& near = part.not_negative.front();
    for (const Polynomial& p : part.not_negative) {
      if (near.empty() || &p == &near) consider(p, {part});
    }
  }
  return first;
}

/// Whether the elements are farther apart than the separation along `direction` at both ends of the step,
/// hence throughout. A dot product is off by less than 2^-51 of the sum of its terms' magnitudes.
bool apart_along(Vec3d direction, const std::array<Vec3d, 4>& start, const std::array<Vec3d, 4>& end,
                 std::size_t first_size, double separation) {
  const double length = scaled_norm(direction);
  if (!(length > 0x1p-1000 && length < 0x1p1000)) return false;
  direction = direction / length;
  double above = std::numeric_limits<double>::infinity(), below = above, size = 0;
  for (const auto* moment : {&start, &end}) {
    std::array<double, 4> along;
    for (std::size_t i = 0; i < 4; ++i) {
      const Vec3d& p = (*moment)[i];
      along[i] = dot(direction, p);
      size = std::max(size, std::fabs(p.x) + std::fabs(p.y) + std::fabs(p.z));
    }
    for (std::size_t i = 0; i < first_size; ++i) {
      for (std::size_t j = first_size; j < 4; ++j) {
        above = std::min(above, along[i] - along[j]);
        below = std::min(below, along[j] - along[i]);
      }
    }
  }
  return std::max(above, below) > separation * (1 + 0x1p-48) + size * 0x1p-48 + 0x1p-1000;
}

std::optional<TimeBracket> first_contact(const std::array<Vec3d, 4>& start, const std::array<Vec3d, 4>& end,
                                         std::size_t first_size, double separation) {
  if (!std::isfinite(separation) || separation < 0) {
    fail("min_separation is " + std::to_string(separation) + "; give a finite number that is not negative");
  }
  for (std::size_t i = 0; i < 4; ++i) {
    if (!is_finite(start[i]) || !is_finite(end[i])) return std::nullopt;
  }
  if (clearly_apart(start, end, first_size, separation)) return std::nullopt;
  return first_contact(Elements(start, end, first_size == 2, separation), separation > 0);
}

}  // namespace

/// Tries the directions that separate most elements: normals to both elements, to one element and one edge,
/// and lines between vertices and from edges to vertices, all in the middle of the step.
bool clearly_apart(const std::array<Vec3d, 4>& start, const std::array<Vec3d, 4>& end, std::size_t first_size,
                   double separation) {
  const auto path = [&](std::size_t from, std::size_t to) {
    return (start[to] - start[from]) + (end[to] - end[from]);
  };
  const auto apart = [&](const Vec3d& direction) {
    return apart_along(direction, start, end, first_size, separation);
  };
  const Vec3d u = path(first_size == 1 ? 2 : 0, 1), w = path(2, 3), normal = cross(u, w);
  if (apart(normal) || apart(cross(normal, u)) || apart(cross(normal, w))) return true;
  if (first_size == 1 && apart(cross(normal, path(1, 3)))) return true;
  for (std::size_t i = 0; i < 4; ++i) {
    const std::size_t begin = i < first_size ? first_size : 0, count = i < first_size ? 4 : first_size;
    for (std::size_t j = begin; j < count; ++j) {
      const Vec3d between = path(j, i);
      if (i < first_size && apart(between)) return true;
      for (std::size_t k = j + 1; k < count; ++k) {
        const Vec3d edge = path(j, k);
        if (apart(between - dot(between, edge) / dot(edge, edge) * edge)) return true;
      }
    }
  }
  return false;
}

std::optional<TimeBracket> first_contact_by_algebra(const VertexFaceMotion& motion, double min_separation) {
  return first_contact(motion.start, motion.end, 1, min_separation);
}

std::optional<TimeBracket> first_contact_by_algebra(const EdgeEdgeMotion& motion, double min_separation) {
  return first_contact(motion.start, motion.end, 2, min_separation);
}

std::optional<TimeBracket> first_contact_by_algebra(const PointPointMotion& motion, double min_separation) {
  const auto with_face = [](const std::array<Vec3d, 2>& p) { return std::array{p[0], p[1], p[1], p[1]}; };
  return first_contact(with_face(motion.start), with_face(motion.end), 1, min_separation);
}

std::optional<TimeBracket> first_contact_by_algebra(const PointEdgeMotion& motion, double min_separation) {
  const auto with_face = [](const std::array<Vec3d, 3>& p) { return std::array{p[0], p[1], p[2], p[2]}; };
  return first_contact(with_face(motion.start), with_face(motion.end), 1, min_separation);
}

}  // namespace supple
