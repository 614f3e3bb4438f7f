#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/parallel.hpp"
#include "supple/options.hpp"
#include "supple/penetration.hpp"
#include "supple/queries.hpp"
#include "supple/result.hpp"
#include "verify/brute_force_contacts.hpp"
#include "verify/plain_surface.hpp"

namespace supple {

/// A vertex of one object that is inside another or on its surface.
struct ExactPenetration {
  std::uint32_t vertex = 0;
  Containment where = Containment::inside;
  std::uint32_t triangle = 0;  ///< the nearest one, if inside; the smallest of several
  SquaredDistance squared_depth;
};

struct BruteForcePenetrations {
  std::vector<ExactPenetration> vertices;  ///< ascending
  std::vector<ContainedPart> parts;
  std::uint64_t pairs_checked = 0;  ///< of a vertex and a triangle
};

/// Tests the vertices of `inner` against the triangles of `outer`, a closed surface, by integers. Double
/// precision with error bounds only discards what is clearly farther away or beside the vertex. `touching`
/// are the triangles of `inner` that intersect `outer`, ascending.
BruteForcePenetrations find_penetrations_by_brute_force(const PlainObject& inner, const PlainObject& outer,
                                                        std::span<const std::uint32_t> touching,
                                                        const Parallel& parallel);

/// Appends the differences between the truth and what was reported for one object inside another.
void compare_penetrations(const ObjectPair& pair, std::span<const Penetration> inside,
                          std::span<const std::uint32_t> on_surface, std::span<const ContainedPart> parts,
                          const BruteForcePenetrations& truth,
                          std::vector<PenetrationDifference>& differences);

}  // namespace supple
