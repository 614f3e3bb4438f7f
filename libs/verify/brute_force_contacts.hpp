#pragma once

#include <cstdint>
#include <vector>

#include "core/parallel.hpp"
#include "supple/mesh.hpp"
#include "supple/options.hpp"
#include "supple/types.hpp"
#include "world/object/vertex_groups.hpp"

namespace supple {

/// The input of the brute force: placed positions and triangles with the user's ids.
struct PlainObject {
  std::vector<Vec3d> positions;
  std::vector<Triangle> triangles;
  VertexGroups groups{};
  Neighbours neighbours = Neighbours::skip;
};

/// Returns all intersecting pairs of triangles of two objects, sorted. For an object with itself
/// (`same_object`), these are pairs with a < b that share no vertex id, or that meet beyond what they share
/// with `Neighbours::exact`. Triangles with a coordinate that is not finite intersect nothing.
///
/// Each pair is decided by comparing the exact boxes of its triangles or by exact integer arithmetic. The
/// boxes of b are sorted along x, so that one comparison decides many pairs.
std::vector<TrianglePair> intersecting_pairs_by_brute_force(const PlainObject& a, const PlainObject& b,
                                                            bool same_object, const Parallel& parallel);

}  // namespace supple
