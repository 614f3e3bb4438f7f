#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <span>
#include <vector>

#include "core/parallel.hpp"
#include "scene/brute_force_elements.hpp"
#include "supple/contact.hpp"
#include "supple/result.hpp"

namespace supple {

/// Two elements, named as in `ContinuousContact`.
struct TouchingElements {
  ElementPairKind kind = ElementPairKind::vertex_face;
  std::array<std::uint32_t, 2> element_a{}, element_b{};
  TimeBracket time;
};

struct BruteForceImpacts {
  std::vector<TouchingElements> touching;  ///< in canonical order
  std::uint64_t pairs_checked = 0;
};

/// Returns all vertex-face and edge-edge pairs that touch within the step. Each pair is decided by comparing
/// the exact boxes of the elements at both ends or by algebra. For an object with itself (`same_object`),
/// pairs that share a vertex id are left out. Elements with a coordinate that is not finite touch nothing;
/// vertices that no triangle uses are not elements.
///
/// The boxes of b are sorted along x, so that one comparison decides many pairs.
BruteForceImpacts find_impacts_by_brute_force(const PlainMovingObject& a, const PlainMovingObject& b,
                                              bool same_object, double separation, const Parallel& parallel);

/// Appends the differences between reported contacts and the truth, both in canonical order: contacts that
/// are missed or added, and times that are later than the truth or more than `toi_tolerance_at` earlier.
void compare_impacts(const ObjectPair& pair, std::span<const ContinuousContact> reported,
                     std::span<const TouchingElements> truth, std::vector<ContinuousDifference>& differences);

}  // namespace supple
