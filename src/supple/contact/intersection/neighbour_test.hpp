#pragma once

#include "supple/mesh.hpp"
#include "supple/triangle_intersection.hpp"

namespace supple {

/// Whether two finite triangles with vertex ids in common share a point that is on no common vertex or edge,
/// exactly. True for triangles with the same three vertices. Takes about 50 ns.
bool meet_elsewhere(const Triangle& ids_a, const TrianglePoints& a, const Triangle& ids_b,
                    const TrianglePoints& b);

}  // namespace supple
