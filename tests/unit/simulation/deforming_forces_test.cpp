#include "simulation/deforming_forces.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "geometry/vector.hpp"
#include "supple/models.hpp"

namespace supple {
namespace {

TEST(DeformingForces, SumToZeroAndTurnNothing) {
  const TriangleMesh mesh = make_torus(12, 8);
  Random random(3);
  const std::vector<Vec3d> forces =
      deforming_forces(mesh.positions, MassSpringBody(mesh).springs(), 2, random);
  ASSERT_EQ(forces.size(), mesh.positions.size());
  Vec3d sum, torque;
  double squares = 0;
  for (std::size_t i = 0; i < forces.size(); ++i) {
    sum = sum + forces[i];
    torque = torque + cross(mesh.positions[i], forces[i]);
    squares += norm(forces[i]) * norm(forces[i]);
  }
  EXPECT_LT(norm(sum), 1e-10);
  EXPECT_LT(norm(torque), 1e-10);
  EXPECT_NEAR(std::sqrt(squares / static_cast<double>(forces.size())), 2, 1e-12);
}

TEST(DeformingForces, LeaveEachPieceInPlace) {
  TriangleMesh mesh = make_icosphere(2);
  const std::size_t first = mesh.positions.size();
  const TriangleMesh torus = make_torus(9, 5);
  for (const Vec3d& p : torus.positions) mesh.positions.push_back(p + Vec3d{1, 0.5, 0});
  for (const auto& [a, b, c] : torus.triangles) {
    const auto shift = static_cast<std::uint32_t>(first);
    mesh.triangles.push_back({a + shift, b + shift, c + shift});
  }
  Random random(3);
  const std::vector<Vec3d> forces =
      deforming_forces(mesh.positions, MassSpringBody(mesh).springs(), 2, random);
  std::array<Vec3d, 2> sum{}, torque{};
  for (std::size_t i = 0; i < forces.size(); ++i) {
    const std::size_t piece = i < first ? 0 : 1;
    sum[piece] = sum[piece] + forces[i];
    torque[piece] = torque[piece] + cross(mesh.positions[i], forces[i]);
  }
  for (std::size_t piece = 0; piece < 2; ++piece) {
    EXPECT_LT(norm(sum[piece]), 1e-10);
    EXPECT_LT(norm(torque[piece]), 1e-10);
  }
  EXPECT_GT(norm(forces[0]), 0.01);
  EXPECT_GT(norm(forces[first]), 0.01);
}

TEST(DeformingForces, PullAlikeAtNeighbours) {
  const TriangleMesh mesh = make_icosphere(12);
  Random random(3);
  const std::vector<Vec3d> forces =
      deforming_forces(mesh.positions, MassSpringBody(mesh).springs(), 1, random);
  for (const Triangle& t : mesh.triangles) {
    const double edge = norm(mesh.positions[t[0]] - mesh.positions[t[1]]);
    EXPECT_LT(norm(forces[t[0]] - forces[t[1]]), 6 * edge);
  }
}

TEST(DeformingForces, OfNothingPointsAndLines) {
  Random random(3);
  EXPECT_TRUE(deforming_forces({}, {}, 1, random).empty());
  const std::vector<Vec3d> point{{1, 2, 3}};
  EXPECT_EQ(deforming_forces(point, {}, 1, random)[0], Vec3d{});
  const std::vector<Vec3d> line{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  const std::vector<MassSpringBody::Spring> line_springs{{0, 1, 1}, {1, 2, 1}};
  const std::vector<Vec3d> forces = deforming_forces(line, line_springs, 1, random);
  EXPECT_LT(norm(forces[0] + forces[1] + forces[2]), 1e-15);
  EXPECT_GT(norm(forces[0]), 0.1);
}

TEST(DeformingForces, LeaveOutWhatIsNotFinite) {
  TriangleMesh mesh = make_icosphere(2);
  mesh.positions[4].y = std::numeric_limits<double>::quiet_NaN();
  Random random(3);
  const std::vector<Vec3d> forces =
      deforming_forces(mesh.positions, MassSpringBody(mesh).springs(), 1, random);
  EXPECT_EQ(forces[4], Vec3d{});
  Vec3d sum;
  for (const Vec3d& force : forces) sum = sum + force;
  EXPECT_LT(norm(sum), 1e-12);
}

}  // namespace
}  // namespace supple
