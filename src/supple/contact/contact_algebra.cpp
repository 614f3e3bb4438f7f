// The first contact of moving elements by algebra.
//
// Two elements are as near as their features: two of {vertex, open edge, open face}, one of each element,
// whose lines and planes have their nearest points within both. Which ones have them is told by strict
// inequalities between polynomials in t, and their squared distance by a quotient of polynomials. All times
// at which the distance is at most d are a closed set. At its first moment, unless that is 0, some features
// are at distance d that were farther apart just before, so it is a root of their
// |distance|² · divisor - d² · divisor, which is not the polynomial 0.

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "geometry/integer_points.hpp"
#include "geometry/polynomial.hpp"
#include "supple/continuous.hpp"

namespace supple {

namespace {

/// x, y, z of the four vertices at the start, then at the end, and the separation.
using Numbers = std::array<double, 25>;

Numbers numbers_of(const std::array<Vec3d, 4>& start, const std::array<Vec3d, 4>& end,
                   double min_separation) {
  Numbers numbers;
  std::size_t i = 0;
  for (const auto* moment : {&start, &end}) {
    for (const Vec3d& p : *moment) {
      for (int axis = 0; axis < 3; ++axis) numbers[i++] = p[axis];
    }
  }
  numbers[i] = min_separation;
  return numbers;
}

bool is_finite(double value) {
  return Dyadic(value).exponent + 1075 < 0x7ff;
}

// ---------------------------------------------------------------------------------------- quick rejection

/// The numbers rounded down to multiples of a power of two and divided by it, so that all are below 2^56:
/// true differences are less than 1 away from those of the integers.
class FixedPoint {
 public:
  explicit FixedPoint(const Numbers& numbers) {
    const BitRange range(numbers);
    unit_ = range.lowest + range.width - bits;
    exact = range.width <= bits;
    for (std::size_t i = 0; i < 24; ++i) points_[i / 12][i % 12 / 3][i % 3] = rounded_down(numbers[i]);
    separation = -rounded_down(-numbers[24]);
  }

  const Vector3<std::int64_t>& at(std::size_t moment, std::size_t vertex) const {
    return points_[moment][vertex];
  }

  static constexpr int bits = 56;
  bool exact;               ///< nothing was lost by rounding
  std::int64_t separation;  ///< rounded up

 private:
  std::int64_t rounded_down(double value) const {
    const Dyadic dyadic(value);
    if (dyadic.mantissa == 0) return 0;
    const int shift = dyadic.exponent - unit_;
    const auto mantissa = static_cast<std::int64_t>(dyadic.mantissa);
    if (shift >= 0) return dyadic.negative ? -(mantissa << shift) : mantissa << shift;
    if (shift < -63) return dyadic.negative ? -1 : 0;
    return (dyadic.negative ? -mantissa : mantissa) >> -shift;
  }

  int unit_;
  std::array<std::array<Vector3<std::int64_t>, 4>, 2> points_;
};

/// Whether at both ends of the step, hence throughout, all vertices of one element are farther than the
/// separation to the same side of all those of the other.
bool apart_along_an_axis(const FixedPoint& fixed, std::size_t first_size) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::int64_t above = std::numeric_limits<std::int64_t>::max(), below = above;
    for (std::size_t moment = 0; moment < 2; ++moment) {
      for (std::size_t i = 0; i < first_size; ++i) {
        for (std::size_t j = first_size; j < 4; ++j) {
          const std::int64_t difference = fixed.at(moment, i)[axis] - fixed.at(moment, j)[axis];
          above = std::min(above, difference);
          below = std::min(below, -difference);
        }
      }
    }
    if (std::max(above, below) > fixed.separation) return true;
  }
  return false;
}

/// Not below the square root of a number below 2^42.
std::int64_t root_rounded_up(std::int64_t square) {
  std::int64_t root = 0;
  for (std::int64_t bit = 1 << 20; bit > 0; bit >>= 1) {
    if ((root + bit) * (root + bit) < square) root += bit;
  }
  return root + 1;
}

/// As `apart_along_an_axis` along a direction with entries of at most 2^20; false along (0, 0, 0).
bool apart_along(const Vector3<std::int64_t>& direction, const FixedPoint& fixed, std::size_t first_size) {
  std::int64_t sum = 0, square = 0;
  for (const std::int64_t value : direction) sum += std::abs(value), square += value * value;
  if (sum == 0) return false;
  Int128 above = std::numeric_limits<std::int64_t>::max(), below = above;
  above <<= 32, below <<= 32;
  for (std::size_t moment = 0; moment < 2; ++moment) {
    std::array<Int128, 4> along{};
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        along[i] += Int128{fixed.at(moment, i)[axis]} * direction[axis];
      }
    }
    for (std::size_t i = 0; i < first_size; ++i) {
      for (std::size_t j = first_size; j < 4; ++j) {
        above = std::min(above, along[i] - along[j]);
        below = std::min(below, along[j] - along[i]);
      }
    }
  }
  // Each coordinate of a difference may be off by 1.
  return std::max(above, below) >= Int128{fixed.separation} * root_rounded_up(square) + sum;
}

/// About the same direction, with entries of at most 2^20.
Vector3<std::int64_t> shortened(Vector3<std::int64_t> v) {
  std::uint64_t all = 0;
  for (const std::int64_t value : v) all |= static_cast<std::uint64_t>(std::abs(value));
  const int excess = std::max(0, 44 - std::countl_zero(all));
  for (std::int64_t& value : v) value >>= excess;
  return v;
}

/// Tries directions that tell many elements apart: the normals of both, in the middle of the step, or
/// across one edge of an element, or between two vertices.
bool apart_along_a_direction(const FixedPoint& fixed, std::size_t first_size) {
  const auto path = [&](std::size_t from, std::size_t to) {
    Vector3<std::int64_t> result;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      result[axis] =
          fixed.at(0, to)[axis] - fixed.at(0, from)[axis] + fixed.at(1, to)[axis] - fixed.at(1, from)[axis];
    }
    return shortened(result);
  };
  const auto across = [](const Vector3<std::int64_t>& u, const Vector3<std::int64_t>& v) {
    Vector3<std::int64_t> result;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
      result[i] = u[j] * v[k] - u[k] * v[j];
    }
    return shortened(result);
  };
  const auto u = path(first_size == 1 ? 2 : 0, 1), v = path(2, 3);
  const Vector3<std::int64_t> normal = across(u, v);
  if (apart_along(normal, fixed, first_size) || apart_along(across(normal, u), fixed, first_size) ||
      apart_along(across(normal, v), fixed, first_size)) {
    return true;
  }
  if (first_size == 1 && apart_along(across(normal, path(1, 3)), fixed, first_size)) return true;
  for (std::size_t i = 0; i < first_size; ++i) {
    for (std::size_t j = first_size; j < 4; ++j) {
      if (apart_along(path(j, i), fixed, first_size)) return true;
    }
  }
  return false;
}

/// Entries below 2^57.
Vector3<Int128> cross(const Vector3<std::int64_t>& u, const Vector3<std::int64_t>& v) {
  Vector3<Int128> result;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
    result[i] = Int128{u[j]} * v[k] - Int128{u[k]} * v[j];
  }
  return result;
}

/// u · v / 2^64 up to an error below 1, rounded down. Entries of u below 2^116, of v below 2^57.
Int128 high_part_of_dot(const Vector3<Int128>& u, const Vector3<std::int64_t>& v) {
  Int128 high = 0, low = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    high += (u[i] >> 64) * v[i];
    low += Int128{static_cast<std::uint64_t>(u[i])} * v[i];
  }
  return high + (low >> 64);
}

/// Whether the four vertices are never in one plane: det(w, u, v), a cubic in t, has Bernstein coefficients
/// of one sign.
bool never_coplanar(const FixedPoint& fixed, std::size_t first_size) {
  std::array<Vector3<std::int64_t>, 2> u, v, w;
  for (std::size_t moment = 0; moment < 2; ++moment) {
    u[moment] = difference(fixed.at(moment, 1), fixed.at(moment, first_size == 1 ? 2 : 0));
    v[moment] = difference(fixed.at(moment, 3), fixed.at(moment, 2));
    w[moment] = difference(fixed.at(moment, 0), fixed.at(moment, 2));
  }
  // Rounding may change one entry of each product of three by 1, the others being below 2^57: a determinant
  // by less than 2^119, three of them by less than 2^121.
  const Int128 limit = fixed.exact ? 1 : Int128{1} << 57;
  const Vector3<Int128> n0 = cross(u[0], v[0]);
  const Int128 first = high_part_of_dot(n0, w[0]);
  if (first < limit && first >= -limit) return false;
  const auto same_side = [&](const Int128& value) { return first > 0 ? value >= limit : value < -limit; };
  const Vector3<Int128> n1 = cross(u[1], v[1]);
  if (!same_side(high_part_of_dot(n1, w[1]))) return false;
  Vector3<Int128> mixed = cross(u[0], v[1]);
  const Vector3<Int128> other = cross(u[1], v[0]);
  for (std::size_t i = 0; i < 3; ++i) mixed[i] += other[i];
  return same_side(high_part_of_dot(n0, w[1]) + high_part_of_dot(mixed, w[0])) &&
         same_side(high_part_of_dot(n1, w[0]) + high_part_of_dot(mixed, w[1]));
}

// ----------------------------------------------------------------------------------------------- algebra

/// A vector that is linear in t, or a product of such.
using Path = std::array<Polynomial, 3>;

Polynomial dot(const Path& u, const Path& v) {
  return u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
}
Path cross(const Path& u, const Path& v) {
  return {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
}

/// Vertices of the first element, then of the second. A vertex and an edge stand in this order.
struct FeaturePair {
  enum Kind { interiors, vertex_edge, vertices } kind;
  std::array<std::size_t, 3> vertex = {};
};
constexpr auto interiors = FeaturePair::interiors;
constexpr auto vertex_edge = FeaturePair::vertex_edge;
constexpr auto vertices = FeaturePair::vertices;

constexpr std::array<FeaturePair, 7> vertex_face_features = {{{vertices, {0, 1}},
                                                              {vertices, {0, 2}},
                                                              {vertices, {0, 3}},
                                                              {vertex_edge, {0, 1, 2}},
                                                              {vertex_edge, {0, 2, 3}},
                                                              {vertex_edge, {0, 3, 1}},
                                                              {interiors}}};
constexpr std::array<FeaturePair, 9> edge_edge_features = {{{vertices, {0, 2}},
                                                            {vertices, {0, 3}},
                                                            {vertices, {1, 2}},
                                                            {vertices, {1, 3}},
                                                            {vertex_edge, {0, 2, 3}},
                                                            {vertex_edge, {1, 2, 3}},
                                                            {vertex_edge, {2, 0, 1}},
                                                            {vertex_edge, {3, 0, 1}},
                                                            {interiors}}};

/// Two moving elements in integer coordinates.
class Elements {
 public:
  Elements(const Numbers& numbers, bool edges) : edges_(edges) {
    const int lowest = BitRange(numbers).lowest;
    for (std::size_t vertex = 0; vertex < 4; ++vertex) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto start = to_integer<UnboundedInteger>(numbers[3 * vertex + axis], lowest);
        const auto end = to_integer<UnboundedInteger>(numbers[12 + 3 * vertex + axis], lowest);
        vertices_[vertex][axis] = Polynomial({start, end - start});
      }
    }
    const auto separation = to_integer<UnboundedInteger>(numbers[24], lowest);
    squared_separation_ = separation * separation;
    u_ = path(edges ? 0 : 2, 1);
    v_ = path(2, 3);
    w_ = path(2, 0);
    normal_ = cross(u_, v_);
    volume_ = dot(normal_, w_);
  }

  bool touching_only() const { return squared_separation_.is_zero(); }

  std::span<const FeaturePair> features() const {
    if (edges_) return edge_edge_features;
    return vertex_face_features;
  }

  /// A multiple of the four vertices' determinant.
  const Polynomial& volume() const { return volume_; }

  /// Positive, 0 or negative as the distance of the lines and planes of two features is above, equal to or
  /// below the separation; 0 is told by 0 alone if the separation is 0. Without a meaning where the features
  /// are not `within` reach.
  Polynomial distance(const FeaturePair& pair) const {
    if (pair.kind == FeaturePair::interiors) {
      if (touching_only()) return volume_;
      return volume_ * volume_ - dot(normal_, normal_) * squared_separation_;
    }
    const Path to_vertex = path(pair.vertex[1], pair.vertex[0]);
    if (pair.kind == FeaturePair::vertices) {
      if (touching_only()) return common_roots(to_vertex);
      return dot(to_vertex, to_vertex) - Polynomial({squared_separation_});
    }
    const Path edge = path(pair.vertex[1], pair.vertex[2]);
    const Path moment = cross(to_vertex, edge);
    if (touching_only()) return common_roots(moment);
    return dot(moment, moment) - dot(edge, edge) * squared_separation_;
  }

  /// Polynomials all of which are positive where the nearest points of the features' lines and planes exist
  /// and lie within the features.
  std::vector<Polynomial> within(const FeaturePair& pair) const {
    if (pair.kind == FeaturePair::vertices) return {};
    if (pair.kind == FeaturePair::vertex_edge) {
      const Path to_vertex = path(pair.vertex[1], pair.vertex[0]);
      const Path edge = path(pair.vertex[1], pair.vertex[2]);
      Polynomial along = dot(to_vertex, edge);
      Polynomial rest = dot(edge, edge) - along;
      return {std::move(along), std::move(rest)};
    }
    // The foot of the vertex is s u + r v, or the feet of the edges are s u and r v: times |normal|².
    const Polynomial whole = dot(normal_, normal_);
    Polynomial s = dot(edges_ ? cross(v_, w_) : cross(w_, v_), normal_), r = dot(cross(u_, w_), normal_);
    if (edges_) return {s, whole - s, r, whole - r};
    return {s, r, whole - s - r};
  }

 private:
  Path path(std::size_t from, std::size_t to) const {
    Path result;
    for (std::size_t axis = 0; axis < 3; ++axis) result[axis] = vertices_[to][axis] - vertices_[from][axis];
    return result;
  }

  static Polynomial common_roots(const Path& path) { return gcd(gcd(path[0], path[1]), path[2]); }

  bool edges_;
  std::array<Path, 4> vertices_;
  UnboundedInteger squared_separation_;
  Path u_, v_, w_, normal_;
  Polynomial volume_;
};

bool all_positive(const std::vector<Polynomial>& conditions, UnitRoot& time) {
  return std::ranges::all_of(conditions, [&](const Polynomial& p) { return time.sign_of(p) > 0; });
}

TimeBracket bracket(UnitRoot& time) {
  const auto [low, high] = time.neighbouring_doubles();
  return {low, high};
}

/// At a time when the four vertices are in one plane.
bool coplanar_elements_touch(const Elements& elements, UnitRoot& time) {
  int lowest_sign = 1;
  for (const Polynomial& p : elements.within({interiors})) {
    lowest_sign = std::min(lowest_sign, time.sign_of(p));
    if (lowest_sign < 0) return false;  // And the element has a normal, or this were 0.
  }
  if (lowest_sign > 0) return true;
  return std::ranges::any_of(elements.features(), [&](const FeaturePair& pair) {
    return pair.kind != interiors && time.sign_of(elements.distance(pair)) == 0 &&
           all_positive(elements.within(pair), time);
  });
}

std::optional<TimeBracket> first_coplanar_contact(const Elements& elements) {
  for (UnitRoot& time : roots_in_unit_interval(elements.volume())) {
    if (coplanar_elements_touch(elements, time)) return bracket(time);
  }
  return std::nullopt;
}

std::optional<TimeBracket> first_contact_of_features(const Elements& elements) {
  const std::span<const FeaturePair> features = elements.features();
  std::vector<Polynomial> distances;
  UnitRoot start(BinaryFraction{});
  for (const FeaturePair& pair : features) {
    distances.push_back(elements.distance(pair));
    const int sign = start.sign_of(distances.back());
    const bool near = elements.touching_only() ? sign == 0 : sign <= 0;
    if (near && all_positive(elements.within(pair), start)) return TimeBracket{0, 0};
  }
  std::optional<TimeBracket> first;
  for (std::size_t i = 0; i < features.size(); ++i) {
    if (distances[i].is_zero()) continue;
    std::vector<UnitRoot> times = roots_in_unit_interval(distances[i]);
    if (times.empty()) continue;
    const std::vector<Polynomial> within = elements.within(features[i]);
    for (UnitRoot& time : times) {
      if (!all_positive(within, time)) continue;
      const TimeBracket found = bracket(time);
      first = first ? TimeBracket{std::min(first->low, found.low), std::min(first->high, found.high)} : found;
      break;
    }
  }
  return first;
}

std::optional<TimeBracket> first_contact(const std::array<Vec3d, 4>& start, const std::array<Vec3d, 4>& end,
                                         std::size_t first_size, double min_separation) {
  if (!is_finite(min_separation) || min_separation < 0) {
    fail("min_separation is " + std::to_string(min_separation) +
         "; give a finite number that is not negative");
  }
  const Numbers numbers = numbers_of(start, end, min_separation);
  if (!std::ranges::all_of(numbers, is_finite)) return std::nullopt;
  const FixedPoint fixed(numbers);
  if (apart_along_an_axis(fixed, first_size)) return std::nullopt;
  if (min_separation == 0 && never_coplanar(fixed, first_size)) return std::nullopt;
  if (apart_along_a_direction(fixed, first_size)) return std::nullopt;
  const Elements elements(numbers, first_size == 2);
  const bool cubic_tells = elements.touching_only() && !elements.volume().is_zero();
  return cubic_tells ? first_coplanar_contact(elements) : first_contact_of_features(elements);
}

}  // namespace

std::optional<TimeBracket> first_contact_by_algebra(const VertexFaceMotion& motion, double min_separation) {
  return first_contact(motion.start, motion.end, 1, min_separation);
}

std::optional<TimeBracket> first_contact_by_algebra(const EdgeEdgeMotion& motion, double min_separation) {
  return first_contact(motion.start, motion.end, 2, min_separation);
}

}  // namespace supple
