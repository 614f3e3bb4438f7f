#include "simulation/impulse_spread.hpp"

#include <gtest/gtest.h>

#include "supple/models.hpp"

namespace supple::impulse_spread_test {

double sum_of(std::span<const ImpulseSpread::Share> shares) {
  double sum = 0;
  for (const auto& share : shares) sum += share.part;
  return sum;
}

MassSpringOptions springs(double stiffness, std::vector<std::uint32_t> fixed = {}) {
  return {.vertex_mass = 1e-2,
          .stiffness = stiffness,
          .bending_stiffness = 0.5 * stiffness,
          .area_stiffness = 0.25 * stiffness,
          .fixed_vertices = fixed};
}

/// For two masses, (1 + λ, -λ; -λ, 1 + λ)⁻¹ = (1 + λ, λ; λ, 1 + λ) / (1 + 2 λ).
TEST(ImpulseSpread, OfOneSpringIsThatOfBackwardEuler) {
  const TriangleMesh mesh{"spring", {{0, 0, 0}, {1, 0, 0}, {5, 0, 0}}, {{0, 1, 1}}};
  const double lambda = 0.1 * 0.1 * 30 / 0.5;
  ImpulseSpread spread(mesh, {.vertex_mass = 0.5, .stiffness = 30}, 0.1);
  EXPECT_NEAR(spread.share(0, 0), (1 + lambda) / (1 + 2 * lambda), 1e-12);
  EXPECT_NEAR(spread.share(0, 1), lambda / (1 + 2 * lambda), 1e-12);
  EXPECT_EQ(spread.share(0, 2), 0);
  EXPECT_EQ(spread.share(2, 2), 1);
  ImpulseSpread held(mesh, {.vertex_mass = 0.5, .stiffness = 30, .fixed_vertices = {1}}, 0.1);
  EXPECT_NEAR(held.share(0, 0), 1 / (1 + lambda), 1e-12);
  EXPECT_TRUE(held.from(1).empty());
}

TEST(ImpulseSpread, SharesSumToOneUnlessVerticesAreFixed) {
  const TriangleMesh mesh = make_cloth(30, 30);
  for (const double stiffness : {0.0, 1.0, 1e2, 1e4, 1e9}) {
    ImpulseSpread spread(mesh, springs(stiffness), 0.01);
    for (const std::uint32_t v : {0u, 17u, 480u}) {
      EXPECT_NEAR(sum_of(spread.from(v)), 1, 1e-12) << stiffness;
      EXPECT_GT(spread.share(v, v), 0);
      EXPECT_LE(spread.from(v).size(), ImpulseSpread::patch_size);
    }
  }
  EXPECT_EQ(ImpulseSpread(mesh, springs(0), 0.01).from(480).size(), 1u);
  ImpulseSpread held(mesh, springs(1e2, {481}), 0.01);
  EXPECT_LT(sum_of(held.from(480)), 0.95);
}

TEST(ImpulseSpread, IsAsMuchThereAsBack) {
  const TriangleMesh mesh = make_icosphere(6);
  ImpulseSpread spread(mesh, springs(100), 0.01);
  for (std::uint32_t v = 0; v < 100; v += 7) {
    for (const auto& share : spread.from(v))
      EXPECT_NEAR(spread.share(share.vertex, v), share.part, 1e-2 * spread.share(v, v));
  }
}

TEST(ImpulseSpread, GoesFurtherWhenSpringsAreStiff) {
  const TriangleMesh mesh = make_cloth(30, 30);
  double before = 1.1;
  for (const double stiffness : {0.1, 1.0, 10.0, 100.0, 1000.0}) {
    const double own = ImpulseSpread(mesh, springs(stiffness), 0.01).share(480, 480);
    EXPECT_LT(own, 0.95 * before);
    before = own;
  }
}

TEST(ImpulseSpread, HasTheSpringsOfCopiesOnly) {
  TriangleMesh mesh = make_icosphere(3);
  const ImpulseSpread spread(mesh, springs(100), 0.01);
  for (Vec3d& p : mesh.positions) p = p + Vec3d{0.3, 5, -7};
  EXPECT_TRUE(spread.has_springs_of(ImpulseSpread(mesh, springs(100), 0.01)));
  EXPECT_FALSE(spread.has_springs_of(ImpulseSpread(mesh, springs(101), 0.01)));
  EXPECT_FALSE(spread.has_springs_of(ImpulseSpread(mesh, springs(100), 0.02)));
  EXPECT_FALSE(spread.has_springs_of(ImpulseSpread(mesh, springs(100, {3}), 0.01)));
  EXPECT_FALSE(spread.has_springs_of(ImpulseSpread(make_icosphere(4), springs(100), 0.01)));
}

}  // namespace supple::impulse_spread_test
