#include "verify/brute_force.hpp"

#include <algorithm>
#include <limits>
#include <tuple>
#include <utility>

namespace supple {
namespace {

/// An element with its vertices by ascending ids, so that ties do not depend on the order of corners.
struct SortedElement {
  std::vector<std::pair<std::uint32_t, std::uint8_t>> ids;  ///< with the corners
  std::vector<Vec3d> points;
  std::array<std::uint32_t, 2> name;

  SortedElement(const PlainObject& object, const BoxedElement& element) : name(element.name) {
    for (std::size_t i = 0; i <= static_cast<std::size_t>(element.kind); ++i)
      ids.push_back({element.vertices[i], static_cast<std::uint8_t>(i)});
    std::sort(ids.begin(), ids.end());
    for (const auto& [id, corner] : ids) points.push_back(object.end[id]);
  }
};

/// What a listing names on one side of a pair.
struct Side {
  FeatureKind kind;
  std::array<std::uint32_t, 2> name;
  Feature on;
};

Side side_of(const SortedElement& element, const Feature& on, ProximityListing listing) {
  const bool is_edge = on.kind == FeatureKind::edge, is_face = on.kind == FeatureKind::face;
  // The first and the last vertex of the feature: edges 0, 1 and 2 have the vertices 0 1, 1 2 and 0 2.
  const auto& [first_id, first] = element.ids[is_edge ? on.index % 2 : on.index];
  const auto& [last_id, last] = element.ids[is_edge ? std::min(on.index + 1, 2) : is_face ? 2 : on.index];
  if (listing == ProximityListing::features)
    return {on.kind, is_face ? element.name : std::array{first_id, last_id}, {on.kind, 0}};
  const auto kind = static_cast<FeatureKind>(element.ids.size() - 1);
  if (kind != FeatureKind::face || is_face) return {kind, element.name, on};
  if (on.kind == FeatureKind::vertex) return {kind, element.name, {on.kind, first}};
  // Edge i joins corners i and (i + 1) mod 3.
  const bool is_forward = last == (first + 1) % 3;
  return {kind, element.name, {on.kind, is_forward ? first : last}};
}

/// Appends the edges of a, or of b with `swaps`, that cross faces of the other object.
void decide_crossings(const PlainObject& a, const std::vector<BoxedElement>& edges, const PlainObject& b,
                      const std::vector<BoxedElement>& faces, bool swaps, bool same_object,
                      const Parallel& parallel, std::vector<NearElements>& near) {
  const auto decide = [&](const BoxedElement& e, const BoxedElement& f) -> std::optional<NearElements> {
    if (f.kind != FeatureKind::face || !may_touch_by_groups(a, e, b, f)) return {};
    const std::array edge{a.end[e.vertices[0]], a.end[e.vertices[1]]};
    const std::array face{b.end[f.vertices[0]], b.end[f.vertices[1]], b.end[f.vertices[2]]};
    if (side_of_plane(face, edge[0]) * side_of_plane(face, edge[1]) >= 0 || !cross_by_algebra(edge, face))
      return {};
    NearElements found{e.kind, f.kind, e.name, f.name, {e.kind, 0}, {f.kind, 0}, Rational(0)};
    if (!swaps) return found;
    std::swap(found.kind_a, found.kind_b);
    std::swap(found.element_a, found.element_b);
    std::swap(found.on_a, found.on_b);
    return found;
  };
  decide_all(edges, faces, same_object, 0, parallel, decide, near);
}

}  // namespace

BruteForceProximity find_proximity_by_brute_force(const PlainObject& a, const PlainObject& b,
                                                  bool same_object, double reach, ProximityListing listing,
                                                  ElementKinds kinds, const Parallel& parallel) {
  const BoxedElements of_a = boxed_elements(a), of_b = boxed_elements(b);
  const bool is_bounded = reach <= std::numeric_limits<double>::max();
  const Rational squared_reach = is_bounded ? squared(reach) : Rational(0);
  BruteForceProximity result{{}, element_pairs(of_a, of_b, same_object)};
  const auto decide = [&](const BoxedElement& p, const BoxedElement& q,
                          bool swaps) -> std::optional<NearElements> {
    const PlainObject &of_p = swaps ? b : a, &of_q = swaps ? a : b;
    if (!may_touch_by_groups(of_p, p, of_q, q)) return {};
    SortedElement first(of_p, p), second(of_q, q);
    // Ties within one object: the edge with the smaller larger id counts as the first.
    if (same_object && p.kind == FeatureKind::edge &&
        std::pair(q.name[1], q.name[0]) < std::pair(p.name[1], p.name[0]))
      std::swap(first, second);
    if (first.points.size() + second.points.size() == 4) {
      std::array<Vec3d, 4> points;
      std::ranges::copy(second.points, std::ranges::copy(first.points, points.begin()).out);
      if (clearly_apart(points, points, first.points.size(), reach)) return {};
    }
    ExactDistance exact = distance_by_algebra(first.points, second.points);
    if (is_bounded && exact.squared > squared_reach) return {};
    Side side_a = side_of(first, exact.on_a, listing), side_b = side_of(second, exact.on_b, listing);
    if (same_object) swaps = std::tie(side_b.kind, side_b.name) < std::tie(side_a.kind, side_a.name);
    if (swaps) std::swap(side_a, side_b);
    return NearElements{side_a.kind, side_b.kind, side_a.name,  side_b.name,
                        side_a.on,   side_b.on,   exact.squared};
  };
  decide_elements(of_a, of_b, same_object, kinds, reach, parallel, decide, result.near);
  if (kinds == ElementKinds::all) {
    decide_crossings(a, of_a.edges, b, of_b.faces, false, same_object, parallel, result.near);
    if (!same_object) decide_crossings(b, of_b.edges, a, of_a.faces, true, false, parallel, result.near);
  }
  sort_by_place(result.near);
  return result;
}

void compare_proximity(const ObjectPair& pair, std::span<const ProximityPair> reported,
                       std::span<const NearElements> truth, std::vector<ProximityDifference>& differences) {
  using Fault = ProximityDifference::Fault;
  const auto note = [&](const auto& of, Fault fault) {
    differences.push_back({pair.a, pair.b, of.kind_a, of.kind_b, of.element_a, of.element_b, fault});
  };
  match(
      reported, truth, [](const auto& each) { return place_of(each); },
      [&](const ProximityPair& found) { note(found, Fault::added); },
      [&](const NearElements& expected) { note(expected, Fault::missed); },
      [&](const ProximityPair& found, const NearElements& expected) {
        const bool is_right = found.on_a == expected.on_a && found.on_b == expected.on_b &&
                              is_accurate(found.distance, expected.squared);
        if (!is_right) note(expected, Fault::inexact);
      });
}

}  // namespace supple
