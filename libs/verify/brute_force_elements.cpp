#include "verify/brute_force_elements.hpp"

#include <algorithm>
#include <limits>

#include "core/sort_once.hpp"
#include "geometry/vector.hpp"
#include "world/object/world_object.hpp"

namespace supple {
namespace {

/// Appends the element unless a coordinate is not finite.
void append(const PlainObject& object, std::array<std::uint32_t, 3> vertices,
            std::array<std::uint32_t, 2> name, FeatureKind kind, std::vector<BoxedElement>& elements) {
  const auto corners = [&](const std::vector<Vec3d>& at) {
    return std::array{at[vertices[0]], at[vertices[1]], at[vertices[2]]};
  };
  const std::array start = corners(object.start), end = corners(object.end);
  if (std::ranges::all_of(start, is_finite) && std::ranges::all_of(end, is_finite))
    elements.push_back({vertices, name, kind, exact_box(start), exact_box(end)});
}

}  // namespace

PlainObject plain_object(const WorldObject& object, bool at_rest) {
  const ObjectOctree& octree = object.octree();
  PlainObject plain{.groups = object.vertex_groups(),
                    .face_count = object.face_count(),
                    .neighbours = object.options.neighbours};
  const auto removed = static_cast<std::uint32_t>(octree.vertex_count());
  for (std::uint32_t t = 0; t < octree.id_count(); ++t) {
    plain.triangles.push_back(octree.has_triangle(t) ? octree.user_triangle(t)
                                                     : Triangle{removed, removed, removed});
  }
  for (std::uint32_t vertex = 0; vertex < octree.vertex_count(); ++vertex) {
    plain.end.push_back(object.placement().position(vertex));
    plain.start.push_back(at_rest ? plain.end.back() : object.placement().start_position(vertex));
  }
  if (octree.triangles().size() == octree.id_count()) return plain;
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  plain.removed_vertex = removed;
  for (auto* const positions : {&plain.start, &plain.end}) positions->push_back({nan, nan, nan});
  return plain;
}

std::vector<BoxedElement> boxed_faces(const PlainObject& object) {
  std::vector<BoxedElement> faces;
  for (std::uint32_t f = 0; f < object.face_count; ++f)
    append(object, object.triangles[f], {f, f}, FeatureKind::face, faces);
  return faces;
}

BoxedElements boxed_elements(const PlainObject& object) {
  std::vector<std::uint32_t> vertices;
  std::vector<std::array<std::uint32_t, 2>> edges;
  for (const Triangle& t : object.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      vertices.push_back(t[i]);
      const auto [low, high] = std::minmax(t[i], t[(i + 1) % 3]);
      if (low != high) edges.push_back({low, high});
    }
  }
  sort_once(vertices);
  sort_once(edges);
  BoxedElements elements;
  using enum FeatureKind;
  for (const std::uint32_t v : vertices) append(object, {v, v, v}, {v, v}, vertex, elements.vertices);
  for (const auto& [v, w] : edges) append(object, {v, w, w}, {v, w}, edge, elements.edges);
  elements.faces = boxed_faces(object);
  for (std::size_t f = object.face_count; f < object.triangles.size(); ++f) {
    const Triangle& extra = object.triangles[f];
    append(object, extra, {extra[0], extra[1]}, extra[0] == extra[1] ? vertex : edge, elements.faces);
  }
  return elements;
}

std::uint64_t element_pairs(const BoxedElements& a, const BoxedElements& b, bool same_object) {
  const std::uint64_t edges_a = a.edges.size(), edges_b = b.edges.size();
  const std::uint64_t vertex_face = a.vertices.size() * std::uint64_t{b.faces.size()};
  if (same_object) return vertex_face + edges_a * (edges_a - std::min<std::uint64_t>(edges_a, 1)) / 2;
  return vertex_face + a.faces.size() * std::uint64_t{b.vertices.size()} + edges_a * edges_b;
}

bool stay_apart(const BoxedElement& p, const BoxedElement& q, double separation) {
  const double least = separation * (1 + 0x1p-50);
  const auto is_beyond = [&](const BoxedElement& low, const BoxedElement& high, int axis) {
    return high.start.min[axis] - low.start.max[axis] > least &&
           high.end.min[axis] - low.end.max[axis] > least;
  };
  for (int axis = 0; axis < 3; ++axis) {
    if (is_beyond(p, q, axis) || is_beyond(q, p, axis)) return true;
  }
  return false;
}

bool share_vertex(const BoxedElement& p, const BoxedElement& q) {
  return std::any_of(p.vertices.begin(), p.vertices.end(), [&](std::uint32_t vertex) {
    return std::find(q.vertices.begin(), q.vertices.end(), vertex) != q.vertices.end();
  });
}

}  // namespace supple
