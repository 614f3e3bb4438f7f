#include "supple/wave_motion.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <optional>
#include <vector>

namespace supple::wave_motion_test {

const WaveMotion motion{{0.3, -0.2, 0.1}, 0.05, 0.7, 2.5, 42};
const std::vector<Vec3d> rest{{0, 0, 0}, {0.25, -0.5, 0.125}, {-0.75, 0.3, 0.9}};

std::vector<Vec3d> swayed(const WaveMotion& how, const std::optional<Border>& border, double seconds) {
  std::vector<Vec3d> positions(rest.size());
  apply_wave_motion(how, border, rest, seconds, positions);
  return positions;
}

TEST(WaveMotion, GivesTheSameBitsEverywhere) {
  const Border border{{{-1, -1, -1}, {1.5, 1.5, 1.5}}};
  const std::vector<Vec3d> at_first{{0x1.4a9258c690fa5p-6, 0x1.6cf9c5d78c2f8p-6, -0x1.d112c894d2f3fp-6},
                                    {0x1.9b762c331eae3p-3, -0x1.cccde6c13a388p-2, 0x1.c4ada08f5e6bap-4},
                                    {-0x1.937862c6a1257p-1, 0x1.5ad00540583f1p-2, 0x1.c8d981505fc87p-1}};
  const std::vector<Vec3d> drifted{{0x1.80bbcc188dae3p-2, -0x1.269db8d513bccp-2, 0x1.4e7b2b13b4b71p-3},
                                   {0x1.6139b5765980cp-1, -0x1.9e7972d67c6cfp-1, 0x1.0db10866be975p-2},
                                   {-0x1.4e2c46e60b662p-2, 0x1.6e6dcc6754918p-8, 0x1.0b3983564a121p+0}};
  const std::vector<Vec3d> reflected{{0x1.a3ee2c5fce218p-1, 0x1.71ce349522c85p-1, 0x1.2554e77464dc2p-4},
                                     {0x1.003b925330a29p+0, 0x1.fffdcc1725299p-3, 0x1.af239d147c02ap-3},
                                     {0x1.884db4be1cfd8p-7, 0x1.09e7348349431p+0, 0x1.fc0cb48392fb9p-1}};
  EXPECT_EQ(swayed(motion, {}, 0), at_first);
  EXPECT_EQ(swayed(motion, border, 1.3), drifted);
  EXPECT_EQ(swayed(motion, border, 40), reflected);
}

TEST(WaveMotion, StaysWithinTheBorder) {
  const Border border{{{-1, -1, -1}, {1.5, 1.5, 1.5}}};
  for (int i = 0; i < 500; ++i) {
    for (const Vec3d& p : swayed(motion, border, 0.37 * i)) {
      for (int axis = 0; axis < 3; ++axis) {
        EXPECT_GE(p[axis], border[0][axis] - 1e-12);
        EXPECT_LE(p[axis], border[1][axis] + 1e-12);
      }
    }
  }
}

TEST(WaveMotion, DoesNotDriftWhereThereIsNoRoom) {
  const Border narrow{{{-0.1, -100, -100}, {0.1, 100, 100}}};
  const WaveMotion still{motion.velocity, 0, 1, 1, 0};
  const auto positions = swayed(still, narrow, 10);
  for (std::size_t i = 0; i < rest.size(); ++i) {
    EXPECT_EQ(positions[i].x, rest[i].x);
    EXPECT_EQ(positions[i].y, rest[i].y - 2);
  }
}

TEST(WaveMotion, ABadVertexMovesNothingElse) {
  std::vector<Vec3d> spoilt = rest, positions(rest.size());
  spoilt[1].x = std::numeric_limits<double>::quiet_NaN();
  apply_wave_motion({motion.velocity, 0.05, 0.7, 2.5, 42}, {}, spoilt, 1.3, positions);
  EXPECT_TRUE(std::isnan(positions[1].x));
  EXPECT_EQ(positions[0], swayed(motion, {}, 1.3)[0]);
  EXPECT_EQ(positions[2], swayed(motion, {}, 1.3)[2]);
}

}  // namespace supple::wave_motion_test
