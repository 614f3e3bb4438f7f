#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "contact/element_distance.hpp"
#include "supple/proximity.hpp"
#include "supple/result.hpp"

namespace supple {

/// One of the two elements of a pair: its vertices by ascending user's ids, and its name.
struct PairElement {
  FeatureKind kind = FeatureKind::vertex;
  std::uint8_t count = 0;
  std::array<std::uint32_t, 3> ids{};     ///< ascending
  std::array<std::uint8_t, 3> corners{};  ///< the corner of the user's triangle that has each id
  std::array<Vec3d, 3> points{};
  std::uint32_t triangle = 0;

  PairElement() = default;
  /// One to three vertices; three are the corners of the triangle in the user's order.
  PairElement(std::span<const std::uint32_t> vertex_ids, const std::array<Vec3d, 3>& positions,
              std::uint32_t triangle_id);

  std::array<std::uint32_t, 2> name() const {
    if (kind == FeatureKind::face) return {triangle, triangle};
    return {ids[0], ids[count - 1u]};
  }
  /// The larger id counts first.
  std::array<std::uint32_t, 2> edge_order() const { return {ids[1], ids[0]}; }
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

  auto operator<=>(const PairName&) const = default;
};
/// The name of the pair that `proximity_pair_of` makes. Does not read the points of the elements.
PairName name_of_pair(const PairElement& first, const PairElement& second, const ClosestFeatures& features,
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

}  // namespace supple
