#include "contact/plane_rejection.hpp"

#include <gtest/gtest.h>

#include <bit>

#include "support/instruction_sets.hpp"
#include "unit/contact/triangle_pairs.hpp"

namespace supple {
namespace {

using testing::pair_families;
using testing::PairFamily;
using testing::Random;
using testing::TrianglePair3d;

class PlaneRejection : public ::testing::TestWithParam<PairFamily> {};
INSTANTIATE_TEST_SUITE_P(All, PlaneRejection, ::testing::ValuesIn(pair_families()),
                         [](const auto& family) { return family.param.name; });

TEST_P(PlaneRejection, EqualsTheScalarTwinAndNeverRejectsAHit) {
  Random random(31);
  for (int round = 0; round < 20; ++round) {
    TrianglePairBlock block;
    std::uint64_t hits = 0;
    for (std::size_t i = 0; i < TrianglePairBlock::capacity; ++i) {
      const TrianglePair3d pair = GetParam().draw(random);
      block.set(i, pair.a, pair.b);
      hits |= std::uint64_t{triangles_intersect(pair.a, pair.b)} << i;
    }
    const std::uint64_t expected = planes_separate_scalar(block, TrianglePairBlock::capacity);
    ASSERT_EQ(expected & hits, 0u);
    for_each_target([&](const char* target) {
      EXPECT_EQ(planes_separate(block, TrianglePairBlock::capacity), expected) << target;
      for (const std::size_t count : {std::size_t{0}, std::size_t{1}, std::size_t{13}, std::size_t{63}}) {
        EXPECT_EQ(planes_separate(block, count), expected & ((std::uint64_t{1} << count) - 1)) << target;
      }
    });
  }
}

TEST(PlaneRejectionRate, MostSeparatedPairsAreRejected) {
  Random random(32);
  TrianglePairBlock block;
  int rejected = 0;
  for (int round = 0; round < 20; ++round) {
    for (std::size_t i = 0; i < TrianglePairBlock::capacity; ++i) {
      TrianglePair3d pair = pair_families()[0].draw(random);
      for (std::size_t k = 0; k < 3; ++k) pair.b[k] = pair.a[k] * 0.99 + Vec3d{0.5, 0.3, 0.2};
      block.set(i, pair.a, pair.b);
    }
    rejected += std::popcount(planes_separate(block, TrianglePairBlock::capacity));
  }
  EXPECT_GT(rejected, 1200);
}

}  // namespace
}  // namespace supple
