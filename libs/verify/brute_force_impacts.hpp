#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/parallel.hpp"
#include "supple/contact.hpp"
#include "supple/verify.hpp"
#include "verify/brute_force_elements.hpp"

namespace supple {

/// Two elements, named as in `ContinuousContact`.
struct TouchingElements {
  ElementPairKind kind = ElementPairKind::vertex_face;
  std::array<std::uint32_t, 2> element_a{}, element_b{};
  TimeBracket time;
  /// The definition leaves a little room for rounding, within which both answers are right.
  bool may_be_missing = false;
};

struct BruteForceImpacts {
  std::vector<TouchingElements> touching;  ///< in canonical order
  std::uint64_t pairs_checked = 0;
};

/// Returns all pairs of elements of these kinds that touch within the step. Each pair is decided by comparing
/// the exact boxes of the elements at both ends or by algebra. For an object with itself (`same_object`),
/// pairs that share a vertex id are left out. Elements with a coordinate that is not finite touch nothing;
/// vertices that no triangle uses are not elements.
BruteForceImpacts find_impacts_by_brute_force(const PlainObject& a, const PlainObject& b, bool same_object,
                                              const ImpactOptions& options, ElementKinds kinds,
                                              const Parallel& parallel);

/// Appends the differences between reported contacts and the truth, both in canonical order: contacts that
/// are missed or added, and times that are later than the truth or more than `toi_tolerance_at` earlier.
///
/// With `ContinuousListing::first`, a contact may be missing when both of its elements have a contact in
/// `all_reported`, of all pairs of objects, that is not later.
void compare_impacts(const ObjectPair& pair, std::span<const ContinuousContact> reported,
                     std::span<const TouchingElements> truth, ContinuousListing listing,
                     std::span<const ContinuousContact> all_reported,
                     std::vector<ContinuousDifference>& differences);

}  // namespace supple
