// Tests `ObjectOctree::rebuilt` with ordinary and degenerate positions.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "inspect/octree_statistics.hpp"
#include "inspect/validation.hpp"
#include "octree/object_octree.hpp"
#include "octree/surface_elements.hpp"
#include "support/soups.hpp"

namespace supple::rebuild_test {

/// An octree and the positions of its object, in the user's order.
struct Tree {
  Tree(const TriangleMesh& mesh_in, const ObjectOctreeOptions& options, BoundingVolume volume)
      : mesh(mesh_in), octree(mesh.positions, mesh.triangles, options, volume, SphereFit::vertices) {
    place(mesh.positions);
  }

  void place(const std::vector<Vec3d>& positions) {
    mesh.positions = positions;
    vertices.assign(positions, parallel);
    refit();
  }
  void refit() {
    inert.assign(octree.triangles().size(), 0);
    for (std::size_t t = 0; t < inert.size(); ++t) {
      for (const std::uint32_t v : octree.triangles()[t]) {
        if (!std::isfinite(vertices[v].x)) inert[t] = 1;
      }
    }
    if (std::count(inert.begin(), inert.end(), 1) == 0) inert.clear();
    octree.refit(vertices, inert, parallel);
  }
  void rebuild() {
    octree = octree.rebuilt(vertices.view());
    refit();
  }
  void expect_valid() const {
    EXPECT_EQ(fault_of(octree, vertices, inert), "");
    for (std::size_t t = 0; t < octree.triangles().size(); ++t) {
      for (std::size_t corner = 0; corner < 3; ++corner) {
        const std::uint32_t user = mesh.triangles[octree.triangle_ids()[t]][corner];
        ASSERT_EQ(user, octree.triangles()[t][corner]);
      }
    }
    EXPECT_EQ(fault_of(SurfaceElements(octree), octree), "");
  }

  TriangleMesh mesh;
  Parallel parallel{1};
  ObjectOctree octree;
  VertexBuffer vertices;
  std::vector<std::uint8_t> inert;
};

/// Positions that are difficult for octrees, selected by number.
std::vector<Vec3d> deformed(std::vector<Vec3d> positions, std::uint32_t way, RandomNumbers& random) {
  switch (way % 6) {
    case 0:
      for (Vec3d& p : positions) p = p + random.vector(1);
      break;
    case 1:
      for (Vec3d& p : positions) p = {1, 2, 3};
      break;
    case 2:
      for (Vec3d& p : positions) p = p * 1e300;
      break;
    case 3:
      for (Vec3d& p : positions) {
        if (random.below(10) == 0) p.x = std::numeric_limits<double>::quiet_NaN();
      }
      break;
    case 4:
      for (Vec3d& p : positions) p = {std::nearbyint(p.x), std::nearbyint(3 * p.y), 0};
      break;
    default:
      for (std::size_t i = positions.size(); i-- > 1;) {
        std::swap(positions[i], positions[random.below(static_cast<std::uint32_t>(i + 1))]);
      }
  }
  return positions;
}

TEST(Rebuild, OfAnyTreeIsValid) {
  RandomNumbers random(1);
  for (std::uint32_t count = 1; count <= 70; count += 1 + count / 8) {
    const TriangleMesh mesh =
        count % 2 == 0 ? random_soup(count, 1, 0.3, count) : crumpled_sheet(count, 2, 0.1, count);
    for (const auto& [arity, build] : {std::pair{2u, ObjectOctreeBuild::regular},
                                       {4u, ObjectOctreeBuild::bottom_up},
                                       {8u, ObjectOctreeBuild::balanced},
                                       {8u, ObjectOctreeBuild::bottom_up}}) {
      SCOPED_TRACE(std::to_string(count) + " triangles, arity " + std::to_string(arity));
      ObjectOctreeOptions options;
      options.leaf_size = 1 + random.below(5);
      options.arity = arity;
      options.build = build;
      options.max_level = random.below(4) == 0 ? 2 : 16;
      const auto volume = count % 3 == 0 ? BoundingVolume::sphere : BoundingVolume::aabb;
      Tree tree(mesh, options, volume);
      for (std::uint32_t way = 0; way < 8; ++way) {
        tree.place(deformed(mesh.positions, way, random));
        tree.rebuild();
        tree.expect_valid();
        const OctreeStatistics statistics = octree_statistics(tree.octree);
        EXPECT_LE(statistics.depth, options.max_level * 3 / (arity == 8 ? 3 : arity == 4 ? 2 : 1));
        if (HasFailure()) return;
      }
    }
  }
}

TEST(Rebuild, GivesTheTreeBuiltFromThePositions) {
  RandomNumbers random(2);
  const TriangleMesh rest = random_soup(3000, 1, 0.05, 3);
  for (const auto build :
       {ObjectOctreeBuild::balanced, ObjectOctreeBuild::regular, ObjectOctreeBuild::bottom_up}) {
    const ObjectOctreeOptions options{.build = build};
    Tree tree(rest, options, BoundingVolume::aabb);
    tree.place(deformed(rest.positions, 0, random));
    tree.rebuild();
    tree.expect_valid();
    const Tree fresh(tree.mesh, options, BoundingVolume::aabb);
    ASSERT_EQ(tree.octree.nodes().size(), fresh.octree.nodes().size());
    EXPECT_TRUE(std::equal(tree.octree.triangle_ids().begin(), tree.octree.triangle_ids().end(),
                           fresh.octree.triangle_ids().begin()));
    EXPECT_EQ(octree_statistics(tree.octree).leaves_by_level,
              octree_statistics(fresh.octree).leaves_by_level);
  }
}

}  // namespace supple::rebuild_test
