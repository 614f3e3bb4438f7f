#include "supple/topology.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>
#include <vector>

#include "support/random.hpp"
#include "unit/files/mesh_files.hpp"

namespace supple::topology_test {

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

TEST(Topology, OddEdgesLeaveTheSurfaceOpen) {
  // Three triangles at one edge: no boundary there, but a side of a point is not defined.
  MeshTopology topology = topology_of(5, {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}});
  EXPECT_EQ(topology.boundary_edges, 6u);
  EXPECT_EQ(topology.odd_edges, 7u);
  EXPECT_FALSE(topology.closed());
  EXPECT_EQ(describe_surface(topology),
            "open, 6 boundary edges, 1 edge of another odd number of triangles, 1 non-manifold edge");
  // A tetrahedron and a second one on its edge 0 1: that edge has four triangles.
  std::vector<Triangle> two = tetrahedron;
  two.insert(two.end(), {{0, 1, 4}, {0, 5, 1}, {1, 5, 4}, {0, 4, 5}});
  topology = topology_of(6, two);
  EXPECT_TRUE(topology.closed());
  EXPECT_EQ(describe_surface(topology), "closed, 1 non-manifold edge");
  EXPECT_EQ(describe_surface(topology_of(3, {{0, 1, 2}})), "open, 3 boundary edges");
  EXPECT_EQ(describe_surface(topology_of(3, {})), "no triangles");
}

/// Each triangle gets its own copies of its vertices.
TriangleMesh split(const TriangleMesh& mesh) {
  TriangleMesh soup;
  for (const Triangle& triangle : mesh.triangles) {
    const auto first = static_cast<std::uint32_t>(soup.positions.size());
    for (const std::uint32_t vertex : triangle) soup.positions.push_back(mesh.positions[vertex]);
    soup.triangles.push_back({first, first + 1, first + 2});
  }
  return soup;
}

TEST(Topology, Seams) {
  TriangleMesh mesh{"", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, tetrahedron};
  EXPECT_FALSE(is_open_at_seams(mesh));
  const TriangleMesh soup = split(mesh);
  EXPECT_EQ(compute_topology(soup).odd_edges, 12u);
  EXPECT_TRUE(is_open_at_seams(soup));
  EXPECT_TRUE(compute_topology(welded(soup)).closed());
  EXPECT_EQ(welded(soup).positions.size(), 12u);
  mesh.triangles.pop_back();
  EXPECT_FALSE(is_open_at_seams(mesh)) << "a hole is no seam";
  EXPECT_TRUE(is_open_at_seams(split(mesh))) << "six of nine edges are closed by welding";
  TriangleMesh not_finite = split(mesh);
  for (Vec3d& p : not_finite.positions) p.x = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(is_open_at_seams(not_finite)) << "NaN equals nothing";
}

TEST(Topology, WeldedEdgesBecomePoints) {
  const TriangleMesh mesh{"", {{0, 0, 0}, {0, 0, 0}, {1, 0, 0}}, {}, {{0, 1}, {1, 2}}, {1}};
  const TriangleMesh one = welded(mesh);
  EXPECT_EQ(one.edges, (std::vector<std::array<std::uint32_t, 2>>{{0, 2}}));
  EXPECT_EQ(one.points, (std::vector<std::uint32_t>{0, 0}));
}

TEST(Topology, NeighbourPairs) {
  EXPECT_EQ(count_neighbour_pairs({}), 0u);
  EXPECT_EQ(count_neighbour_pairs(tetrahedron), 6u);
  // Random triangles, some with repeated or equal vertices, against all pairs.
  RandomNumbers random(3);
  for (int round = 0; round < 200; ++round) {
    std::vector<Triangle> triangles(1 + random.below(30));
    for (Triangle& triangle : triangles) {
      for (std::uint32_t& vertex : triangle) vertex = static_cast<std::uint32_t>(random.below(12));
    }
    std::uint64_t expected = 0;
    for (std::size_t i = 0; i < triangles.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j)
        expected += std::ranges::find_first_of(triangles[i], triangles[j]) != triangles[i].end();
    }
    ASSERT_EQ(count_neighbour_pairs(triangles), expected);
  }
}

}  // namespace supple::topology_test
