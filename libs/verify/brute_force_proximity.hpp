#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/parallel.hpp"
#include "supple/proximity.hpp"
#include "supple/verify.hpp"
#include "verify/algebra/distance_algebra.hpp"
#include "verify/brute_force_elements.hpp"

namespace supple {

/// Two features or elements within reach, named as in `ProximityPair`.
struct NearElements {
  FeatureKind kind_a = FeatureKind::vertex, kind_b = FeatureKind::vertex;
  std::array<std::uint32_t, 2> element_a{}, element_b{};
  Feature on_a, on_b;
  Rational squared;
};

struct BruteForceProximity {
  std::vector<NearElements> near;  ///< in canonical order
  std::uint64_t pairs_checked = 0;
};

/// Returns all pairs within reach of objects at rest. Exact boxes, directions in double precision along which
/// elements are apart by far more than rounding, or rationals decide each pair of elements.
BruteForceProximity find_proximity_by_brute_force(const PlainObject& a, const PlainObject& b,
                                                  bool same_object, double reach, ProximityListing listing,
                                                  ElementKinds kinds, const Parallel& parallel);

/// Appends the differences between reported pairs and the truth, both in canonical order.
void compare_proximity(const ObjectPair& pair, std::span<const ProximityPair> reported,
                       std::span<const NearElements> truth, std::vector<ProximityDifference>& differences);

}  // namespace supple
