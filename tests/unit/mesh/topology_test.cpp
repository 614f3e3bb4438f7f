#include "supple/topology.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "unit/mesh/mesh_files.hpp"

namespace supple {
namespace {

MeshTopology topology_of(std::size_t vertices, std::vector<Triangle> triangles) {
  TriangleMesh mesh;
  mesh.positions.resize(vertices);
  mesh.triangles = std::move(triangles);
  return compute_topology(mesh);
}

const std::vector<Triangle> tetrahedron = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};

TEST(Topology, Empty) {
  const MeshTopology topology = topology_of(0, {});
  EXPECT_EQ(topology.edges, 0u);
  EXPECT_EQ(topology.components, 0u);
  EXPECT_EQ(topology.euler_characteristic, 0);
  EXPECT_FALSE(topology.closed());
}

TEST(Topology, OneTriangleAndUnusedVertices) {
  const MeshTopology topology = topology_of(5, {{1, 4, 2}});
  EXPECT_EQ(topology.vertices, 5u);
  EXPECT_EQ(topology.unused_vertices, 2u);
  EXPECT_EQ(topology.edges, 3u);
  EXPECT_EQ(topology.boundary_edges, 3u);
  EXPECT_EQ(topology.components, 1u);
  EXPECT_EQ(topology.euler_characteristic, 1);
  EXPECT_FALSE(topology.closed());
}

TEST(Topology, Tetrahedron) {
  const MeshTopology topology = topology_of(4, tetrahedron);
  EXPECT_EQ(topology.edges, 6u);
  EXPECT_EQ(topology.boundary_edges, 0u);
  EXPECT_EQ(topology.non_manifold_edges, 0u);
  EXPECT_EQ(topology.euler_characteristic, 2);
  EXPECT_TRUE(topology.closed());
}

TEST(Topology, DegenerateTrianglesChangeNothingElse) {
  std::vector<Triangle> triangles = tetrahedron;
  triangles.insert(triangles.end(), {{0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {3, 3, 3}, {4, 4, 0}});
  const MeshTopology topology = topology_of(5, triangles);
  EXPECT_EQ(topology.triangles, 9u);
  EXPECT_EQ(topology.degenerate_triangles, 5u);
  EXPECT_EQ(topology.unused_vertices, 1u);
  EXPECT_EQ(topology.edges, 6u);
  EXPECT_EQ(topology.euler_characteristic, 2);
  EXPECT_TRUE(topology.closed());
}

TEST(Topology, EdgesOfMoreThanTwoTriangles) {
  const MeshTopology topology = topology_of(5, {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}});
  EXPECT_EQ(topology.edges, 7u);
  EXPECT_EQ(topology.boundary_edges, 6u);
  EXPECT_EQ(topology.non_manifold_edges, 1u);
  EXPECT_EQ(topology.components, 1u);
  // Two faces that traverse their common side in the same direction still share one edge.
  EXPECT_EQ(topology_of(4, {{0, 1, 2}, {0, 1, 3}}).edges, 5u);
}

TEST(Topology, PiecesShareVertices) {
  EXPECT_EQ(topology_of(6, {{0, 1, 2}, {3, 4, 5}}).components, 2u);
  EXPECT_EQ(topology_of(5, {{0, 1, 2}, {2, 3, 4}}).components, 1u);
  EXPECT_EQ(topology_of(9, {{0, 1, 2}, {6, 7, 8}, {3, 4, 5}, {8, 3, 0}}).components, 1u);
}

TEST(Topology, NamesAVertexThatIsNotThere) {
  EXPECT_EQ(error_of([] {
              topology_of(2, {{0, 1, 2}});
            }),
            "mesh '': triangle 0 uses vertex 2; the mesh has 2 vertices, counted from 0");
}

}  // namespace
}  // namespace supple
