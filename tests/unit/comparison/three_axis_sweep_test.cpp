#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "support/random.hpp"
#include "unit/broad_phase/volume_scenes.hpp"

namespace supple::three_axis_sweep_test {

/// Whole coordinates, so that many ends are equal.
std::vector<Aabb> boxes_on_a_lattice(RandomNumbers& random) {
  std::vector<Aabb> boxes(60);
  for (Aabb& box : boxes) {
    for (int axis = 0; axis < 3; ++axis) {
      box.min[axis] = static_cast<float>(random.below(20));
      box.max[axis] = box.min[axis] + static_cast<float>(random.below(5));
    }
  }
  return boxes;
}

void expect_pairs(BroadPhase& sweep, const std::vector<Aabb>& boxes, int step) {
  const auto found = sweep.find_object_pairs(boxes);
  EXPECT_EQ(std::vector(found.begin(), found.end()), test::double_loop(boxes)) << step;
}

TEST(ThreeAxisSweep, ExchangesEndsOfBoxesThatMove) {
  RandomNumbers random(3);
  for (const std::uint32_t jump : {1u, 20u}) {
    std::vector<Aabb> boxes = boxes_on_a_lattice(random);
    BroadPhase sweep({.method = BroadPhaseMethod::sweep3, .threads = 1});
    expect_pairs(sweep, boxes, 0);
    EXPECT_EQ(sweep.stats().exchanges, 0u);
    EXPECT_EQ(sweep.stats().objects_paired, boxes.size());
    std::uint64_t exchanges = 0;
    for (int step = 0; step < 100; ++step) {
      for (Aabb& box : boxes) {
        for (int axis = 0; axis < 3; ++axis) {
          const auto by = static_cast<float>(random.below(2 * jump + 1)) - static_cast<float>(jump);
          box.min[axis] += by;
          box.max[axis] += by;
        }
      }
      expect_pairs(sweep, boxes, step);
      exchanges += sweep.stats().exchanges;
    }
    EXPECT_GT(exchanges, 1000u);
  }
}

TEST(ThreeAxisSweep, TestsOnlyPairsWhoseEndsAreExchanged) {
  std::vector<Aabb> boxes;
  for (int i = 0; i < 10; ++i)
    boxes.push_back(test::box_around({3.0f * static_cast<float>(i), 0, 0}, {1, 1, 1}));
  BroadPhase sweep({.method = BroadPhaseMethod::sweep3, .threads = 1});
  sweep.find_object_pairs(boxes);
  boxes[4] = test::box_around({12.5f, 0, 0}, {1, 1, 1});
  EXPECT_TRUE(sweep.find_object_pairs(boxes).empty());
  EXPECT_EQ(sweep.stats().exchanges + sweep.stats().object_pairs_tested, 0u);
  EXPECT_EQ(sweep.stats().objects_paired, 1u);
  boxes[4] = test::box_around({13, 0, 0}, {1, 1, 1});  // touches the next one
  expect_pairs(sweep, boxes, 1);
  EXPECT_EQ(sweep.find_object_pairs(boxes).size(), 1u);
  boxes[4] = test::box_around({13.5f, 0, 0}, {1, 1, 1});
  expect_pairs(sweep, boxes, 2);
  boxes[4] = test::box_around({12, 0, 0}, {1, 1, 1});
  expect_pairs(sweep, boxes, 3);
  EXPECT_EQ(sweep.stats().exchanges, 1u);
  EXPECT_EQ(sweep.stats().object_pairs_tested, 0u) << "a pair ends without a test";
}

TEST(ThreeAxisSweep, MakesItsListsAgainWhenBoxesComeAndGo) {
  RandomNumbers random(7);
  std::vector<Aabb> boxes = boxes_on_a_lattice(random);
  const std::vector<Aabb> others = boxes_on_a_lattice(random);
  BroadPhase sweep({.method = BroadPhaseMethod::sweep3, .threads = 3});
  for (int step = 0; step < 200; ++step) {
    const std::uint32_t place = random.below(static_cast<std::uint32_t>(boxes.size()));
    const std::uint32_t change = random.below(6);
    if (change == 0) boxes[place] = {};
    if (change == 1) boxes.resize(boxes.size() - random.below(3));
    if (change == 2) boxes.push_back(others[random.below(60)]);
    if (change == 3) boxes[place].max.y = std::numeric_limits<float>::quiet_NaN();
    if (change == 4) boxes[place] = {{-test::infinity, 3, 3}, {test::infinity, 3, 3}};
    if (change == 5) boxes[place] = others[random.below(60)];
    expect_pairs(sweep, boxes, step);
  }
}

}  // namespace supple::three_axis_sweep_test
