#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "motion/network/mesh_pieces.hpp"
#include "supple/models.hpp"
#include "supple/motion.hpp"

namespace supple::pieces_test {

using Pairs = std::vector<std::array<std::uint32_t, 2>>;

TriangleMesh joined(const std::vector<TriangleMesh>& meshes) {
  TriangleMesh all;
  for (const TriangleMesh& mesh : meshes) {
    const auto first = static_cast<std::uint32_t>(all.positions.size());
    all.positions.insert(all.positions.end(), mesh.positions.begin(), mesh.positions.end());
    for (const Triangle& t : mesh.triangles)
      all.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  }
  return all;
}

TriangleMesh moved(TriangleMesh mesh, Vec3d by) {
  for (Vec3d& p : mesh.positions) p += by;
  return mesh;
}

TriangleMesh triangle(Vec3d at) {
  return {"triangle", {at, at + Vec3d{1, 0, 0}, at + Vec3d{0, 1, 0}}, {{0, 1, 2}}};
}

TEST(Pieces, OnePieceNeedsNoConnections) {
  EXPECT_EQ(connections_of_pieces(make_icosphere(3)), Pairs{});
  EXPECT_EQ(connections_of_pieces({}), Pairs{});
}

TEST(Pieces, ConnectEachVertexToTheNearestTriangle) {
  const Pairs expected{{0, 3}, {0, 4}, {0, 5}, {1, 3}, {1, 4}, {1, 5}, {2, 3}, {2, 4}, {2, 5}};
  EXPECT_EQ(connections_of_pieces(joined({triangle({}), triangle({0, 0, 1})})), expected);
}

TEST(Pieces, ConnectAtMostSixteenVerticesTheNearestOnes) {
  const TriangleMesh mesh =
      joined({make_cloth(9, 9), moved(make_cloth(8, 8, 1, 1), {0.9, 0.3, 0}), triangle({5, 0, 0})});
  std::vector<std::uint32_t> of_cloth, of_triangle;
  for (const auto& [a, b] : connections_of_pieces(mesh)) {
    if (a < 100 && b < 181) of_cloth.push_back(b);
    if (b >= 181) of_triangle.push_back(b);
  }
  std::sort(of_cloth.begin(), of_cloth.end());
  of_cloth.erase(std::unique(of_cloth.begin(), of_cloth.end()), of_cloth.end());
  EXPECT_EQ(of_cloth.size(), 16u);
  for (const std::uint32_t v : of_cloth) EXPECT_LT(mesh.positions[v].x, 0.7);
  EXPECT_EQ(of_triangle.size(), 9u);
}

TEST(Pieces, VerticesThatAreUnusedOrNotFiniteStayAlone) {
  TriangleMesh mesh = joined({make_icosphere(1), triangle({2, 0, 0})});
  mesh.positions.push_back({});
  mesh.positions[13].y = std::numeric_limits<double>::quiet_NaN();
  const Pairs pairs = connections_of_pieces(mesh);
  EXPECT_EQ(pairs.size(), 6u);
  for (const auto& [a, b] : pairs) EXPECT_TRUE(b == 12 || b == 14) << b;
}

/// The length of a fish after forces at both ends have pulled it for two seconds.
double length_after(bool connect_pieces) {
  const TriangleMesh fish = make_model("fish");
  MassSpringBody body(fish, {.stiffness = 400, .connect_pieces = connect_pieces, .damping = 1});
  std::vector<Vec3d> forces(fish.positions.size());
  for (std::size_t v = 0; v < forces.size(); ++v) {
    if (fish.positions[v].x < -0.3) forces[v] = {-1, 0, 0};
    if (fish.positions[v].x > 0.3) forces[v] = {1, 0, 0};
  }
  body.set_external_forces(forces);
  for (int step = 0; step < 200; ++step) body.step(0.01);
  double low = 1, high = -1;
  for (const Vec3d& p : body.positions()) {
    low = std::min(low, p.x);
    high = std::max(high, p.x);
  }
  return high - low;
}

TEST(Pieces, OfAFishStayTogetherWhenTheyAreConnected) {
  EXPECT_LT(length_after(true), 1.5);
  EXPECT_GT(length_after(false), 2);
}

}  // namespace supple::pieces_test
