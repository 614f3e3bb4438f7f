#include "simulation/deforming_forces.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "geometry/vector.hpp"
#include "supple/models.hpp"

namespace supple::deforming_forces_test {

std::vector<Vec3d> constant_forces(const TriangleMesh& mesh, double size) {
  const MassSpringMotion motion{.random_force = size, .deform_seconds = 1};
  const DeformingForces forces(mesh.positions, MassSpringBody(mesh).springs(), motion, Random(3));
  return {forces.constant().begin(), forces.constant().end()};
}

double root_mean_square(std::span<const Vec3d> forces) {
  double squares = 0;
  for (const Vec3d& force : forces) squares += dot(force, force);
  return std::sqrt(squares / static_cast<double>(forces.size()));
}

TEST(DeformingForces, SumToZeroAndTurnNothing) {
  const TriangleMesh mesh = make_torus(12, 8);
  const std::vector<Vec3d> forces = constant_forces(mesh, 2);
  ASSERT_EQ(forces.size(), mesh.positions.size());
  Vec3d sum, torque;
  for (std::size_t i = 0; i < forces.size(); ++i) {
    sum = sum + forces[i];
    torque = torque + cross(mesh.positions[i], forces[i]);
  }
  EXPECT_LT(norm(sum), 1e-10);
  EXPECT_LT(norm(torque), 1e-10);
  EXPECT_NEAR(root_mean_square(forces), 2, 1e-12);
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
  const std::vector<Vec3d> forces = constant_forces(mesh, 2);
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
  const std::vector<Vec3d> forces = constant_forces(mesh, 1);
  for (const Triangle& t : mesh.triangles) {
    const double edge = norm(mesh.positions[t[0]] - mesh.positions[t[1]]);
    EXPECT_LT(norm(forces[t[0]] - forces[t[1]]), 6 * edge);
  }
}

TEST(DeformingForces, OfNothingPointsAndLines) {
  const MassSpringMotion motion{.random_force = 1, .deform_seconds = 1};
  EXPECT_TRUE(DeformingForces({}, {}, motion, Random(3)).constant().empty());
  const std::vector<Vec3d> point{{1, 2, 3}};
  EXPECT_EQ(DeformingForces(point, {}, motion, Random(3)).constant()[0], Vec3d{});
  const std::vector<Vec3d> line{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  const std::vector<MassSpringBody::Spring> line_springs{{0, 1, 1}, {1, 2, 1}};
  DeformingForces on_line(line, line_springs, motion, Random(3));
  const std::span<const Vec3d> forces = on_line.constant();
  EXPECT_LT(norm(forces[0] + forces[1] + forces[2]), 1e-15);
  EXPECT_GT(norm(forces[0]), 0.1);
}

TEST(DeformingForces, LeaveOutWhatIsNotFinite) {
  TriangleMesh mesh = make_icosphere(2);
  mesh.positions[4].y = std::numeric_limits<double>::quiet_NaN();
  const std::vector<Vec3d> forces = constant_forces(mesh, 1);
  EXPECT_EQ(forces[4], Vec3d{});
  Vec3d sum;
  for (const Vec3d& force : forces) sum = sum + force;
  EXPECT_LT(norm(sum), 1e-12);
}

TEST(DeformingForces, ChangeSmoothlyAndKeepABentBodyInPlace) {
  const TriangleMesh mesh = make_torus(12, 8);
  const MassSpringMotion motion{.random_force = 2, .force_change_seconds = 0.5};
  DeformingForces forces(mesh.positions, MassSpringBody(mesh).springs(), motion, Random(3));
  ASSERT_TRUE(forces.change());
  std::vector<Vec3d> bent = mesh.positions, before, first;
  for (Vec3d& p : bent) p = {2 * p.z, p.x + p.y * p.y, 3 * p.y + 7};
  double least = 2, most = 0, fastest = 0, farthest = 0;
  for (int step = 0; step <= 1000; ++step) {
    const std::span<const Vec3d> now = forces.at(0.01 * step, bent);
    Vec3d sum, torque;
    for (std::size_t i = 0; i < now.size(); ++i) {
      sum = sum + now[i];
      torque = torque + cross(bent[i], now[i]);
      if (!before.empty()) fastest = std::max(fastest, norm(now[i] - before[i]));
      if (!before.empty()) farthest = std::max(farthest, norm(now[i] - first[i]));
    }
    EXPECT_LT(norm(sum), 1e-9);
    EXPECT_LT(norm(torque), 1e-8);
    least = std::min(least, root_mean_square(now));
    most = std::max(most, root_mean_square(now));
    before.assign(now.begin(), now.end());
    if (step == 0) first = before;
  }
  EXPECT_GT(least, 0.5) << "the forces never rest";
  EXPECT_LT(most, 3.5);
  EXPECT_LT(fastest, 0.5) << "a change of 50 steps has no jumps";
  EXPECT_GT(farthest, 2) << "later forces are others";
}

TEST(DeformingForces, AreTheSameForASeedWhateverTheStepsBetween) {
  const TriangleMesh mesh = make_icosphere(2);
  const MassSpringMotion motion{.random_force = 1, .force_change_seconds = 0.25};
  const auto springs = MassSpringBody(mesh).springs();
  DeformingForces often(mesh.positions, springs, motion, Random(3));
  DeformingForces again(mesh.positions, springs, motion, Random(3));
  DeformingForces others(mesh.positions, springs, motion, Random(4));
  for (int step = 0; step <= 60; ++step) {
    const std::span<const Vec3d> now = often.at(0.0625 * step, mesh.positions);
    if (step % 3 != 0) continue;
    const std::span<const Vec3d> same = again.at(0.0625 * step, mesh.positions);
    EXPECT_TRUE(std::equal(now.begin(), now.end(), same.begin())) << step;
    EXPECT_NE(others.at(0.0625 * step, mesh.positions)[0], now[0]);
  }
}

TEST(DeformingForces, ChangeInAnyTime) {
  const TriangleMesh mesh = make_icosphere(2);
  for (const double change : {1e-320, 1e-9, 1e300}) {
    const MassSpringMotion motion{.random_force = 1, .force_change_seconds = change};
    DeformingForces forces(mesh.positions, MassSpringBody(mesh).springs(), motion, Random(3));
    for (const double seconds : {0.0, 0.1, 1e6}) {
      for (const Vec3d& force : forces.at(seconds, mesh.positions)) EXPECT_TRUE(is_finite(force));
    }
  }
}

}  // namespace supple::deforming_forces_test
