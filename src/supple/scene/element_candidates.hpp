#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "contact/impact_filter.hpp"
#include "contact/relative_motion.hpp"
#include "narrow_phase/traversal.hpp"
#include "octree/vertex_buffer.hpp"
#include "scene/vertex_groups.hpp"
#include "supple/contact.hpp"

namespace supple {

/// How far the vertices of an object move, without those that are not finite.
struct VertexWays {
  Vec3d mean;
  double farthest_from_mean = 0, longest = 0, largest_coordinate = 0;
};

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

/// How a pair of elements is reported.
struct ElementNames {
  ElementPairKind kind = ElementPairKind::vertex_face;
  std::array<std::uint32_t, 2> a{}, b{};
  bool is_turned = false;  ///< the first element of the motion is that of b
};

/// Nothing for a pair of points that is reported as another pair. `vertices` are those of the pair, with
/// edges in the order of their user's ids.
std::optional<ElementNames> names_of(ElementPairKind kind, ElementPair pair,
                                     const std::array<std::uint32_t, 4>& vertices, const MovingObject& a,
                                     const MovingObject& b);

/// Whether the vertex groups let two elements touch.
bool may_touch_by_groups(const std::array<const MovingObject*, 4>& objects,
                         const std::array<std::uint32_t, 4>& vertices, bool are_edges);

/// The four vertices of a pair of elements as `VertexFaceMotion` or `EdgeEdgeMotion` orders them.
inline std::array<std::uint32_t, 4> vertices_of(ElementPairKind kind, ElementPair pair, const MovingObject& a,
                                                const MovingObject& b) {
  switch (kind) {
    case ElementPairKind::vertex_face: {
      const Triangle& face = b.view.moving.face_ids[pair.b];
      return {pair.a, face[0], face[1], face[2]};
    }
    case ElementPairKind::face_vertex: {
      const Triangle& face = a.view.moving.face_ids[pair.a];
      return {pair.b, face[0], face[1], face[2]};
    }
    default: {
      const Edge& first = a.view.moving.edge_ids[pair.a];
      const Edge& second = b.view.moving.edge_ids[pair.b];
      return {first[0], first[1], second[0], second[1]};
    }
  }
}

/// The objects of these vertices.
inline std::array<const MovingObject*, 4> objects_of(ElementPairKind kind, const MovingObject& a,
                                                     const MovingObject& b) {
  if (kind == ElementPairKind::vertex_face) return {&a, &b, &b, &b};
  if (kind == ElementPairKind::face_vertex) return {&b, &a, &a, &a};
  return {&a, &a, &b, &b};
}

inline Vec3d placed(const Vec3d& position, const MovingObject& object) {
  return object.view.translation == Vec3d{} ? position : position + object.view.translation;
}

void set_motion(bool are_edges, const std::array<const MovingObject*, 4>& objects,
                const std::array<std::uint32_t, 4>& vertices, ElementMotion& motion);

/// Fills a block with the motions of pairs from time 0 to `latest`. Differences of translated positions, and
/// of a float and a double, are rounded to double and then to float; others are rounded once.
void fill(const std::array<const MovingObject*, 4>& objects,
          std::span<const std::array<std::uint32_t, 4>> vertices, bool are_edges, float latest,
          RelativeMotionBlock& block);

}  // namespace supple
