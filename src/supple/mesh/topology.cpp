#include "supple/topology.hpp"

#include <algorithm>
#include <vector>

#include "mesh/vertex_sets.hpp"

namespace supple {
namespace {

bool is_degenerate(const Triangle& triangle) {
  return triangle[0] == triangle[1] || triangle[1] == triangle[2] || triangle[2] == triangle[0];
}

// Stores both ends in one number, the smaller first, so that equal edges are equal numbers.
std::uint64_t edge_key(std::uint32_t a, std::uint32_t b) {
  return std::uint64_t{std::min(a, b)} << 32 | std::max(a, b);
}

void count_edges(std::vector<std::uint64_t> edges, MeshTopology& topology) {
  std::sort(edges.begin(), edges.end());
  for (std::size_t begin = 0, end = 0; begin < edges.size(); begin = end) {
    while (end < edges.size() && edges[end] == edges[begin]) ++end;
    ++topology.edges;
    if (end - begin == 1) ++topology.boundary_edges;
    if (end - begin > 2) ++topology.non_manifold_edges;
  }
}

}  // namespace

MeshTopology compute_topology(const TriangleMesh& mesh) {
  check_mesh(mesh);
  MeshTopology topology;
  topology.vertices = mesh.positions.size();
  topology.triangles = mesh.triangles.size();

  VertexSets sets(mesh.positions.size());
  std::vector<bool> used(mesh.positions.size());
  std::vector<std::uint64_t> edges;
  edges.reserve(3 * mesh.triangles.size());
  for (const Triangle& triangle : mesh.triangles) {
    if (is_degenerate(triangle)) {
      ++topology.degenerate_triangles;
      continue;
    }
    for (int corner = 0; corner < 3; ++corner) {
      const std::uint32_t a = triangle[corner], b = triangle[(corner + 1) % 3];
      used[a] = true;
      sets.join(a, b);
      edges.push_back(edge_key(a, b));
    }
  }
  count_edges(std::move(edges), topology);

  std::int64_t used_vertices = 0;
  for (std::uint32_t vertex = 0; vertex < used.size(); ++vertex) {
    if (!used[vertex]) continue;
    ++used_vertices;
    if (sets.root(vertex) == vertex) ++topology.components;
  }
  topology.unused_vertices = topology.vertices - static_cast<std::uint64_t>(used_vertices);
  topology.euler_characteristic =
      used_vertices - static_cast<std::int64_t>(topology.edges) +
      static_cast<std::int64_t>(topology.triangles - topology.degenerate_triangles);
  return topology;
}

}  // namespace supple
