#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>

#include "contact/distance/element_distance.hpp"
#include "supple/proximity.hpp"
#include "supple/result.hpp"
#include "supple/triangle_intersection.hpp"

namespace supple {

/// One of the two elements of a pair without its positions: its vertices by ascending user's ids, and its
/// name.
struct ElementIds {
  FeatureKind kind = FeatureKind::vertex;
  std::uint8_t count = 0;
  std::array<std::uint8_t, 3> corners{0, 1, 2};  ///< the corner of the user's triangle that has each id
  std::array<std::uint32_t, 3> ids{};            ///< ascending
  std::uint32_t triangle = 0;

  ElementIds() = default;
  /// One to three vertices; three are the corners of the triangle in the user's order.
  ElementIds(std::span<const std::uint32_t> vertex_ids, std::uint32_t triangle_id)
      : kind(static_cast<FeatureKind>(vertex_ids.size() - 1)),
        count(static_cast<std::uint8_t>(vertex_ids.size())),
        triangle(triangle_id) {
    std::copy(vertex_ids.begin(), vertex_ids.end(), ids.begin());
    if (count > 1) put_in_order(0);
    if (count > 2) put_in_order(1);
    if (count > 2) put_in_order(0);
  }

  std::array<std::uint32_t, 2> name() const {
    if (kind == FeatureKind::face) return {triangle, triangle};
    return {ids[0], ids[count - 1u]};
  }

 private:
  void put_in_order(std::size_t i) {
    if (!(ids[i + 1] < ids[i])) return;
    std::swap(ids[i], ids[i + 1]);
    std::swap(corners[i], corners[i + 1]);
  }
};

struct PairElement : ElementIds {
  std::array<Vec3d, 3> points{};

  PairElement() = default;
  explicit PairElement(const ElementIds& element) : ElementIds(element) {}
  /// `positions` are in the order of `vertex_ids`.
  PairElement(std::span<const std::uint32_t> vertex_ids, const std::array<Vec3d, 3>& positions,
              std::uint32_t triangle_id)
      : PairElement(ElementIds(vertex_ids, triangle_id), positions) {}
  PairElement(const ElementIds& element, const std::array<Vec3d, 3>& positions) : ElementIds(element) {
    for (std::size_t i = 0; i < count; ++i) points[i] = positions[corners[i]];
  }
};

/// The points of both elements; the first one has no more vertices than the second.
ElementPoints points_of(const PairElement& first, const PairElement& second);

/// Which element of a pair belongs to object a: the first, the second, or, within one object, the smaller
/// one.
enum class PairOrder : std::uint8_t { given, swapped, by_names };

/// What a list of pairs is ordered by: the kinds and the user's numbers of both sides.
struct PairName {
  FeatureKind kind_a{}, kind_b{};
  std::array<std::uint32_t, 2> element_a{}, element_b{};

  auto operator<=>(const PairName& other) const { return packed() <=> other.packed(); }
  bool operator==(const PairName& other) const { return packed() == other.packed(); }
  void put_in_order(PairOrder order);

 private:
  /// The members in the order of the comparison, as few numbers.
  std::array<std::uint64_t, 3> packed() const {
    const auto both = [](std::uint64_t high, std::uint64_t low) { return high << 32 | low; };
    return {both(static_cast<std::uint64_t>(kind_a), static_cast<std::uint64_t>(kind_b)),
            both(element_a[0], element_a[1]), both(element_b[0], element_b[1])};
  }
};
/// The name of the pair that `proximity_pair_of` makes.
PairName name_of_pair(const ElementIds& first, const ElementIds& second, const ClosestFeatures& features,
                      PairOrder order, ProximityListing listing);
ProximityPair proximity_pair_of(const PairElement& first, const PairElement& second,
                                const ElementDistance& found, const ObjectPair& objects, PairOrder order,
                                ProximityListing listing);

/// The pair of two elements or of their closest features, if they are within `reach`. The first element has
/// one vertex and the second one to three, or both have two. All numbers depend on the ids and the positions
/// alone: two element pairs with the same closest features give the same bits. Sets `used_exact` when
/// integers decide.
std::optional<ProximityPair> proximity_pair_within(const PairElement& first, const PairElement& second,
                                                   const ObjectPair& objects, PairOrder order,
                                                   ProximityListing listing, double reach, bool& used_exact);

/// The pair of an edge that crosses a face, as `edge_crosses_face` says. It is the same in both listings.
/// Sets `used_exact` when integers decide.
ProximityPair crossing_pair_of(const PairElement& edge, const PairElement& face, const ObjectPair& objects,
                               PairOrder order, bool& used_exact);
/// The corners of a face in the user's order.
TrianglePoints corners_of(const PairElement& face);

}  // namespace supple
