#pragma once

#include <cstdint>
#include <vector>

#include "core/parallel.hpp"
#include "supple/mesh.hpp"
#include "supple/types.hpp"

namespace supple {

/// An object as the brute force sees it: placed positions and triangles in the user's numbers.
struct PlainObject {
  std::vector<Vec3d> positions;
  std::vector<Triangle> triangles;
};

/// All intersecting pairs of triangles of two objects, sorted; of an object with itself (`same_object`) those
/// with a < b that share no vertex id. Triangles with a coordinate that is not finite are in none.
///
/// Brute force: every pair is decided by comparing the exact boxes of its triangles or by exact integers. The
/// boxes of b are sorted along x so that most of them are decided many at a time.
std::vector<TrianglePair> intersecting_pairs_by_brute_force(const PlainObject& a, const PlainObject& b,
                                                            bool same_object, const Parallel& parallel);

}  // namespace supple
