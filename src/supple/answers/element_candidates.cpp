#include "answers/element_candidates.hpp"

#include <type_traits>

namespace supple {
namespace {

template <class Scalar>
void set_motions_of(const std::array<const MovingObject*, 4>& objects,
                    std::span<const std::array<std::uint32_t, 4>> vertices, bool are_edges, float latest,
                    RelativeMotionBlock& block) {
  const auto paths = [&](std::size_t i) -> VertexPaths<Scalar> {
    if constexpr (std::is_same_v<Scalar, float>)
      return {objects[i]->start->floats(), objects[i]->end->floats()};
    else
      return {objects[i]->start->doubles(), objects[i]->end->doubles()};
  };
  set_motions({paths(0), paths(1), paths(2), paths(3)}, vertices.data(), vertices.size(), are_edges, latest,
              block);
}

}  // namespace

std::optional<ElementNames> names_of(ElementPairKind kind, ElementPair pair,
                                     const std::array<std::uint32_t, 4>& vertices, const MovingObject& a,
                                     const MovingObject& b) {
  using Kind = ElementPairKind;
  if (kind == Kind::edge_edge) {
    return ElementNames{kind,
                        {a.vertex_ids[vertices[0]], a.vertex_ids[vertices[1]]},
                        {b.vertex_ids[vertices[2]], b.vertex_ids[vertices[3]]}};
  }
  const bool vertex_first = kind == Kind::vertex_face;
  const MovingObject &of_vertex = vertex_first ? a : b, &of_face = vertex_first ? b : a;
  const std::uint32_t vertex = of_vertex.vertex_ids[vertices[0]];
  const std::uint32_t face = of_face.triangle_ids[vertex_first ? pair.b : pair.a];
  const std::array<std::uint32_t, 2> at_vertex{vertex, vertex};
  std::array<std::uint32_t, 2> at_face{face, face};
  if (face >= of_face.face_count) {
    at_face = {of_face.vertex_ids[vertices[1]], of_face.vertex_ids[vertices[2]]};
    const bool is_point = at_face[0] == at_face[1];
    kind = is_point ? Kind::vertex_vertex : vertex_first ? Kind::vertex_edge : Kind::edge_vertex;
    const bool is_pair_of_points = is_point && !of_vertex.is_point.empty() && of_vertex.is_point[vertex] != 0;
    if (&a == &b && is_point && at_face < at_vertex) {
      if (is_pair_of_points) return std::nullopt;
      return ElementNames{kind, at_face, at_vertex, true};
    }
    if (is_pair_of_points && !vertex_first) return std::nullopt;
  }
  if (vertex_first) return ElementNames{kind, at_vertex, at_face};
  return ElementNames{kind, at_face, at_vertex, true};
}

bool may_touch_by_groups(const std::array<const MovingObject*, 4>& objects,
                         const std::array<std::uint32_t, 4>& vertices, bool are_edges) {
  const MovingObject &first = *objects[0], &second = *objects[3];
  if (first.groups.empty() && second.groups.empty()) return true;
  std::array<std::uint32_t, 4> ids;
  for (std::size_t i = 0; i < 4; ++i) ids[i] = objects[i]->vertex_ids[vertices[i]];
  const std::size_t count = are_edges ? 2 : 1;
  return may_touch_by_groups(first.groups, std::span(ids).first(count), second.groups,
                             std::span(ids).subspan(count));
}

void set_motion(bool are_edges, const std::array<const MovingObject*, 4>& objects,
                const std::array<std::uint32_t, 4>& vertices, ElementMotion& motion) {
  motion.are_edges = are_edges;
  for (std::size_t i = 0; i < 4; ++i) {
    motion.start[i] = placed((*objects[i]->start)[vertices[i]], *objects[i]);
    motion.end[i] = placed((*objects[i]->end)[vertices[i]], *objects[i]);
  }
}

void fill(const std::array<const MovingObject*, 4>& objects,
          std::span<const std::array<std::uint32_t, 4>> vertices, bool are_edges, float latest,
          RelativeMotionBlock& block) {
  const MovingObject &first = *objects.front(), &last = *objects.back();
  const bool is_translated = first.view.translation != Vec3d{} || last.view.translation != Vec3d{};
  if (!is_translated && first.end->is_double() == last.end->is_double()) {
    const auto set = first.end->is_double() ? set_motions_of<double> : set_motions_of<float>;
    return set(objects, vertices, are_edges, latest, block);
  }
  for (std::size_t k = 0; k < vertices.size(); ++k) {
    ElementMotion motion;
    set_motion(are_edges, objects, vertices[k], motion);
    block.set(k, part_of_motion(relative_motion(motion), latest));
  }
}

}  // namespace supple
