#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/parallel.hpp"
#include "supple/options.hpp"
#include "supple/penetration.hpp"
#include "supple/queries.hpp"
#include "supple/verify.hpp"
#include "verify/brute_force_elements.hpp"
#include "verify/plain_surface.hpp"

namespace supple {

/// A vertex of one object that is inside another or on its surface.
struct ExactPenetration {
  std::uint32_t vertex = 0;
  Containment where = Containment::inside;
  std::uint32_t triangle = 0;  ///< the nearest one, if inside; the smallest of several
  Rational squared_depth;
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

/// What `verify_curves` knows of one of two objects.
struct CurveSideTruth {
  const PlainObject* object = nullptr;
  /// Its vertices inside the other object, which is solid; none when it is not.
  std::span<const ExactPenetration> inside;
};

/// Checks the curves of two objects by what follows from their definition, and appends a difference for each
/// that fails: the normal is a unit vector, the depth is at least 0, and a vertex inside the other object
/// leaves it on its way along the normal, after at most the depth (within 2^-30 of it and 2^-40 of the
/// coordinates). So the depth is also at least that of the vertex. Rationals decide this for vertices that
/// edges without contacts connect and that contacts of only one curve surround; for about 256 of them for
/// each curve and object.
void verify_curves(const ObjectPair& pair, const std::array<CurveSideTruth, 2>& sides,
                   const DetectResult& result, std::vector<PenetrationDifference>& differences);

/// Checks the manifolds of two objects by what follows from their definition, and appends a difference for
/// each that fails: at its curve, or at its nearest pair. The normal and the depth are those of the record
/// (or where surfaces touch, of length 1), each of the one to four points is a point of the contact with its
/// depth, and the deepest one is as deep as the contact. `verify_curves` checks that the way along the normal
/// leads out.
void verify_manifolds(const ObjectPair& pair, const std::array<const PlainObject*, 2>& objects,
                      const DetectResult& result, VerifyReport& report);

}  // namespace supple
