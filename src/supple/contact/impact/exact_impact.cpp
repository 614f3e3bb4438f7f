#include "contact/impact/exact_impact.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>

#include "contact/impact/root_search.hpp"
#include "contact/intersection/coplanar_search.hpp"
#include "geometry/numbers/integer_points.hpp"

namespace supple {
namespace {

/// Indices into the four vertices.
struct PointAndSegment {
  std::size_t point, first, second;
};
constexpr std::array<PointAndSegment, 3> face_segments{{{0, 1, 2}, {0, 2, 3}, {0, 3, 1}}};
constexpr std::array<PointAndSegment, 4> edge_segments{{{0, 2, 3}, {1, 2, 3}, {2, 0, 1}, {3, 0, 1}}};

/// Elements touch when the vector m between two of their vertices is a sum α u + β w of their sides, with
/// α ≥ 0, β ≥ 0 and α + β ≤ 1 for a vertex and a face, and with 0 ≤ α ≤ 1 and 0 ≤ β ≤ 1 for two edges. The
/// normal n = u × w gives m · n = 0, α n = m × w and β n = u × m. Any component in which n is not 0 decides.
/// Where n = 0, the elements lie in one plane, and the face or both edges lie on a line.
template <class Numbers>
class FirstContact {
 public:
  using Length = typename Numbers::Length;
  using Area = typename Numbers::Area;
  using Volume = typename Numbers::Volume;
  using Vertices = std::array<std::array<Length, 3>, 8>;  ///< at the start, and then at the end

  /// With `after_start`, only times after the start count, and none when the vertices stay in one plane.
  FirstContact(bool are_edges, const Vertices& vertices, bool after_start)
      : are_edges_(are_edges), after_start_(after_start), vertices_(vertices) {}

  /// Returns false when the integers are too short.
  bool search();
  const std::optional<TimeBracket>& first() const { return first_; }

 private:
  struct MovingVector {
    Vector3<Length> start, end;
  };
  using AreaVector = std::array<Quadratic<Area>, 3>;
  using Root = StepRoot<Numbers>;
  using Definition = CommonRoots<Numbers>;  ///< quadratic polynomials that share a root

  void set_conditions(const AreaVector& alpha, const AreaVector& beta);
  bool apart_throughout() const;
  void search_in_one_plane();
  void search_along_lines();
  void consider_roots(const Cubic<Volume>& polynomial, const Definition& definition);
  void consider_roots(const Quadratic<Area>& polynomial);
  void consider(Root root, const Definition& definition);

  bool touch(Root& root, const Definition& definition) const;
  bool inside(Root& root, const Definition& definition, std::size_t axis, int normal_sign) const;
  bool on_one_segment(Root& root, Definition definition) const;
  bool between_ends(Root& root, const Definition& definition, const PointAndSegment& vertices) const;
  bool vanish(const Root& root, Definition definition, std::span<const Quadratic<Area>> polynomials) const;
  int sign_at(Root& root, const Definition& definition, const Quadratic<Area>& polynomial,
              std::span<const Quadratic<Area>> zero_together) const;

  MovingVector vector(std::size_t from, std::size_t to) const {
    return {difference(vertices_[to], vertices_[from]), difference(vertices_[to + 4], vertices_[from + 4])};
  }
  Quadratic<Area> offset(std::size_t from, std::size_t to, std::size_t axis) const {
    const auto [start, end] = vector(from, to);
    return raised(std::array<Area, 2>{Area(start[axis]), Area(end[axis])});
  }
  std::span<const PointAndSegment> segments() const {
    if (are_edges_) return edge_segments;
    return face_segments;
  }
  std::span<const AreaVector> conditions() const { return std::span(conditions_).first(condition_count_); }
  static AreaVector cross(const MovingVector& a, const MovingVector& b);
  static Cubic<Volume> dot(const MovingVector& a, const AreaVector& b);

  bool are_edges_, after_start_;
  Vertices vertices_;
  AreaVector normal_;
  std::array<AreaVector, 4> conditions_;  ///< do not point against the normal where the elements touch
  std::size_t condition_count_ = 0;
  std::optional<TimeBracket> first_;
  bool exhausted_ = false;
};

template <class Numbers>
auto FirstContact<Numbers>::cross(const MovingVector& a, const MovingVector& b) -> AreaVector {
  AreaVector result;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::size_t x = (axis + 1) % 3, y = (axis + 2) % 3;
    result[axis] = {product(a.start[x], b.start[y]) - product(a.start[y], b.start[x]),
                    product(a.start[x], b.end[y]) - product(a.start[y], b.end[x]) +
                        product(a.end[x], b.start[y]) - product(a.end[y], b.start[x]),
                    product(a.end[x], b.end[y]) - product(a.end[y], b.end[x])};
  }
  return result;
}

template <class Numbers>
auto FirstContact<Numbers>::dot(const MovingVector& a, const AreaVector& b) -> Cubic<Volume> {
  Cubic<Volume> result{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::size_t i = 0; i < 3; ++i) {
      result[i] += product(a.start[axis], b[axis][i]);
      result[i + 1] += product(a.end[axis], b[axis][i]);
    }
  }
  return result;
}

template <class Numbers>
bool FirstContact<Numbers>::search() {
  const MovingVector m = are_edges_ ? vector(2, 0) : vector(1, 0);
  const MovingVector u = are_edges_ ? vector(1, 0) : vector(1, 2);
  const MovingVector w = are_edges_ ? vector(2, 3) : vector(1, 3);
  normal_ = cross(u, w);
  const Cubic<Volume> volume = dot(m, normal_);
  if (strict_sign(volume) != 0) return true;
  set_conditions(cross(m, w), cross(u, m));
  if (apart_throughout()) return true;
  if (!all_zero(volume)) {
    consider_roots(volume, {});
  } else if (!after_start_) {
    search_in_one_plane();
  }
  return !exhausted_;
}

template <class Numbers>
void FirstContact<Numbers>::set_conditions(const AreaVector& alpha, const AreaVector& beta) {
  conditions_[0] = alpha;
  conditions_[1] = beta;
  condition_count_ = are_edges_ ? 4 : 3;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Quadratic<Area> rest = difference(normal_[axis], alpha[axis]);
    if (are_edges_) {
      conditions_[2][axis] = rest;
      conditions_[3][axis] = difference(normal_[axis], beta[axis]);
    } else {
      conditions_[2][axis] = difference(rest, beta[axis]);
    }
  }
}

template <class Numbers>
bool FirstContact<Numbers>::apart_throughout() const {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const int normal_sign = strict_sign(normal_[axis]);
    if (normal_sign == 0) continue;
    for (const AreaVector& condition : conditions()) {
      if (strict_sign(condition[axis]) == -normal_sign) return true;
    }
  }
  return false;
}

/// The first contact is at the start, or where a sign that decides changes.
template <class Numbers>
void FirstContact<Numbers>::search_in_one_plane() {
  consider(Root{}, {});
  if (first_) return;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (all_zero(normal_[axis])) continue;
    consider_roots(normal_[axis]);
    for (const AreaVector& condition : conditions()) consider_roots(condition[axis]);
    return;
  }
  search_along_lines();
}

/// For a face or two edges that lie on one line at all times.
template <class Numbers>
void FirstContact<Numbers>::search_along_lines() {
  for (const auto [point, a, b] : segments()) {
    const AreaVector off_line = cross(vector(a, point), vector(a, b));
    const auto off = std::find_if_not(off_line.begin(), off_line.end(), all_zero<Area, 3>);
    if (off != off_line.end()) {
      consider_roots(*off);
      continue;
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
      consider_roots(offset(point, a, axis));
      consider_roots(offset(point, b, axis));
    }
  }
}

template <class Numbers>
void FirstContact<Numbers>::consider_roots(const Quadratic<Area>& polynomial) {
  if (all_zero(polynomial)) return;
  Definition definition;
  definition.add(polynomial);
  consider_roots(widened<Volume>(raised(polynomial)), definition);
}

template <class Numbers>
void FirstContact<Numbers>::consider_roots(const Cubic<Volume>& polynomial, const Definition& definition) {
  const StepRoots<Numbers> found = find_roots<Numbers>(polynomial);
  exhausted_ = exhausted_ || found.incomplete;
  for (std::size_t i = 0; i < found.count; ++i) consider(found.roots[i], definition);
}

template <class Numbers>
void FirstContact<Numbers>::consider(Root root, const Definition& definition) {
  const TimeInterval<Numbers>& interval = root.interval;
  if (first_ && round_time(interval.low, interval.exponent, false) >= first_->high) return;
  const TimeBracket bracket = neighbouring_doubles(root);
  if (after_start_ && bracket.high == 0) return;
  const bool earlier = !first_ || bracket.low < first_->low || bracket.high < first_->high;
  if (earlier && touch(root, definition)) first_ = bracket;
  exhausted_ = exhausted_ || root.too_fine;
}

template <class Numbers>
bool FirstContact<Numbers>::touch(Root& root, const Definition& definition) const {
  for (bool looked_closer = false;; looked_closer = true) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const int normal_sign = sign_over(root.interval, normal_[axis]);
      if (normal_sign != 0) return inside(root, definition, axis, normal_sign);
    }
    if (!looked_closer && vanish(root, definition, normal_)) return on_one_segment(root, definition);
    if (!narrow(root)) return false;
  }
}

template <class Numbers>
bool FirstContact<Numbers>::inside(Root& root, const Definition& definition, std::size_t axis,
                                   int normal_sign) const {
  for (const AreaVector& condition : conditions()) {
    // A condition that is 0 has all components 0.
    if (sign_at(root, definition, condition[axis], condition) == -normal_sign) return false;
  }
  return true;
}

template <class Numbers>
bool FirstContact<Numbers>::on_one_segment(Root& root, Definition definition) const {
  for (const Quadratic<Area>& component : normal_) definition.add(component);
  for (const PointAndSegment& vertices : segments()) {
    const AreaVector off_line =
        cross(vector(vertices.first, vertices.point), vector(vertices.first, vertices.second));
    if (vanish(root, definition, off_line) && between_ends(root, definition, vertices)) return true;
  }
  return false;
}

/// For three vertices on one line: whether the first is in the box of the others.
template <class Numbers>
bool FirstContact<Numbers>::between_ends(Root& root, const Definition& definition,
                                         const PointAndSegment& vertices) const {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::array<Quadratic<Area>, 2> offsets{offset(vertices.point, vertices.first, axis),
                                                 offset(vertices.point, vertices.second, axis)};
    const int side = sign_at(root, definition, offsets[0], std::span(offsets).first(1));
    if (side != 0 && sign_at(root, definition, offsets[1], std::span(offsets).last(1)) == side) return false;
  }
  return true;
}

/// The sign of a polynomial that is 0 at the root exactly when all of `zero_together` are.
template <class Numbers>
int FirstContact<Numbers>::sign_at(Root& root, const Definition& definition,
                                   const Quadratic<Area>& polynomial,
                                   std::span<const Quadratic<Area>> zero_together) const {
  int result = sign_over(root.interval, polynomial);
  if (result != 0 || vanish(root, definition, zero_together)) return result;
  while (result == 0 && narrow(root)) result = sign_over(root.interval, polynomial);
  return result;
}

/// Whether all polynomials are 0 at the root.
template <class Numbers>
bool FirstContact<Numbers>::vanish(const Root& root, Definition definition,
                                   std::span<const Quadratic<Area>> polynomials) const {
  for (const Quadratic<Area>& polynomial : polynomials) {
    if (sign_over(root.interval, polynomial) != 0) return false;
    definition.add(polynomial);
  }
  return root.interval.is_point() || definition.any_in(root.interval);
}

using Coordinates = std::array<std::array<double, 8>, 3>;

/// Returns false when the integers are too short.
template <class Numbers>
bool search_with(bool are_edges, const Coordinates& coordinates, const std::array<int, 3>& lowest,
                 bool after_start, std::optional<TimeBracket>& first) {
  typename FirstContact<Numbers>::Vertices vertices;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::size_t i = 0; i < 8; ++i) {
      vertices[i][axis] = to_integer<typename Numbers::Length>(coordinates[axis][i], lowest[axis]);
    }
  }
  FirstContact<Numbers> contact(are_edges, vertices, after_start);
  const bool decided = contact.search();
  first = contact.first();
  return decided;
}

std::optional<TimeBracket> search_contact(const ElementMotion& motion, bool after_start) {
  Coordinates coordinates;
  std::array<int, 3> lowest;
  int widest = 0;
  for (int axis = 0; axis < 3; ++axis) {
    auto& row = coordinates[axis];
    for (std::size_t i = 0; i < 4; ++i) {
      row[i] = motion.start[i][axis];
      row[i + 4] = motion.end[i][axis];
    }
    if (!std::ranges::all_of(row, [](double x) { return std::isfinite(x); })) return {};
    const BitRange range(row);
    lowest[axis] = range.lowest;
    widest = std::max(widest, range.width);
  }
  std::optional<TimeBracket> first;
  const bool edges = motion.are_edges;
  const bool decided =
      widest <= 60
          ? search_with<FixedNumbers<1>>(edges, coordinates, lowest, after_start, first)
          : widest <= 124 && search_with<FixedNumbers<2>>(edges, coordinates, lowest, after_start, first);
  if (!decided) search_with<UnboundedNumbers>(edges, coordinates, lowest, after_start, first);
  return first;
}

}  // namespace

std::optional<TimeBracket> exact_first_contact(const ElementMotion& motion) {
  return search_contact(motion, false);
}
std::optional<TimeBracket> exact_next_contact(const ElementMotion& motion) {
  MotionBlock block;
  CoplanarSearch coplanar;
  block.set(0, relative_motion(motion));
  search_coplanar_times(block, 1, motion.are_edges, coplanar);
  return coplanar.clear_after_start != 0 ? std::nullopt : search_contact(motion, true);
}

}  // namespace supple
