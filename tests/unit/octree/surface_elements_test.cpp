#include "octree/surface_elements.hpp"

#include <gtest/gtest.h>

#include <set>

#include "inspect/validation.hpp"
#include "octree/object_octree.hpp"
#include "support/soups.hpp"

namespace supple::surface_elements_test {

ObjectOctree octree_of(const TriangleMesh& mesh, std::uint32_t leaf_size = 8) {
  return {
      mesh.positions, mesh.triangles, {.leaf_size = leaf_size}, BoundingVolume::aabb, SphereFit::vertices};
}

TEST(SurfaceElements, OfNothing) {
  const ObjectOctree octree = octree_of({});
  const SurfaceElements elements(octree);
  EXPECT_EQ(fault_of(elements, octree), "");
  EXPECT_EQ(elements.vertex_count(), 0u);
  EXPECT_EQ(elements.edge_count(), 0u);
}

TEST(SurfaceElements, EdgesAreTheDistinctPairsOfVertices) {
  // Two triangles with a common side (one twice), a repeated id, a single point and two unused vertices.
  const TriangleMesh mesh{"", std::vector<Vec3d>(8), {{0, 1, 2}, {2, 1, 3}, {0, 1, 2}, {4, 5, 4}, {6, 6, 6}}};
  const ObjectOctree octree = octree_of(mesh);
  const SurfaceElements elements(octree);
  EXPECT_EQ(fault_of(elements, octree), "");
  EXPECT_EQ(elements.vertex_count(), 7u);
  std::set<Edge> found;
  for (const Edge& edge : elements.edges()) {
    const auto [p, q] = std::minmax(elements.vertex_ids()[edge[0]], elements.vertex_ids()[edge[1]]);
    found.insert({p, q});
  }
  EXPECT_EQ(found, (std::set<Edge>{{0, 1}, {1, 2}, {0, 2}, {2, 3}, {1, 3}, {4, 5}}));
  EXPECT_EQ(elements.edge_count(), found.size());
}

TEST(SurfaceElements, FormRangesOverAnyMesh) {
  for (const std::uint32_t leaf_size : {1u, 4u, 16u}) {
    const TriangleMesh sheet = crumpled_sheet(30, 20, 0.02, 3);
    const ObjectOctree octree = octree_of(sheet, leaf_size);
    const SurfaceElements elements(octree);
    EXPECT_EQ(fault_of(elements, octree), "");
    EXPECT_EQ(elements.edge_count(), 30u * 21 + 31 * 20 + 30 * 20);
    EXPECT_EQ(elements.vertices_of(0, static_cast<std::uint32_t>(sheet.triangles.size())).size(), 31u * 21);
  }
  RandomNumbers random(5);
  for (int round = 0; round < 20; ++round) {
    TriangleMesh mesh;
    const std::uint32_t vertices = 1 + random.below(60);
    for (std::uint32_t v = 0; v < vertices; ++v) mesh.positions.push_back(random.vector(1));
    for (std::uint32_t t = random.below(200); t > 0; --t) {
      mesh.triangles.push_back({random.below(vertices), random.below(vertices), random.below(vertices)});
    }
    const ObjectOctree octree = octree_of(mesh, 1 + random.below(9));
    EXPECT_EQ(fault_of(SurfaceElements(octree), octree), "");
  }
}

TEST(SurfaceElements, OfAnotherOctreeAreWrong) {
  const ObjectOctree octree = octree_of(crumpled_sheet(3, 3, 0.02, 3));
  const ObjectOctree other = octree_of(random_soup(18, 1, 0.1, 1));
  EXPECT_NE(fault_of(SurfaceElements(octree), other), "");
}

}  // namespace supple::surface_elements_test
