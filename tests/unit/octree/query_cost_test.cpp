#include "octree/build/query_cost.hpp"
#include "inspect/octree_statistics.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "octree/object_octree.hpp"
#include "support/instruction_sets.hpp"
#include "support/soups.hpp"

namespace supple::query_cost_test {

/// The octree of a triangle soup.
struct Tree {
  explicit Tree(const TriangleMesh& mesh, ObjectOctreeBuild build = ObjectOctreeBuild::balanced)
      : octree(mesh.positions, mesh.triangles, {.build = build}, BoundingVolume::aabb, SphereFit::vertices) {}

  /// The query cost after a refit to these positions.
  double cost(const std::vector<Vec3d>& positions, std::uint32_t threads = 1) {
    const Parallel parallel{threads};
    VertexBuffer vertices;
    vertices.assign(positions, parallel);
    octree.refit(vertices, {}, parallel);
    return query_cost(octree.nodes(), octree.boxes());
  }
  Tree rebuilt(const std::vector<Vec3d>& positions) const { return Tree(octree.rebuilt(positions)); }

  ObjectOctree octree;

 private:
  explicit Tree(ObjectOctree built) : octree(std::move(built)) {}
};

/// Moves each triangle rigidly by a random vector.
std::vector<Vec3d> mixed(const TriangleMesh& mesh, double distance) {
  RandomNumbers random(9);
  std::vector<Vec3d> positions = mesh.positions;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vec3d way = random.vector(distance);
    for (std::size_t corner = 0; corner < 3; ++corner) positions[3 * t + corner] += way;
  }
  return positions;
}

/// A refitted octree with leaves of one triangle.
ObjectOctree octree_of_single_triangles(const TriangleMesh& mesh, BoundingVolume volume) {
  ObjectOctree octree(mesh.positions, mesh.triangles, {.leaf_size = 1}, volume, SphereFit::vertices);
  const Parallel parallel{1};
  VertexBuffer vertices;
  vertices.assign(mesh.positions, parallel);
  octree.refit(vertices, {}, parallel);
  return octree;
}

TEST(QueryCost, IsTheSumOfSurfacesOfTheChildren) {
  // Two leaves with one triangle each: each costs a visit plus an eighth, times its share of the surface.
  const TriangleMesh mesh{
      "", {{0, 0, 0}, {1, 1, 0}, {0, 0, 1}, {3, 0, 0}, {4, 1, 0}, {3, 0, 1}}, {{0, 1, 2}, {3, 4, 5}}};
  const ObjectOctree octree = octree_of_single_triangles(mesh, BoundingVolume::aabb);
  EXPECT_EQ(query_cost(octree.nodes(), octree.boxes()), 2 * 1.125 * 3 / 9);
}

TEST(QueryCost, OfSpheresIsTheSumOfTheirSurfaces) {
  // Four leaves with one triangle each: half squares around (0, 0, 0) and (6, 0, 0). Their spheres have the
  // squared radius 1 + 1/4, that of the object 16.
  const TriangleMesh mesh{
      "",
      {{1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}, {7, 0, 0}, {6, 1, 0}, {5, 0, 0}, {6, -1, 0}},
      {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}}};
  const ObjectOctree octree = octree_of_single_triangles(mesh, BoundingVolume::sphere);
  EXPECT_NEAR(cost_of_volumes(octree), 4 * 1.125 * 1.25 / 16, 1e-6);
}

TEST(QueryCost, DoesNotDependOnPlaceAndScale) {
  const TriangleMesh mesh = random_soup(4000, 1, 0.02, 1);
  Tree tree(mesh);
  const double cost = tree.cost(mesh.positions);
  EXPECT_GT(cost, 1);
  for (const double scale : {0x1p-40, 0x1p40}) {
    std::vector<Vec3d> positions = mesh.positions;
    for (Vec3d& p : positions) p = p * scale;
    EXPECT_EQ(tree.cost(positions), cost);
  }
  std::vector<Vec3d> positions = mesh.positions;
  for (Vec3d& p : positions) p = p + Vec3d{3, -2, 1};
  EXPECT_NEAR(tree.cost(positions) / cost, 1, 1e-3);
}

TEST(QueryCost, GrowsWhenTrianglesMixAndFallsWithARebuild) {
  const TriangleMesh mesh = random_soup(4000, 1, 0.02, 2);
  Tree tree(mesh);
  const double built = tree.cost(mesh.positions);
  const std::vector<Vec3d> positions = mixed(mesh, 1);
  const double degraded = tree.cost(positions);
  EXPECT_GT(degraded, 3 * built);
  EXPECT_LT(tree.rebuilt(positions).cost(positions), degraded / 3);
}

TEST(QueryCost, IsUnknownWithoutASurfaceOrWithOneTooLarge) {
  const TriangleMesh mesh = random_soup(1000, 1, 0.02, 6);
  Tree tree(mesh);
  std::vector<Vec3d> positions(mesh.positions.size(), Vec3d{1, 2, 3});
  EXPECT_EQ(Tree(TriangleMesh{"", {{0, 0, 0}}, {{0, 0, 0}}}).cost({{0, 0, 0}}), 0);
  for (Vec3d& p : positions) p = p * 1e300;
  EXPECT_EQ(tree.cost(positions), 0);
  for (std::size_t i = 0; i < positions.size(); ++i) positions[i] = mesh.positions[i] * 1e300;
  EXPECT_EQ(tree.cost(positions), 0);
  EXPECT_EQ(query_cost({}, nullptr), 0);
}

TEST(QueryCost, IgnoresChildrenWithoutAFiniteTriangle) {
  const TriangleMesh mesh = random_soup(1000, 1, 0.02, 3);
  Tree tree(mesh);
  const double all = tree.cost(mesh.positions);
  std::vector<Vec3d> positions = mesh.positions;
  std::vector<std::uint8_t> inert;
  for (const std::uint32_t t : tree.octree.triangle_ids()) {
    inert.push_back(mesh.positions[3 * t].x > 0);
    if (inert.back() != 0) positions[3 * t].y = std::numeric_limits<double>::quiet_NaN();
  }
  const Parallel parallel{1};
  VertexBuffer vertices;
  vertices.assign(positions, parallel);
  tree.octree.refit(vertices, inert, parallel);
  const double half = query_cost(tree.octree.nodes(), tree.octree.boxes());
  EXPECT_GT(half, all / 4);
  EXPECT_LT(half, all);
}

TEST(QueryCost, IsHighForAnObjectBuiltWhileItWasAPoint) {
  TriangleMesh mesh = random_soup(1000, 1, 0.02, 7);
  const std::vector<Vec3d> spread = mesh.positions;
  std::fill(mesh.positions.begin(), mesh.positions.end(), Vec3d{});
  for (const auto build :
       {ObjectOctreeBuild::balanced, ObjectOctreeBuild::regular, ObjectOctreeBuild::bottom_up}) {
    Tree tree(mesh, build);
    // A regular octree cannot divide equal points; the other octrees always divide them.
    ASSERT_EQ(octree_statistics(tree.octree).largest_leaf == 1000, build == ObjectOctreeBuild::regular);
    Tree rebuilt = tree.rebuilt(spread);
    EXPECT_LT(rebuilt.cost(spread), tree.cost(spread) / 2);
    EXPECT_LE(octree_statistics(rebuilt.octree).largest_leaf, ObjectOctreeOptions{}.leaf_size);
  }
}

TEST(QueryCost, IsTheSameOnAllInstructionSetsAndThreads) {
  const TriangleMesh mesh = random_soup(30000, 1, 0.02, 8);
  const std::vector<Vec3d> positions = mixed(mesh, 0.2);
  const double first = Tree(mesh).cost(positions);
  for_each_target([&](const char* target) {
    for (const std::uint32_t threads : {1u, 3u})
      EXPECT_EQ(Tree(mesh).cost(positions, threads), first) << target;
  });
}

}  // namespace supple::query_cost_test
