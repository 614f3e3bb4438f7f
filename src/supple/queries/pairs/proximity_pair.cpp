#include "queries/pairs/proximity_pair.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

#include "contact/distance/edge_face_crossing.hpp"
#include "geometry/vector.hpp"

namespace supple {
namespace {

/// Which of an element's sorted vertices a feature has.
std::array<std::uint8_t, 2> ends_of(const Feature& feature) {
  if (feature.kind == FeatureKind::vertex) return {feature.index, feature.index};
  // Edge 2 of a triangle joins corners 2 and 0.
  if (feature.index == 2) return {0, 2};
  return {feature.index, static_cast<std::uint8_t>(feature.index + 1)};
}

/// The side of a pair that belongs to one element.
struct Side {
  FeatureKind kind;
  std::array<std::uint32_t, 2> name;
  Feature on;
  std::array<double, 3> barycentric{};
};

/// The element itself, in the numbering of the user's triangle.
Side side_of_element(const PairElement& element, const Feature& on,
                     const std::array<double, 3>& barycentric) {
  Side side{element.kind, element.name(), on};
  for (std::size_t i = 0; i < element.count; ++i) side.barycentric[element.corners[i]] = barycentric[i];
  if (element.kind != FeatureKind::face) {
    side.barycentric = barycentric;
  } else if (on.kind == FeatureKind::vertex) {
    side.on.index = element.corners[on.index];
  } else if (on.kind == FeatureKind::edge) {
    const auto [first, last] = ends_of(on);
    const auto [low, high] = std::minmax(element.corners[first], element.corners[last]);
    side.on.index = high - low == 2 ? std::uint8_t{2} : low;
  }
  return side;
}

/// The smallest feature as an element of its own.
Side side_of_feature(const PairElement& element, const Feature& on,
                     const std::array<double, 3>& barycentric) {
  if (on.kind == FeatureKind::face || element.count == 1) return side_of_element(element, on, barycentric);
  const auto [first, last] = ends_of(on);
  Side side{on.kind, {element.ids[first], element.ids[last]}, {on.kind, 0}};
  side.barycentric = on.kind == FeatureKind::vertex ? std::array<double, 3>{1, 0, 0}
                                                    : std::array{barycentric[first], barycentric[last], 0.0};
  return side;
}

bool swaps_sides(PairOrder order, FeatureKind kind_a, const std::array<std::uint32_t, 2>& name_a,
                 FeatureKind kind_b, const std::array<std::uint32_t, 2>& name_b) {
  return order == PairOrder::by_names ? std::tie(kind_b, name_b) < std::tie(kind_a, name_a)
                                      : order == PairOrder::swapped;
}

/// The element with the corners in the user's order.
PairElement in_corner_order(const PairElement& element) {
  PairElement result = element;
  for (std::size_t i = 0; i < element.count; ++i) {
    const std::size_t to = element.kind == FeatureKind::face ? element.corners[i] : i;
    result.points[to] = element.points[i];
  }
  return result;
}

/// A feature as an element.
PairElement feature_of(const PairElement& element, const Feature& on) {
  if (on.kind == FeatureKind::face || element.count == 1) return in_corner_order(element);
  const auto [first, last] = ends_of(on);
  PairElement feature;
  feature.kind = on.kind;
  feature.count = on.kind == FeatureKind::vertex ? 1 : 2;
  feature.points = {element.points[first], element.points[last]};
  return feature;
}

/// The direction across two elements or features that touch, towards a.
Vec3d normal_across(const PairElement& a, const PairElement& b) {
  bool used_exact = false;
  if (a.count <= b.count) return distance_within(points_of(a, b), any_distance, used_exact)->normal;
  return -1.0 * distance_within(points_of(b, a), any_distance, used_exact)->normal;
}

void swap_sides(ProximityPair& pair) {
  std::swap(pair.kind_a, pair.kind_b);
  std::swap(pair.element_a, pair.element_b);
  std::swap(pair.on_a, pair.on_b);
  std::swap(pair.barycentric_a, pair.barycentric_b);
  std::swap(pair.point_a, pair.point_b);
  pair.normal = -1.0 * pair.normal;
}

}  // namespace

ElementPoints points_of(const PairElement& a, const PairElement& b) {
  ElementPoints elements;
  elements.count_a = a.count;
  elements.count_b = b.count;
  for (std::size_t i = 0; i < 4; ++i) elements.points[i] = i < a.count ? a.points[i] : b.points[i - a.count];
  return elements;
}

PairName name_of_pair(const ElementIds& first, const ElementIds& second, const ClosestFeatures& features,
                      PairOrder order, ProximityListing listing) {
  const auto on = features_of_elements(features, first.count);
  PairName name{first.kind, second.kind, first.name(), second.name()};
  if (listing == ProximityListing::features) {
    const auto set_feature = [](const ElementIds& element, const Feature& feature, FeatureKind& kind,
                                std::array<std::uint32_t, 2>& ids) {
      if (feature.kind == FeatureKind::face || element.count == 1) return;
      const auto [low, high] = ends_of(feature);
      kind = feature.kind;
      ids = {element.ids[low], element.ids[high]};
    };
    set_feature(first, on[0], name.kind_a, name.element_a);
    set_feature(second, on[1], name.kind_b, name.element_b);
  }
  name.put_in_order(order);
  return name;
}

void PairName::put_in_order(PairOrder order) {
  if (!swaps_sides(order, kind_a, element_a, kind_b, element_b)) return;
  std::swap(kind_a, kind_b);
  std::swap(element_a, element_b);
}

std::optional<ProximityPair> proximity_pair_within(const PairElement& first, const PairElement& second,
                                                   const ObjectPair& objects, PairOrder order,
                                                   ProximityListing listing, double reach, bool& used_exact) {
  const auto found = distance_within(points_of(first, second), reach, used_exact);
  if (!found) return {};
  return proximity_pair_of(first, second, *found, objects, order, listing);
}

ProximityPair proximity_pair_of(const PairElement& first, const PairElement& second,
                                const ElementDistance& found, const ObjectPair& objects, PairOrder order,
                                ProximityListing listing) {
  const bool lists_features = listing == ProximityListing::features;
  const auto side_of = lists_features ? side_of_feature : side_of_element;
  const Side side_a = side_of(first, found.on_a, found.barycentric_a),
             side_b = side_of(second, found.on_b, found.barycentric_b);
  ProximityPair pair{objects.a,          objects.b,     side_a.kind,   side_b.kind,    side_a.name,
                     side_b.name,        side_a.on,     side_b.on,     found.distance, side_a.barycentric,
                     side_b.barycentric, found.point_a, found.point_b, found.normal};
  const bool swaps = swaps_sides(order, side_a.kind, side_a.name, side_b.kind, side_b.name);
  if (swaps) swap_sides(pair);
  if (pair.distance == 0) {
    // The direction across features that touch must not depend on the elements around them.
    const PairElement of_first = lists_features ? feature_of(first, found.on_a) : in_corner_order(first);
    const PairElement of_second = lists_features ? feature_of(second, found.on_b) : in_corner_order(second);
    pair.normal = swaps ? normal_across(of_second, of_first) : normal_across(of_first, of_second);
  }
  pair.normal = pair.normal + Vec3d{};  // no negative zeros, which depend on the order of the elements
  return pair;
}

ProximityPair crossing_pair_of(const PairElement& edge, const PairElement& face, const ObjectPair& objects,
                               PairOrder order, bool& used_exact) {
  const EdgeFaceCrossing found = crossing_of({edge.points[0], edge.points[1]}, corners_of(face), used_exact);
  ProximityPair pair{
      objects.a,     objects.b,      edge.kind,      face.kind,   edge.name(),
      face.name(),   {edge.kind, 0}, {face.kind, 0}, 0,           {found.on_edge[0], found.on_edge[1], 0},
      found.on_face, found.point,    found.point,    found.normal};
  if (order == PairOrder::swapped) swap_sides(pair);
  pair.normal = pair.normal + Vec3d{};
  return pair;
}

TrianglePoints corners_of(const PairElement& face) {
  return in_corner_order(face).points;
}

}  // namespace supple
