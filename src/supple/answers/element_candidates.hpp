#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "answers/moving_objects.hpp"
#include "contact/impact/impact_filter.hpp"
#include "contact/impact/relative_motion.hpp"
#include "narrow_phase/traversal.hpp"
#include "octree/vertex_buffer.hpp"
#include "supple/contact.hpp"

namespace supple {

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
