#pragma once

#include <cstdint>

#include "supple/mesh.hpp"

namespace supple {

/// The number of triangles that face inwards, into what `Scene::inside` finds inside. A solid
/// (`ObjectOptions::solid`) takes them as if they faced outwards: each connected part by the exact sign of
/// its volume, and holes the other way. 0 where the surface bounds no solid (`fault_of_solid`). A part of
/// volume 0 has none. The vertex ids must be valid. O(n log n).
std::uint64_t count_inward_triangles(const TriangleMesh& mesh);

}  // namespace supple
