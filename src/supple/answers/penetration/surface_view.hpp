#pragma once

#include <cstdint>
#include <span>
#include <utility>

#include "geometry/vector.hpp"
#include "mesh/vertex_triangles.hpp"
#include "octree/object_octree.hpp"
#include "octree/vertex_buffer.hpp"
#include "supple/triangle_intersection.hpp"

namespace supple {

/// The surface of one object at rest, by the user's numbers. `triangle` has the vertices in the user's order;
/// `corners` has them in this order or with the last two exchanged, so that solids face outwards and mirrored
/// surfaces keep their sides.
struct SurfaceView {
  const ObjectOctree* octree = nullptr;
  const VertexTriangles* around = nullptr;
  const VertexBuffer* positions = nullptr;
  Vec3d translation{};
  bool is_mirrored = false;
  std::span<const std::uint8_t> inward{};  ///< by triangle, without the mirror; empty when none faces inwards

  const Triangle& triangle(std::uint32_t id) const { return octree->user_triangle(id); }
  Vec3d position(std::uint32_t vertex) const {
    const Vec3d p = (*positions)[vertex];
    return translation == Vec3d{} ? p : p + translation;
  }
  TrianglePoints corners(std::uint32_t id) const {
    Triangle vertices = triangle(id);
    if (is_mirrored != (!inward.empty() && inward[id] != 0)) std::swap(vertices[1], vertices[2]);
    return {position(vertices[0]), position(vertices[1]), position(vertices[2])};
  }
};

}  // namespace supple
