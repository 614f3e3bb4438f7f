#include "octree/quality.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "octree/object_octree.hpp"
#include "support/instruction_sets.hpp"
#include "support/soups.hpp"

namespace supple {
namespace {

/// An octree of a soup, refitted to positions, and its quality.
struct Measured {
  explicit Measured(const TriangleMesh& mesh_in, bool regular = false)
      : mesh(mesh_in),
        octree(mesh.positions, mesh.triangles, {.regular = regular}, BoundingVolume::aabb,
               SphereFit::vertices) {
    refit(mesh.positions);
    quality.set_references(boxes());
  }
  void refit(const std::vector<Vec3d>& positions) {
    vertices.assign(positions, parallel);
    octree.refit(vertices, {}, parallel);
  }
  TreeBoxes boxes() const { return {octree.nodes(), octree.boxes()}; }
  void measure(const std::vector<Vec3d>& positions) {
    refit(positions);
    quality.measure(boxes());
  }
  void rebuild() {
    const std::vector<std::uint32_t> old_nodes = octree.rebuild(quality.degraded(), vertices);
    octree.refit(vertices, {}, parallel);
    quality.update_references(boxes(), old_nodes);
  }

  TriangleMesh mesh;
  Parallel parallel{1};
  ObjectOctree octree;
  VertexBuffer vertices;
  TreeQuality quality;
};

/// Triangles of which `moves` says so go elsewhere in the cube, all in one piece.
template <class Moves>
std::vector<Vec3d> mixed(const TriangleMesh& mesh, double distance, Moves moves) {
  RandomNumbers random(9);
  std::vector<Vec3d> positions = mesh.positions;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vec3d way = random.vector(distance);
    if (!moves(mesh.positions[3 * t])) continue;
    for (std::size_t corner = 0; corner < 3; ++corner) {
      positions[3 * t + corner] = positions[3 * t + corner] + way;
    }
  }
  return positions;
}

bool all(const Vec3d&) {
  return true;
}

TEST(TreeQuality, IsOneAsBuiltAndTheSameMovedAndScaled) {
  const TriangleMesh mesh = random_soup(4000, 1, 0.02, 1);
  Measured measured(mesh);
  measured.measure(mesh.positions);
  const double cost = measured.quality.cost();
  EXPECT_GT(cost, 1);
  EXPECT_EQ(measured.quality.degradation(), 1);
  EXPECT_TRUE(measured.quality.degraded().empty());
  for (const double scale : {0x1p-40, 0x1p40}) {
    std::vector<Vec3d> positions = mesh.positions;
    for (Vec3d& p : positions) p = p * scale;
    measured.measure(positions);
    EXPECT_EQ(measured.quality.cost(), cost);
  }
  std::vector<Vec3d> positions = mesh.positions;
  for (Vec3d& p : positions) p = p + Vec3d{3, -2, 1};
  measured.measure(positions);
  EXPECT_NEAR(measured.quality.degradation(), 1, 1e-3);
}

TEST(TreeQuality, FindsTheWholeTreeWhenAllIsMixed) {
  Measured measured(random_soup(4000, 1, 0.02, 2));
  measured.measure(mixed(measured.mesh, 1, all));
  EXPECT_GT(measured.quality.degradation(), 3);
  ASSERT_EQ(measured.quality.degraded().size(), 1u);
  EXPECT_EQ(measured.quality.degraded()[0], 0u);
  EXPECT_EQ(measured.quality.share(), 1);
  EXPECT_NEAR(measured.quality.saving(), measured.quality.degradation() - 1, 1e-9);
  const double before = measured.quality.cost();
  measured.rebuild();
  EXPECT_LT(measured.quality.cost(), before / 3);
  EXPECT_DOUBLE_EQ(measured.quality.degradation(), 1);
}

TEST(TreeQuality, FindsThePartThatIsMixed) {
  Measured measured(random_soup(20000, 1, 0.02, 3));
  const auto in_corner = [](const Vec3d& p) { return p.x > 0.1 && p.y > 0.1 && p.z > 0.1; };
  // Within the corner's octant: 0.1 to 1 and no further than the others' boxes reach.
  std::vector<Vec3d> positions = measured.mesh.positions;
  RandomNumbers random(4);
  for (std::size_t t = 0; t < measured.mesh.triangles.size(); ++t) {
    if (!in_corner(measured.mesh.positions[3 * t])) continue;
    const Vec3d place{random.uniform(0.1, 1), random.uniform(0.1, 1), random.uniform(0.1, 1)};
    const Vec3d first = positions[3 * t];
    for (std::size_t corner = 0; corner < 3; ++corner) {
      positions[3 * t + corner] = positions[3 * t + corner] - first + place;
    }
  }
  measured.measure(positions);
  ASSERT_FALSE(measured.quality.degraded().empty());
  EXPECT_LT(measured.quality.share(), 0.3);
  for (const std::uint32_t n : measured.quality.degraded()) {
    const OctreeNode& node = measured.octree.nodes()[n];
    std::uint32_t of_corner = 0;
    for (std::uint32_t t = node.first_triangle[0]; t < node.first_triangle[node_width]; ++t) {
      of_corner += in_corner(measured.mesh.positions[3 * measured.octree.triangle_ids()[t]]) ? 1 : 0;
    }
    EXPECT_GT(of_corner * 2, node.size());
  }
  const double before = measured.quality.degradation();
  EXPECT_GT(before, 1.2);
  measured.rebuild();
  EXPECT_EQ(measured.octree.validate(measured.vertices, {}), "");
  // What the rest costs as before is not taken for better, nor what is new for worse.
  measured.quality.measure(measured.boxes());
  EXPECT_TRUE(measured.quality.degraded().empty());
  EXPECT_NEAR(measured.quality.degradation(), 1, 0.05);
}

TEST(TreeQuality, ForgetsNothingOfWhatIsNotBuiltAnew) {
  Measured measured(random_soup(20000, 1, 0.02, 5));
  // Everything drifts a little, one half by so much that it is chosen.
  const auto positions = mixed(measured.mesh, 0.03, all);
  measured.measure(positions);
  const double slight = measured.quality.degradation();
  ASSERT_TRUE(measured.quality.degraded().empty()) << slight;
  ASSERT_GT(slight, 1.02);
  const TriangleMesh drifted{"", positions, measured.mesh.triangles};
  measured.measure(mixed(drifted, 0.3, [](const Vec3d& p) { return p.x > 0.3; }));
  ASSERT_FALSE(measured.quality.degraded().empty());
  ASSERT_LT(measured.quality.share(), 0.9);
  measured.rebuild();
  measured.quality.measure(measured.boxes());
  EXPECT_GT(measured.quality.degradation(), 1.005);
}

TEST(TreeQuality, IsNotKnownOfWhatHasNoSurfaceOrTooMuch) {
  const TriangleMesh mesh = random_soup(1000, 1, 0.02, 6);
  Measured measured(mesh);
  std::vector<Vec3d> positions(mesh.positions.size(), Vec3d{1, 2, 3});
  measured.measure(positions);
  EXPECT_TRUE(measured.quality.degraded().empty());
  for (Vec3d& p : positions) p = p * 1e300;
  measured.measure(positions);
  EXPECT_TRUE(measured.quality.degraded().empty());
  for (std::size_t i = 0; i < positions.size(); ++i) positions[i] = mesh.positions[i] * 1e300;
  measured.measure(positions);
  EXPECT_EQ(measured.quality.cost(), 0);
  EXPECT_EQ(measured.quality.degradation(), 1);
  EXPECT_TRUE(measured.quality.degraded().empty());
  measured.measure(mesh.positions);
  EXPECT_DOUBLE_EQ(measured.quality.degradation(), 1);
}

TEST(TreeQuality, FindsAnObjectBuiltWhileItWasAPoint) {
  TriangleMesh mesh = random_soup(1000, 1, 0.02, 7);
  const std::vector<Vec3d> spread = mesh.positions;
  std::fill(mesh.positions.begin(), mesh.positions.end(), Vec3d{});
  for (const bool regular : {false, true}) {
    Measured measured(mesh, regular);
    // A regular octree cannot divide equal points, a balanced one divides them anyhow.
    ASSERT_EQ(measured.octree.statistics().largest_leaf == 1000, regular);
    measured.measure(spread);
    ASSERT_EQ(measured.quality.degraded().size(), 1u);
    ASSERT_EQ(measured.quality.degraded()[0], 0u);
    const double before = measured.quality.cost();
    measured.rebuild();
    EXPECT_LT(measured.quality.cost(), before / 2);
    EXPECT_LE(measured.octree.statistics().largest_leaf, ObjectOctreeOptions{}.leaf_size);
    EXPECT_EQ(measured.octree.validate(measured.vertices, {}), "");
  }
}

TEST(TreeQuality, IsTheSameOnAllInstructionSetsAndThreads) {
  const TriangleMesh mesh = random_soup(30000, 1, 0.02, 8);
  const std::vector<Vec3d> positions = mixed(mesh, 0.2, [](const Vec3d& p) { return p.x + p.y > 0.2; });
  Measured first(mesh);
  first.measure(positions);
  ASSERT_FALSE(first.quality.degraded().empty());
  for_each_target([&](const char* target) {
    for (const std::uint32_t threads : {1u, 3u}) {
      SCOPED_TRACE(target);
      Measured again(mesh);
      again.parallel = Parallel(threads);
      again.measure(positions);
      EXPECT_EQ(again.quality.cost(), first.quality.cost());
      EXPECT_EQ(again.quality.saving(), first.quality.saving());
      EXPECT_TRUE(std::equal(again.quality.degraded().begin(), again.quality.degraded().end(),
                             first.quality.degraded().begin(), first.quality.degraded().end()));
    }
  });
}

}  // namespace
}  // namespace supple
