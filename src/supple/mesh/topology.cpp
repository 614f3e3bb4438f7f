#include "supple/topology.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "mesh/vertex_sets.hpp"
#include "mesh/vertex_welder.hpp"

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
    if ((end - begin) % 2 != 0) ++topology.odd_edges;
    if (end - begin > 2) ++topology.non_manifold_edges;
  }
}

/// Counts the pairs of equal keys.
std::uint64_t count_equal_pairs(std::vector<Triangle>& keys) {
  std::sort(keys.begin(), keys.end());
  std::uint64_t pairs = 0;
  for (std::size_t begin = 0, end = 0; begin < keys.size(); begin = end) {
    while (end < keys.size() && keys[end] == keys[begin]) ++end;
    pairs += std::uint64_t{end - begin} * (end - begin - 1) / 2;
  }
  return pairs;
}

std::string counted(std::uint64_t count, const char* noun) {
  return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
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

std::string describe_surface(const MeshTopology& topology) {
  if (topology.edges == 0) return "no triangles";
  std::string text = topology.closed() ? "closed" : "open";
  if (topology.boundary_edges > 0) text += ", " + counted(topology.boundary_edges, "boundary edge");
  if (const std::uint64_t others = topology.odd_edges - topology.boundary_edges; others > 0)
    text += ", " + counted(others, "edge") + " of another odd number of triangles";
  if (topology.non_manifold_edges > 0)
    text += ", " + counted(topology.non_manifold_edges, "non-manifold edge");
  return text;
}

std::vector<std::uint32_t> vertices_at_same_position(PositionsView positions) {
  VertexWelder welder;
  std::vector<std::uint32_t> first_vertices, same(positions.size());
  for (std::uint32_t v = 0; v < same.size(); ++v) {
    const std::uint32_t point = welder.id_of(positions[v]);
    if (point == first_vertices.size()) first_vertices.push_back(v);
    same[v] = first_vertices[point];
  }
  return same;
}

TriangleMesh welded(TriangleMesh mesh) {
  const std::vector<std::uint32_t> same = vertices_at_same_position(mesh.positions);
  for (Triangle& triangle : mesh.triangles) {
    for (std::uint32_t& vertex : triangle) vertex = same[vertex];
  }
  // An edge whose ends are welded is a point.
  std::erase_if(mesh.edges, [&](std::array<std::uint32_t, 2>& edge) {
    for (std::uint32_t& vertex : edge) vertex = same[vertex];
    if (edge[0] == edge[1]) mesh.points.push_back(edge[0]);
    return edge[0] == edge[1];
  });
  for (std::uint32_t& point : mesh.points) point = same[point];
  return mesh;
}

bool is_open_at_seams(const TriangleMesh& mesh) {
  const std::uint64_t open = compute_topology(mesh).odd_edges;
  return open > 0 && 2 * compute_topology(welded(mesh)).odd_edges < open;
}

std::string advice_for_open_surface(const TriangleMesh& mesh) {
  return is_open_at_seams(mesh)
             ? "most of its open edges are seams between vertices at equal positions, so weld "
               "them (--weld, ObjectOptions::weld)"
             : "close the holes";
}

/// Each pair has one common set of vertices, of one to three. Of its nonempty subsets, one more have an odd
/// number of vertices than an even one.
std::uint64_t count_neighbour_pairs(std::span<const Triangle> triangles) {
  constexpr std::uint32_t none = ~std::uint32_t{0};
  std::array<std::vector<Triangle>, 3> subsets;  // by size
  for (Triangle triangle : triangles) {
    std::sort(triangle.begin(), triangle.end());
    const auto end = std::unique(triangle.begin(), triangle.end());
    const auto count = static_cast<unsigned>(end - triangle.begin());
    for (unsigned members = 1; members < 1u << count; ++members) {
      Triangle subset{none, none, none};
      std::size_t size = 0;
      for (unsigned i = 0; i < count; ++i) {
        if ((members >> i & 1) != 0) subset[size++] = triangle[i];
      }
      subsets[size - 1].push_back(subset);
    }
  }
  return count_equal_pairs(subsets[0]) - count_equal_pairs(subsets[1]) + count_equal_pairs(subsets[2]);
}

}  // namespace supple
