#include "experiments/studies/three_axis_sweep.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "support/random.hpp"

namespace supple::experiments::three_axis_sweep_test {

std::vector<IndexPair> overlapping_pairs(const std::vector<Aabb>& boxes) {
  std::vector<IndexPair> pairs;
  for (std::uint32_t a = 0; a < boxes.size(); ++a) {
    for (std::uint32_t b = a + 1; b < boxes.size(); ++b) {
      bool overlaps = true;
      for (int axis = 0; axis < 3; ++axis) {
        overlaps =
            overlaps && boxes[a].min[axis] <= boxes[b].max[axis] && boxes[b].min[axis] <= boxes[a].max[axis];
      }
      if (overlaps) pairs.push_back({a, b});
    }
  }
  return pairs;
}

/// Whole coordinates, so that many ends are equal.
TEST(ThreeAxisSweep, FindsThePairsOfBruteForceInEveryStep) {
  RandomNumbers random(3);
  for (const std::uint32_t jump : {1u, 20u}) {
    std::vector<Aabb> boxes(60);
    for (Aabb& box : boxes) {
      for (int axis = 0; axis < 3; ++axis) {
        box.min[axis] = static_cast<float>(random.below(20));
        box.max[axis] = box.min[axis] + static_cast<float>(random.below(5));
      }
    }
    ThreeAxisSweep sweep(boxes, overlapping_pairs(boxes));
    EXPECT_EQ(sweep.update(boxes), overlapping_pairs(boxes).size());
    EXPECT_EQ(sweep.exchanges(), 0u);
    std::uint64_t exchanges = 0;
    for (int step = 0; step < 100; ++step) {
      for (Aabb& box : boxes) {
        for (int axis = 0; axis < 3; ++axis) {
          const auto by = static_cast<float>(random.below(2 * jump + 1)) - static_cast<float>(jump);
          box.min[axis] += by;
          box.max[axis] += by;
        }
      }
      ASSERT_EQ(sweep.update(boxes), overlapping_pairs(boxes).size()) << step;
      exchanges += sweep.exchanges();
    }
    EXPECT_GT(exchanges, 1000u);
  }
}

}  // namespace supple::experiments::three_axis_sweep_test
