#include "verify/brute_force_proximity.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <tuple>
#include <utility>

#include "geometry/vector.hpp"

namespace supple {
namespace {

/// An element with its vertices by ascending ids, so that ties do not depend on the order of corners.
struct SortedElement {
  std::vector<std::pair<std::uint32_t, std::uint8_t>> ids;  ///< with the corners
  std::vector<Vec3d> points;
  std::array<std::uint32_t, 2> name;

  SortedElement(const PlainMovingObject& object, const BoxedElement& element) : name(element.name) {
    for (std::size_t i = 0; i <= static_cast<std::size_t>(element.kind); ++i)
      ids.push_back({element.vertices[i], static_cast<std::uint8_t>(i)});
    std::sort(ids.begin(), ids.end());
    for (const auto& [id, corner] : ids) points.push_back(object.end[id]);
  }
};

std::vector<std::size_t> vertices_of_feature(const Feature& feature) {
  if (feature.kind == FeatureKind::vertex) return {feature.index};
  if (feature.kind == FeatureKind::face) return {0, 1, 2};
  return feature.index == 2 ? std::vector<std::size_t>{0, 2}
                            : std::vector<std::size_t>{feature.index, feature.index + 1u};
}

/// What a listing names on one side of a pair.
struct Side {
  FeatureKind kind;
  std::array<std::uint32_t, 2> name;
  Feature on;

  auto operator<=>(const Side&) const = default;
};

Side side_of(const SortedElement& element, const Feature& on, ProximityListing listing) {
  const std::vector<std::size_t> vertices = vertices_of_feature(on);
  if (listing == ProximityListing::features) {
    if (on.kind == FeatureKind::face) return {on.kind, element.name, {on.kind, 0}};
    return {on.kind, {element.ids[vertices.front()].first, element.ids[vertices.back()].first}, {on.kind, 0}};
  }
  const auto kind = static_cast<FeatureKind>(element.ids.size() - 1);
  if (kind != FeatureKind::face || on.kind == FeatureKind::face) return {kind, element.name, on};
  const std::uint8_t first = element.ids[vertices.front()].second, last = element.ids[vertices.back()].second;
  if (on.kind == FeatureKind::vertex) return {kind, element.name, {on.kind, first}};
  // Edge i joins corners i and (i + 1) mod 3.
  const bool is_forward = last == (first + 1) % 3;
  return {kind, element.name, {on.kind, is_forward ? first : last}};
}

double distance_to_segment(const Vec3d& p, const Vec3d& a, const Vec3d& b) {
  const Vec3d along = b - a, to_p = p - a;
  const double squared = dot(along, along);
  const double part = squared > 0 ? std::clamp(dot(to_p, along) / squared, 0.0, 1.0) : 0;
  const Vec3d rest = to_p - part * along;
  return std::sqrt(dot(rest, rest));
}

/// Whether both ends of an edge are on one side of a face's plane, by far more than rounding.
bool clearly_on_one_side(const std::array<Vec3d, 2>& edge, const std::array<Vec3d, 3>& face) {
  const Vec3d u = face[1] - face[0], v = face[2] - face[0], p = edge[0] - face[0], q = edge[1] - face[0];
  const double least = 1e-12 * largest_magnitude(u) * largest_magnitude(v) *
                           std::max(largest_magnitude(p), largest_magnitude(q)) +
                       1e-290;
  const double first = dot(cross(u, v), p), last = dot(cross(u, v), q);
  return (first > least && last > least) || (first < -least && last < -least);
}

/// Appends the edges of a, or of b with `swaps`, that cross faces of the other object.
void decide_crossings(const PlainMovingObject& a, const std::vector<BoxedElement>& edges,
                      const PlainMovingObject& b, const std::vector<BoxedElement>& faces, bool swaps,
                      bool same_object, const Parallel& parallel, std::vector<NearElements>& near) {
  const auto decide = [&](const BoxedElement& e, const BoxedElement& f) -> std::optional<NearElements> {
    if (f.kind != FeatureKind::face || !may_touch_by_groups(a, e, b, f)) return {};
    const std::array edge{a.end[e.vertices[0]], a.end[e.vertices[1]]};
    const std::array face{b.end[f.vertices[0]], b.end[f.vertices[1]], b.end[f.vertices[2]]};
    if (clearly_on_one_side(edge, face) || !cross_by_algebra(edge, face)) return {};
    NearElements found{e.kind, f.kind, e.name, f.name, {e.kind, 0}, {f.kind, 0}, Rational(0)};
    if (!swaps) return found;
    std::swap(found.kind_a, found.kind_b);
    std::swap(found.element_a, found.element_b);
    std::swap(found.on_a, found.on_b);
    return found;
  };
  decide_all(edges, Sweep(faces), same_object, false, 0, parallel, decide, near);
}

auto place_of(const NearElements& near) {
  return std::tie(near.kind_a, near.kind_b, near.element_a, near.element_b);
}
auto place_of(const ProximityPair& pair) {
  return std::tie(pair.kind_a, pair.kind_b, pair.element_a, pair.element_b);
}

}  // namespace

bool clearly_apart(std::span<const Vec3d> a, std::span<const Vec3d> b, double reach) {
  double size = reach;
  for (const auto& points : {a, b}) {
    for (const Vec3d& p : points) size = std::max(size, largest_magnitude(p - a[0]));
  }
  const double least = reach + 1e-6 * size;
  if (!(size < 1e150) || !(size > 1e-150)) return false;
  const Vec3d u = a.size() == 2 ? a[1] - a[0] : b[1] - b[0];
  const Vec3d v = b.size() == 3 ? b[2] - b[0] : b[1] - b[0];
  const Vec3d n = cross(u, v);
  // The normal of sides that are nearly parallel or tiny is mostly rounding.
  const double nn = dot(n, n);
  const bool has_normal = nn > 1e-8 * dot(u, u) * dot(v, v) + 1e-290;
  if (has_normal && std::fabs(dot(n, a[0] - b[0])) > least * std::sqrt(nn)) return true;
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t k = 0; k < b.size(); ++k) {
      if (b.size() > 1 && distance_to_segment(a[i], b[k], b[(k + 1) % b.size()]) <= least) return false;
      if (a.size() > 1 && distance_to_segment(b[k], a[0], a[1]) <= least) return false;
    }
  }
  // Farther from all borders than the slack: two interiors decide.
  if (!has_normal) return false;
  const Vec3d w = a[0] - b[0];
  const double first = dot(cross(w, v), n) / nn, second = dot(cross(u, w), n) / nn;
  constexpr double slack = 1e-3;
  if (a.size() == 1) return first < -slack || second < -slack || first + second > 1 + slack;
  // The feet are at -dot(w × v, n) / nn on a and -dot(w × u, n) / nn on b.
  const double on_a = -first, on_b = second;
  return on_a < -slack || on_a > 1 + slack || on_b < -slack || on_b > 1 + slack;
}

BruteForceProximity find_proximity_by_brute_force(const PlainMovingObject& a, const PlainMovingObject& b,
                                                  bool same_object, double reach, ProximityListing listing,
                                                  ElementKinds kinds, const Parallel& parallel) {
  const BoxedElements of_a = boxed_elements(a), of_b = boxed_elements(b);
  const bool is_bounded = reach <= std::numeric_limits<double>::max();
  const Rational squared_reach = is_bounded ? squared(reach) : Rational(0);
  BruteForceProximity result;
  result.pairs_checked = element_pairs(of_a, of_b, same_object);
  const auto decide = [&](SortedElement first, SortedElement second,
                          bool swaps) -> std::optional<NearElements> {
    if (first.points.size() + second.points.size() == 4 && clearly_apart(first.points, second.points, reach))
      return {};
    ExactDistance exact = distance_by_algebra(first.points, second.points);
    if (is_bounded && exact.squared > squared_reach) return {};
    Side side_a = side_of(first, exact.on_a, listing), side_b = side_of(second, exact.on_b, listing);
    if (same_object) swaps = std::tie(side_b.kind, side_b.name) < std::tie(side_a.kind, side_a.name);
    if (swaps) std::swap(side_a, side_b);
    return NearElements{side_a.kind, side_b.kind, side_a.name,  side_b.name,
                        side_a.on,   side_b.on,   exact.squared};
  };
  const auto decide_pairs = [&](const std::vector<BoxedElement>& p_all,
                                const std::vector<BoxedElement>& q_all, bool are_edges,
                                const auto& decide_pair) {
    const auto decide_allowed = [&](const BoxedElement& p, const BoxedElement& q) {
      return may_touch_by_groups(a, p, b, q) ? decide_pair(p, q) : std::nullopt;
    };
    decide_all(p_all, Sweep(q_all), same_object, are_edges, reach, parallel, decide_allowed, result.near);
  };
  if (kinds != ElementKinds::edge_edge) {
    decide_pairs(of_a.vertices, of_b.faces, false, [&](const BoxedElement& p, const BoxedElement& q) {
      return decide(SortedElement(a, p), SortedElement(b, q), false);
    });
    if (!same_object) {
      decide_pairs(of_a.faces, of_b.vertices, false, [&](const BoxedElement& p, const BoxedElement& q) {
        return decide(SortedElement(b, q), SortedElement(a, p), true);
      });
    }
  }
  if (kinds != ElementKinds::vertex_face) {
    decide_pairs(of_a.edges, of_b.edges, true, [&](const BoxedElement& p, const BoxedElement& q) {
      // Ties within one object: the edge with the smaller larger id counts as the first.
      const bool in_order = std::pair(p.name[1], p.name[0]) < std::pair(q.name[1], q.name[0]);
      if (!same_object || in_order) return decide(SortedElement(a, p), SortedElement(b, q), false);
      return decide(SortedElement(b, q), SortedElement(a, p), false);
    });
  }
  if (kinds == ElementKinds::all) {
    decide_crossings(a, of_a.edges, b, of_b.faces, false, same_object, parallel, result.near);
    if (!same_object) decide_crossings(b, of_b.edges, a, of_a.faces, true, false, parallel, result.near);
  }
  std::sort(result.near.begin(), result.near.end(),
            [](const NearElements& p, const NearElements& q) { return place_of(p) < place_of(q); });
  const auto same = [](const NearElements& p, const NearElements& q) { return place_of(p) == place_of(q); };
  result.near.erase(std::unique(result.near.begin(), result.near.end(), same), result.near.end());
  return result;
}

void compare_proximity(const ObjectPair& pair, std::span<const ProximityPair> reported,
                       std::span<const NearElements> truth, std::vector<ProximityDifference>& differences) {
  using Fault = ProximityDifference::Fault;
  const auto note = [&](const auto& of, Fault fault) {
    differences.push_back({pair.a, pair.b, of.kind_a, of.kind_b, of.element_a, of.element_b, fault});
  };
  auto found = reported.begin();
  for (const NearElements& expected : truth) {
    for (; found != reported.end() && place_of(*found) < place_of(expected); ++found)
      note(*found, Fault::added);
    if (found == reported.end() || place_of(*found) != place_of(expected)) {
      note(expected, Fault::missed);
      continue;
    }
    const bool is_right = found->on_a == expected.on_a && found->on_b == expected.on_b &&
                          is_accurate(found->distance, expected.squared);
    if (!is_right) note(expected, Fault::inexact);
    ++found;
  }
  for (; found != reported.end(); ++found) note(*found, Fault::added);
}

}  // namespace supple
