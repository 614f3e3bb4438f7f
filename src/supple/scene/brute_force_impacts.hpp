#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <span>
#include <vector>

#include "core/parallel.hpp"
#include "supple/contact.hpp"
#include "supple/mesh.hpp"
#include "supple/result.hpp"

namespace supple {

/// An object in motion as the brute force sees it: positions and triangles in the user's numbers.
struct PlainMovingObject {
  std::vector<Vec3d> start, end;
  std::vector<Triangle> triangles;
};

/// As `ContinuousContact` names them.
struct TouchingElements {
  ElementPairKind kind = ElementPairKind::vertex_face;
  std::array<std::uint32_t, 2> element_a{}, element_b{};
  TimeBracket time;
};

struct BruteForceImpacts {
  std::vector<TouchingElements> touching;  ///< in canonical order
  std::uint64_t pairs_checked = 0;
};

/// All pairs of a vertex and a face and of two edges that touch within the step, decided by comparing the
/// exact boxes of the elements at both ends or by algebra. Of an object with itself (`same_object`) without
/// those that share a vertex id. Elements with a coordinate that is not finite are in none; vertices that no
/// triangle uses are no elements.
///
/// Every pair is decided, most of them many at a time: the boxes of b are sorted along x.
BruteForceImpacts find_impacts_by_brute_force(const PlainMovingObject& a, const PlainMovingObject& b,
                                              bool same_object, double separation, const Parallel& parallel);

/// Appends the differences between reported contacts and the truth, both in canonical order: contacts that
/// are missed or added, and times that are later than the truth or more than `toi_tolerance` earlier.
void compare_impacts(const ObjectPair& pair, std::span<const ContinuousContact> reported,
                     std::span<const TouchingElements> truth, std::vector<ContinuousDifference>& differences);

}  // namespace supple
