#pragma once

#include <vector>

#include "verify/brute_force_elements.hpp"

namespace supple {

/// Returns all intersecting pairs of triangles of two objects at rest, sorted. For an object with itself
/// (`same_object`), these are pairs with a < b that share no vertex id, or that meet beyond what they share
/// with `Neighbours::exact`. Triangles with a coordinate that is not finite intersect nothing.
///
/// Each pair is decided by comparing exact boxes or by exact integer arithmetic.
std::vector<TrianglePair> intersecting_pairs_by_brute_force(const PlainObject& a, const PlainObject& b,
                                                            bool same_object, const Parallel& parallel);

}  // namespace supple
