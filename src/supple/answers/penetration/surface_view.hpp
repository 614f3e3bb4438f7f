#pragma once

#include <span>

#include "geometry/vector.hpp"
#include "mesh/vertex_triangles.hpp"
#include "octree/object_octree.hpp"
#include "octree/vertex_buffer.hpp"
#include "supple/triangle_intersection.hpp"

namespace supple {

/// The surface of one object at rest, by the user's numbers.
struct SurfaceView {
  const ObjectOctree* octree = nullptr;
  const VertexTriangles* around = nullptr;
  const VertexBuffer* positions = nullptr;
  Vec3d translation{};

  const Triangle& triangle(std::uint32_t id) const { return octree->user_triangle(id); }
  Vec3d position(std::uint32_t vertex) const {
    const Vec3d p = (*positions)[vertex];
    return translation == Vec3d{} ? p : p + translation;
  }
  TrianglePoints corners(std::uint32_t id) const {
    const Triangle& vertices = triangle(id);
    return {position(vertices[0]), position(vertices[1]), position(vertices[2])};
  }
};

}  // namespace supple
