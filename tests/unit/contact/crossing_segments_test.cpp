#include "contact/intersection/crossing_segments.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "contact/intersection/pair_filter.hpp"
#include "support/instruction_sets.hpp"
#include "unit/contact/triangle_lists.hpp"
#include "unit/contact/triangle_pairs.hpp"

namespace supple::crossing_segments_test {

using truth::converted;
using truth::pair_families;
using truth::PairFamily;
using truth::PairList;
using truth::TrianglePair3d;
using truth::widened;

bool same_bits(const Vec3d& p, const Vec3d& q) {
  for (int axis = 0; axis < 3; ++axis) {
    if (std::bit_cast<std::uint64_t>(p[axis]) != std::bit_cast<std::uint64_t>(q[axis])) return false;
  }
  return true;
}

struct Tally {
  std::uint64_t crossing = 0, known = 0;
};

/// Compares the kernel with the scalar code on the pairs of a family that the filter finds to be crossing.
template <class ScalarA, class ScalarB>
Tally expect_same_bits(const PairFamily& family, const Vec3d& shift_a, const Vec3d& shift_b) {
  RandomNumbers random(41);
  Tally tally;
  for (int round = 0; round < 20; ++round) {
    PairList<ScalarA, ScalarB> block(pair_filter_capacity);
    std::vector<TrianglePair3d> placed;
    for (std::size_t i = 0; i < pair_filter_capacity; ++i) {
      const TrianglePair3d pair = family.draw(random);
      const auto a = converted<ScalarA>(pair.a);
      const auto b = converted<ScalarB>(pair.b);
      block.set(i, a, b);
      placed.push_back({widened(a), widened(b)});
      for (std::size_t k = 0; k < 3; ++k) {
        placed.back().a[k] = placed.back().a[k] + shift_a;
        placed.back().b[k] = placed.back().b[k] + shift_b;
      }
    }
    const PlacedTriangles a = block.a.placed(shift_a), b = block.b.placed(shift_b);
    const std::uint64_t crossing = filter_pairs(a, b, block.pairs).crossing;
    std::vector<TrianglePair> pairs;
    std::vector<TriangleIntersection> expected;
    for (std::size_t i = 0; i < pair_filter_capacity; ++i) {
      if ((crossing >> i & 1) == 0) continue;
      pairs.push_back(block.pairs[i]);
      expected.push_back(intersect_triangles(placed[i].a, placed[i].b));
    }
    tally.crossing += pairs.size();
    std::uint64_t known = 0;
    bool is_first = true;
    for_each_target([&](const char* target) {
      CrossingSegments segments;
      segments.find(a, b, pairs);
      std::uint64_t now_known = 0;
      for (std::size_t i = 0; i < pairs.size(); ++i) {
        if (!segments.is_known(i)) continue;
        now_known |= std::uint64_t{1} << i;
        ASSERT_EQ(expected[i].point_count, 2) << target << ' ' << family.name;
        for (const std::size_t end : {0u, 1u}) {
          const ContactPoint point = segments.end(end, i);
          EXPECT_EQ(point.on_a, expected[i].points[end].on_a) << target << ' ' << family.name;
          EXPECT_EQ(point.on_b, expected[i].points[end].on_b) << target << ' ' << family.name;
          EXPECT_TRUE(same_bits(point.position, expected[i].points[end].position))
              << target << ' ' << family.name;
        }
        EXPECT_TRUE(same_bits(segments.normal(i), expected[i].normal)) << target << ' ' << family.name;
      }
      if (!is_first) {
        EXPECT_EQ(now_known, known) << target << ' ' << family.name;
      }
      known = now_known;
      is_first = false;
    });
    tally.known += static_cast<std::uint64_t>(std::popcount(known));
  }
  return tally;
}

class CrossingSegmentsTest : public ::testing::TestWithParam<PairFamily> {};
INSTANTIATE_TEST_SUITE_P(All, CrossingSegmentsTest, ::testing::ValuesIn(pair_families()),
                         [](const auto& family) { return family.param.name; });

TEST_P(CrossingSegmentsTest, HasTheBitsOfTheScalarCode) {
  expect_same_bits<float, float>(GetParam(), {}, {});
  expect_same_bits<double, double>(GetParam(), {}, {});
  const Vec3d shift_a{0.375, -1e-3, 7}, shift_b{0.1, 0.2, 7.25};
  expect_same_bits<float, double>(GetParam(), shift_a, shift_b);
  expect_same_bits<double, float>(GetParam(), shift_a, shift_b);
}

TEST(CrossingSegments, AreMostlyKnownInGeneralPosition) {
  const Tally floats = expect_same_bits<float, float>(pair_families()[0], {}, {});
  EXPECT_GT(floats.crossing, 100u);
  EXPECT_GT(floats.known, floats.crossing * 9 / 10);
  const Tally doubles = expect_same_bits<double, double>(pair_families()[0], {}, {});
  EXPECT_GT(doubles.crossing, 100u);
  EXPECT_GT(doubles.known, doubles.crossing * 9 / 10);
}

}  // namespace supple::crossing_segments_test
