#include "contact/intersection/triangle_intersection.hpp"

#include <algorithm>
#include <cassert>
#include <optional>
#include <utility>

#include "contact/intersection/meeting_point.hpp"
#include "contact/intersection/separating_normal.hpp"
#include "geometry/exact_predicates.hpp"
#include "geometry/plane_filter.hpp"
#include "geometry/vector.hpp"

namespace supple {
namespace {

using Signs = std::array<int, 3>;

constexpr Feature vertex(int corner) {
  return {FeatureKind::vertex, static_cast<std::uint8_t>(corner)};
}
constexpr Feature edge_from(int corner) {
  return {FeatureKind::edge, static_cast<std::uint8_t>(corner)};
}
constexpr Feature face{};
constexpr Feature edge_between(int i, int j) {
  return edge_from((i + 1) % 3 == j ? i : j);
}

/// Where a feature of a and one of b meet in an extreme point of the intersection.
struct Meeting {
  Feature on_a, on_b;

  constexpr auto operator<=>(const Meeting&) const = default;
};

/// At most six: each extreme point of a polygon ends two of its sides, each side lies on one of six edges.
struct Meetings {
  std::array<Meeting, 6> items;
  int count = 0;

  void add(Feature on_a, Feature on_b) {
    assert(count < 6);
    items[count++] = {on_a, on_b};
  }
};

bool all(const Signs& signs, int sign) {
  return signs[0] == sign && signs[1] == sign && signs[2] == sign;
}
bool separated(const Signs& signs) {
  return all(signs, 1) || all(signs, -1);
}

Signs sides_of_plane(const FilteredPlane& plane, const TrianglePoints& corners,
                     const TrianglePoints& triangle, const FilteredSides& filtered, bool& used_exact) {
  Signs signs;
  for (std::size_t i = 0; i < 3; ++i) {
    signs[i] = filtered[i].certain() ? filtered[i].sign()
                                     : orient3d(plane, corners[1], corners[2], triangle[i], used_exact);
  }
  return signs;
}

// Triangles in two different planes
//
// Each triangle meets the line that the planes share in a chord, or one is disjoint from it. The apex is a
// corner alone on its side of the other plane (or alone in it), so that the lines of both edges at the apex
// cross that plane, and the chord runs from one edge to the other. Whether it does so along d = n_a × n_b or
// against it follows from the side of the apex: with the chord's ends apex + s (p - apex) and
// apex + t (q - apex), their difference times the height of the apex over the other plane is a multiple of
// n_a × n_b of known sign.

struct Chord {
  int apex, start, end;  // corners: the chord runs along d from edge apex-start to edge apex-end
  int apex_side;
  Feature on_start, on_end, on_inside;
};

bool alone(const Signs& signs, int i) {
  const int j = signs[(i + 1) % 3], k = signs[(i + 2) % 3];
  return signs[i] > 0 ? j <= 0 && k <= 0 : signs[i] < 0 ? j >= 0 && k >= 0 : j * k > 0;
}

Chord chord_in_plane(const Signs& signs, bool is_b) {
  const int apex = alone(signs, 0) ? 0 : alone(signs, 1) ? 1 : 2;
  const int next = (apex + 1) % 3, last = (apex + 2) % 3;
  const bool above = signs[apex] != 0 ? signs[apex] > 0 : signs[next] < 0;
  const bool forward = above == is_b;
  Chord chord;
  chord.apex = apex;
  chord.start = forward ? next : last;
  chord.end = forward ? last : next;
  chord.apex_side = above ? 1 : -1;
  const auto on_edge_to = [&](int other) {
    if (signs[apex] == 0) return vertex(chord.apex);
    return signs[other] == 0 ? vertex(other) : edge_between(chord.apex, other);
  };
  chord.on_start = on_edge_to(chord.start);
  chord.on_end = on_edge_to(chord.end);
  chord.on_inside = signs[next] == 0 && signs[last] == 0 ? edge_between(chord.start, chord.end) : face;
  return chord;
}

/// Two chords on one line.
class Chords {
 public:
  Chords(const TrianglePoints& a, const Signs& sides_of_a, const TrianglePoints& b, const Signs& sides_of_b,
         bool& used_exact)
      : a_(a),
        b_(b),
        chord_a_(chord_in_plane(sides_of_a, false)),
        chord_b_(chord_in_plane(sides_of_b, true)),
        used_exact_(used_exact) {
    b_start_to_a_end_ = compare(chord_a_.end, chord_b_.start);
    if (b_start_to_a_end_ <= 0) b_end_to_a_start_ = compare(chord_a_.start, chord_b_.end);
  }

  bool meet() const { return b_start_to_a_end_ <= 0 && b_end_to_a_start_ >= 0; }

  void find_meetings(Meetings& meetings) const {
    const Meeting first = start(), last = end();
    meetings.add(first.on_a, first.on_b);
    if (last != first) meetings.add(last.on_a, last.on_b);
  }

 private:
  /// Where along d the point of b's edge from its apex to `corner_b` lies, compared to that of a's edge. The
  /// volume of the four points is (p_a - apex_a) × (y - x) · (p_b - apex_b) for the points x and y of the two
  /// edges on the line; with y - x = c d that is c ((p_a - apex_a) · n_b) ((p_b - apex_b) · n_a), whose last
  /// two factors have the sign opposite to the side of the apex.
  int compare(int corner_a, int corner_b) const {
    return chord_a_.apex_side * chord_b_.apex_side *
           orient3d(a_[chord_a_.apex], a_[corner_a], b_[chord_b_.apex], b_[corner_b], used_exact_);
  }

  Meeting start() const {
    const int order = compare(chord_a_.start, chord_b_.start);
    if (order == 0) return {chord_a_.on_start, chord_b_.on_start};
    if (order > 0) return {b_start_to_a_end_ == 0 ? chord_a_.on_end : chord_a_.on_inside, chord_b_.on_start};
    return {chord_a_.on_start, b_end_to_a_start_ == 0 ? chord_b_.on_end : chord_b_.on_inside};
  }
  Meeting end() const {
    const int order = compare(chord_a_.end, chord_b_.end);
    if (order == 0) return {chord_a_.on_end, chord_b_.on_end};
    if (order < 0) return {b_end_to_a_start_ == 0 ? chord_a_.on_start : chord_a_.on_inside, chord_b_.on_end};
    return {chord_a_.on_end, b_start_to_a_end_ == 0 ? chord_b_.on_start : chord_b_.on_inside};
  }

  const TrianglePoints &a_, &b_;
  Chord chord_a_, chord_b_;
  bool& used_exact_;
  int b_start_to_a_end_ = 0, b_end_to_a_start_ = 0;
};

// Everything else: triangles in one plane, and triangles without area

/// The smallest simplex with the same points: a triangle, a segment or a point.
struct Simplex {
  const TrianglePoints* points;
  std::array<int, 3> corners;
  int size;
  Projection projection;  // of a triangle

  const Vec3d& operator[](int i) const { return (*points)[corners[i]]; }
  Feature vertex_feature(int i) const { return vertex(corners[i]); }
  int edge_count() const { return size == 3 ? 3 : size - 1; }
  /// The edge from the simplex's vertex i to the next one.
  Feature edge_feature(int i) const { return edge_between(corners[i], corners[(i + 1) % size]); }
  Simplex only(int i) const { return {points, {corners[i], 0, 0}, 1, {}}; }
};

Simplex reduce(const TrianglePoints& triangle, bool& used_exact) {
  const Projection projection = find_projection(triangle[0], triangle[1], triangle[2], used_exact);
  if (projection) return {&triangle, {0, 1, 2}, 3, projection};
  int lowest = 0, highest = 0;
  for (int i = 1; i < 3; ++i) {
    if (lexicographically_less(triangle[i], triangle[lowest])) lowest = i;
    if (lexicographically_less(triangle[highest], triangle[i])) highest = i;
  }
  return {&triangle, {lowest, highest, 0}, lowest == highest ? 1 : 2, {}};
}

/// The part of a segment on which a point of its line lies.
std::optional<Feature> locate_on_segment(const Vec3d& point, const Simplex& segment) {
  if (point == segment[0]) return segment.vertex_feature(0);
  if (point == segment[1]) return segment.vertex_feature(1);
  const bool inside = lexicographically_less(segment[0], point) == lexicographically_less(point, segment[1]);
  return inside ? std::optional(segment.edge_feature(0)) : std::nullopt;
}

/// The part of a triangle in which a point lies, by its signs against the three edges, which are not all
/// zero.
std::optional<Feature> locate_by_signs(const Signs& signs) {
  const bool positive = signs[0] > 0 || signs[1] > 0 || signs[2] > 0;
  const bool negative = signs[0] < 0 || signs[1] < 0 || signs[2] < 0;
  if (positive && negative) return std::nullopt;
  for (int i = 0; i < 3; ++i) {
    if (signs[i] != 0) continue;
    if (signs[(i + 1) % 3] == 0) return vertex((i + 1) % 3);
    if (signs[(i + 2) % 3] == 0) return vertex(i);
    return edge_from(i);
  }
  return face;
}

/// Turns of the points of one simplex against the edges of another, seen along an axis: [edge][point].
using Turns = std::array<Signs, 3>;

Turns find_turns(const Simplex& edges, const Simplex& points, int axis, bool& used_exact) {
  Turns turns{};
  for (int i = 0; i < edges.edge_count(); ++i) {
    for (int j = 0; j < points.size; ++j) {
      turns[i][j] = orient2d(edges[i], edges[(i + 1) % edges.size], points[j], axis, used_exact);
    }
  }
  return turns;
}

/// The part of `simplex` on which a point of its plane lies. The point has the number `index` in `turns`.
std::optional<Feature> locate(const Vec3d& point, int index, const Simplex& simplex, const Turns& turns) {
  if (simplex.size == 3) return locate_by_signs({turns[0][index], turns[1][index], turns[2][index]});
  if (simplex.size == 2) return turns[0][index] == 0 ? locate_on_segment(point, simplex) : std::nullopt;
  return point == simplex[0] ? std::optional(simplex.vertex_feature(0)) : std::nullopt;
}

/// Whether all points lie strictly beyond one edge of the triangle.
bool edge_separates(const Simplex& triangle, const Turns& turns, int point_count) {
  for (int i = 0; i < 3; ++i) {
    bool all_beyond = true;
    for (int j = 0; j < point_count; ++j) all_beyond &= turns[i][j] == -triangle.projection.turn;
    if (all_beyond) return true;
  }
  return false;
}

bool opposite(const Turns& turns, int edge, int point, int next_point) {
  return turns[edge][point] * turns[edge][next_point] < 0;
}

/// For two simplices on one line, or in one plane whose projection along `axis` keeps points apart. An
/// extreme point of the intersection is a vertex of one of the two, or two edges cross there. If a is a
/// triangle, the axis is that of its projection.
void meet_in_plane(const Simplex& a, const Simplex& b, int axis, Meetings& meetings, bool& used_exact) {
  const Turns of_b = find_turns(a, b, axis, used_exact);
  if (a.size == 3 && edge_separates(a, of_b, b.size)) return;
  const Turns of_a = find_turns(b, a, axis, used_exact);
  for (int i = 0; i < a.size; ++i) {
    if (const auto on_b = locate(a[i], i, b, of_a)) meetings.add(a.vertex_feature(i), *on_b);
  }
  for (int j = 0; j < b.size; ++j) {
    const auto on_a = locate(b[j], j, a, of_b);
    if (on_a && on_a->kind != FeatureKind::vertex) meetings.add(*on_a, b.vertex_feature(j));
  }
  for (int i = 0; i < a.edge_count(); ++i) {
    for (int j = 0; j < b.edge_count(); ++j) {
      if (opposite(of_b, i, j, (j + 1) % b.size) && opposite(of_a, j, i, (i + 1) % a.size)) {
        meetings.add(a.edge_feature(i), b.edge_feature(j));
      }
    }
  }
}

/// The part of a triangle that a segment pierces. The ends of the segment lie on different sides of its
/// plane.
std::optional<Feature> pierced_feature(const Simplex& segment, const Simplex& triangle, bool& used_exact) {
  Signs signs;
  for (int i = 0; i < 3; ++i) {
    signs[i] = orient3d(segment[0], segment[1], triangle[i], triangle[(i + 1) % 3], used_exact);
  }
  return locate_by_signs(signs);
}

void meet_triangle(const Simplex& triangle, const Simplex& other, Meetings& meetings, bool& used_exact) {
  const auto& [p, q, r] = *triangle.points;
  const int axis = triangle.projection.axis;
  const int first = orient3d(p, q, r, other[0], used_exact);
  const int second = other.size == 2 ? orient3d(p, q, r, other[1], used_exact) : first;
  if (first == 0 && second == 0) return meet_in_plane(triangle, other, axis, meetings, used_exact);
  if (first * second > 0) return;
  if (first * second == 0) {
    return meet_in_plane(triangle, other.only(first == 0 ? 0 : 1), axis, meetings, used_exact);
  }
  if (const auto on_triangle = pierced_feature(other, triangle, used_exact)) {
    meetings.add(*on_triangle, other.edge_feature(0));
  }
}

void meet_segments_or_points(const Simplex& a, const Simplex& b, Meetings& meetings, bool& used_exact) {
  Projection projection;
  if (a.size == 2 && b.size == 2) {
    if (orient3d(a[0], a[1], b[0], b[1], used_exact) != 0) return;
    projection = find_projection(a[0], a[1], b[0], used_exact);
    if (!projection) projection = find_projection(a[0], a[1], b[1], used_exact);
  } else if (a.size == 2) {
    projection = find_projection(a[0], a[1], b[0], used_exact);
  } else if (b.size == 2) {
    projection = find_projection(b[0], b[1], a[0], used_exact);
  }
  // For points of one line any axis is right.
  meet_in_plane(a, b, projection ? projection.axis : 0, meetings, used_exact);
}

void swap_sides(Meetings& meetings) {
  for (Meeting& meeting : meetings.items) std::swap(meeting.on_a, meeting.on_b);
}

/// For triangles in one plane, or with at least one triangle without area.
void find_special_meetings(const TrianglePoints& a, const TrianglePoints& b, Meetings& meetings,
                           bool& used_exact) {
  const Simplex simplex_a = reduce(a, used_exact), simplex_b = reduce(b, used_exact);
  if (simplex_a.size == 3 && simplex_b.size == 3) {
    meet_in_plane(simplex_a, simplex_b, simplex_a.projection.axis, meetings, used_exact);
  } else if (simplex_a.size == 3) {
    meet_triangle(simplex_a, simplex_b, meetings, used_exact);
  } else if (simplex_b.size == 3) {
    meet_triangle(simplex_b, simplex_a, meetings, used_exact);
    swap_sides(meetings);
  } else {
    meet_segments_or_points(simplex_a, simplex_b, meetings, used_exact);
  }
}

/// `special`: all corners of one triangle lie in the plane of the other. So the two share a plane, or the
/// other has no area.
enum class Placement : std::uint8_t { apart, crossing, special };

/// Signs of the corners of a against the plane of b, and of b against the plane of a.
struct Sides {
  Signs of_a, of_b;
};

Placement classify(const TrianglePoints& a, const TrianglePoints& b, Sides& sides, bool& used_exact) {
  const FilteredPlane plane_b(b);
  const FilteredSides filtered_a(plane_b, a);
  if (filtered_a.separated()) return Placement::apart;
  const FilteredPlane plane_a(a);
  const FilteredSides filtered_b(plane_a, b);
  if (filtered_b.separated()) return Placement::apart;
  if (!std::ranges::all_of(a, is_finite) || !std::ranges::all_of(b, is_finite)) return Placement::apart;
  sides.of_a = sides_of_plane(plane_b, b, a, filtered_a, used_exact);
  if (separated(sides.of_a)) return Placement::apart;
  sides.of_b = sides_of_plane(plane_a, a, b, filtered_b, used_exact);
  if (separated(sides.of_b)) return Placement::apart;
  return all(sides.of_a, 0) || all(sides.of_b, 0) ? Placement::special : Placement::crossing;
}

/// The closed edges of a and of b on which a point lies, one bit each.
unsigned closed_edges(const Meeting& meeting) {
  const auto edges = [](Feature feature) -> unsigned {
    if (feature.kind == FeatureKind::face) return 0;
    if (feature.kind == FeatureKind::edge) return 1u << feature.index;
    return 1u << feature.index | 1u << (feature.index + 2) % 3;
  };
  return edges(meeting.on_a) | edges(meeting.on_b) << 3;
}

/// Each side of a polygon lies on an edge of a or of b. So two points are neighbours when they have an edge
/// in common. No third point lies on this edge: it would be between the two and not extreme.
void order_canonically(Meetings& meetings) {
  const auto first = meetings.items.begin(), last = first + meetings.count;
  for (auto at = first; at != last; ++at) std::rotate(std::upper_bound(first, at, *at), at, at + 1);
  if (meetings.count < 4) return;
  for (auto at = first; at + 1 < last; ++at) {
    const auto next = std::find_if(
        at + 1, last, [&](const Meeting& other) { return (closed_edges(*at) & closed_edges(other)) != 0; });
    assert(next != last);
    std::rotate(at + 1, next, next + 1);
  }
}

}  // namespace

bool triangles_intersect(const TrianglePoints& a, const TrianglePoints& b, bool& used_exact) {
  Sides sides;
  const Placement placement = classify(a, b, sides, used_exact);
  if (placement == Placement::apart) return false;
  if (placement == Placement::crossing) return Chords(a, sides.of_a, b, sides.of_b, used_exact).meet();
  Meetings meetings;
  find_special_meetings(a, b, meetings, used_exact);
  return meetings.count > 0;
}

bool triangles_intersect(const TrianglePoints& a, const TrianglePoints& b) {
  bool used_exact = false;
  return triangles_intersect(a, b, used_exact);
}

TriangleIntersection intersect_triangles(const TrianglePoints& a, const TrianglePoints& b) {
  TriangleIntersection result = intersect_triangles_without_normal(a, b);
  if (!result.intersects) return result;
  IntersectingPairs pair;
  pair.add(a, b);
  separating_normals(pair, &result.normal);
  return result;
}

TriangleIntersection intersect_triangles_without_normal(const TrianglePoints& a, const TrianglePoints& b) {
  TriangleIntersection result;
  Sides sides;
  const Placement placement = classify(a, b, sides, result.used_exact_fallback);
  if (placement == Placement::apart) return result;
  Meetings meetings;
  if (placement == Placement::crossing) {
    const Chords chords(a, sides.of_a, b, sides.of_b, result.used_exact_fallback);
    if (chords.meet()) chords.find_meetings(meetings);
  } else {
    find_special_meetings(a, b, meetings, result.used_exact_fallback);
  }
  order_canonically(meetings);
  result.intersects = meetings.count > 0;
  result.kind = meetings.count > 2    ? IntersectionKind::polygon
                : meetings.count == 2 ? IntersectionKind::segment
                                      : IntersectionKind::point;
  result.point_count = static_cast<std::uint8_t>(meetings.count);
  for (std::size_t i = 0; i < result.point_count; ++i) {
    const auto [on_a, on_b] = meetings.items[i];
    result.points[i] = {meeting_point(a, on_a, b, on_b), on_a, on_b};
  }
  return result;
}

}  // namespace supple
