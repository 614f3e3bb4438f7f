#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "octree/vertex_buffer.hpp"
#include "world/world.hpp"

namespace supple {

/// The data of an object that passes over elements read, indexed as in its `SurfaceElements`. For an object
/// at rest, `start` and `end` are equal. Only an object at rest has a translation in its view.
struct MovingObject {
  ObjectId id;
  OctreeView view;
  const VertexBuffer* start = nullptr;
  const VertexBuffer* end = nullptr;
  std::span<const std::uint32_t> triangle_ids, vertex_ids;  ///< the user's ids
  /// Faces with ids from here on are edges and points of no triangle, with the last corner repeated.
  std::uint32_t face_count = 0;
  std::span<const std::uint8_t> is_point;  ///< by the user's vertex: whether it is such a point; may be empty
  VertexGroups groups;
  double margin = 0, min_separation = 0;
  const VertexWays* ways = nullptr;  ///< for safe steps
};

/// Lists all slots of a world, with the elements on the way or at its end.
void list_moving_objects(const World& world, MovingShape::Part part, std::vector<MovingObject>& objects);

}  // namespace supple
