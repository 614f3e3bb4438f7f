#include "verify/brute_force_elements.hpp"

#include <tuple>

#include "core/sort_once.hpp"
#include "geometry/vector.hpp"

namespace supple {
namespace {

/// Appends the element unless a coordinate is not finite.
void append(const PlainMovingObject& object, std::array<std::uint32_t, 3> vertices,
            std::array<std::uint32_t, 2> name, FeatureKind kind, std::vector<BoxedElement>& elements) {
  BoxedElement element{vertices, name, kind, {}, {}, {}, {}};
  const auto corner = [&](const std::vector<Vec3d>& positions, std::size_t i) {
    return positions[vertices[i]];
  };
  for (std::size_t i = 0; i < 3; ++i) {
    if (!is_finite(corner(object.start, i)) || !is_finite(corner(object.end, i))) return;
  }
  const auto set_box = [&](const std::vector<Vec3d>& positions, double* min, double* max) {
    for (int axis = 0; axis < 3; ++axis) {
      std::tie(min[axis], max[axis]) =
          std::minmax({corner(positions, 0)[axis], corner(positions, 1)[axis], corner(positions, 2)[axis]});
    }
  };
  set_box(object.start, element.start_min, element.start_max);
  set_box(object.end, element.end_min, element.end_max);
  elements.push_back(element);
}

}  // namespace

std::vector<BoxedElement> boxed_faces(const PlainMovingObject& object) {
  std::vector<BoxedElement> faces;
  for (std::uint32_t f = 0; f < object.face_count; ++f)
    append(object, object.triangles[f], {f, f}, FeatureKind::face, faces);
  return faces;
}

BoxedElements boxed_elements(const PlainMovingObject& object) {
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
  for (int axis = 0; axis < 3; ++axis) {
    if (p.start_min[axis] - q.start_max[axis] > least && p.end_min[axis] - q.end_max[axis] > least)
      return true;
    if (q.start_min[axis] - p.start_max[axis] > least && q.end_min[axis] - p.end_max[axis] > least)
      return true;
  }
  return false;
}

bool share_vertex(const BoxedElement& p, const BoxedElement& q) {
  return std::any_of(p.vertices.begin(), p.vertices.end(), [&](std::uint32_t vertex) {
    return std::find(q.vertices.begin(), q.vertices.end(), vertex) != q.vertices.end();
  });
}

Sweep::Sweep(std::vector<BoxedElement> unsorted) : elements(std::move(unsorted)) {
  std::sort(elements.begin(), elements.end(), [](const BoxedElement& p, const BoxedElement& q) {
    return std::tuple(p.sweep_min(), p.name) < std::tuple(q.sweep_min(), q.name);
  });
  for (const BoxedElement& q : elements)
    reach.push_back(reach.empty() ? q.sweep_max() : std::max(reach.back(), q.sweep_max()));
}

}  // namespace supple
