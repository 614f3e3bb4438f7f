#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "mesh/vertex_sets.hpp"
#include "supple/topology.hpp"

namespace supple {
namespace {

constexpr std::uint32_t no_part = std::numeric_limits<std::uint32_t>::max();

/// Calls `visit(element)` for the vertices of each triangle, edge and point of a mesh.
template <class Visit>
void for_each_element(const TriangleMesh& mesh, const Visit& visit) {
  for (const Triangle& triangle : mesh.triangles) visit(triangle);
  for (const auto& edge : mesh.edges) visit(edge);
  for (const std::uint32_t point : mesh.points) visit(std::array{point});
}

/// The sets of vertices that elements connect, and vertices at the same position with `weld`.
VertexSets connected_vertices(const TriangleMesh& mesh, bool weld) {
  VertexSets sets(mesh.positions.size());
  for_each_element(mesh, [&](const auto& element) {
    for (const std::uint32_t vertex : element) sets.join(element[0], vertex);
  });
  if (weld) {
    const std::vector<std::uint32_t> same = vertices_at_same_position(mesh.positions);
    for (std::uint32_t v = 0; v < same.size(); ++v) sets.join(v, same[v]);
  }
  return sets;
}

}  // namespace

std::vector<MeshPart> split_into_parts(const TriangleMesh& mesh, bool weld) {
  check_mesh(mesh);
  VertexSets sets = connected_vertices(mesh, weld);
  std::vector<std::uint8_t> is_used(mesh.positions.size());
  for_each_element(mesh, [&](const auto& element) {
    for (const std::uint32_t vertex : element) is_used[vertex] = 1;
  });
  std::vector<MeshPart> parts;
  std::vector<std::uint32_t> part_of_root(mesh.positions.size(), no_part), id(mesh.positions.size());
  const auto part_of = [&](std::uint32_t vertex) -> MeshPart& {
    return parts[part_of_root[sets.root(vertex)]];
  };
  for (std::uint32_t v = 0; v < is_used.size(); ++v) {
    if (is_used[v] == 0) continue;
    std::uint32_t& number = part_of_root[sets.root(v)];
    if (number == no_part) {
      number = static_cast<std::uint32_t>(parts.size());
      parts.emplace_back().mesh.name = mesh.name;
    }
    MeshPart& part = parts[number];
    id[v] = static_cast<std::uint32_t>(part.vertices.size());
    part.vertices.push_back(v);
    part.mesh.positions.push_back(mesh.positions[v]);
  }
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& [v, w, x] = mesh.triangles[t];
    MeshPart& part = part_of(v);
    part.triangles.push_back(t);
    part.mesh.triangles.push_back({id[v], id[w], id[x]});
  }
  for (const auto& [v, w] : mesh.edges) part_of(v).mesh.edges.push_back({id[v], id[w]});
  for (const std::uint32_t v : mesh.points) part_of(v).mesh.points.push_back(id[v]);
  return parts;
}

}  // namespace supple
