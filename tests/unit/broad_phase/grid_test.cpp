#include "broad_phase/grid/grid_search.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "geometry/aabb.hpp"
#include "geometry/sphere.hpp"
#include "support/instruction_sets.hpp"
#include "unit/broad_phase/volume_scenes.hpp"

namespace supple::grid_test {

using test::box_around;
using test::double_loop;
using test::infinity;
using test::Random;

/// The grid without the other methods, for boxes or spheres.
class GridOnly {
 public:
  explicit GridOnly(std::uint32_t threads, BoundingVolume kind = BoundingVolume::aabb)
      : parallel_(threads), volumes_(kind) {}
  const std::vector<IndexPair>& find(std::span<const Aabb> boxes,
                                     std::span<const BoundingSphere> spheres = {}) {
    volumes_.update({.boxes = boxes, .spheres = spheres}, parallel_);
    grid_.search(volumes_, parallel_, found_);
    return found_.pairs;
  }
  /// True if the automatic method does not use the grid.
  bool is_crowded() { return !grid_.search_unless_crowded(volumes_, parallel_, found_); }
  std::uint64_t tests() const { return found_.stats.object_pairs_tested; }

 private:
  Parallel parallel_;
  VolumeStore volumes_;
  GridSearch grid_;
  FoundPairs found_;
};

/// Adjacent unit boxes: many touch, and no two of them share more than a face.
std::vector<Aabb> lattice(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
  std::vector<Aabb> boxes;
  for (std::uint32_t i = 0; i < x * y * z; ++i) {
    const Vec3f low{static_cast<float>(i % x), static_cast<float>(i / x % y),
                    static_cast<float>(i / (x * y))};
    boxes.push_back({low, low + Vec3f{1, 1, 1}});
  }
  return boxes;
}

/// Boxes whose extents range over many powers of two, chosen separately for each axis.
std::vector<Aabb> mixed_boxes(std::size_t count, int lowest, int highest, float side, std::uint32_t seed) {
  Random random(seed);
  std::vector<Aabb> boxes;
  for (std::size_t i = 0; i < count; ++i) {
    Vec3f half;
    const auto powers = static_cast<std::uint32_t>(highest - lowest + 1);
    for (int axis = 0; axis < 3; ++axis)
      half[axis] = std::ldexp(random.uniform(0.5f, 1), lowest + static_cast<int>(random.below(powers)));
    boxes.push_back(box_around(random.point(-side, side), half));
  }
  return boxes;
}

std::vector<Aabb> clusters(std::size_t count, std::uint32_t seed) {
  Random random(seed);
  std::vector<Aabb> boxes;
  Vec3f center;
  for (std::size_t i = 0; i < count; ++i) {
    if (i % 100 == 0) center = random.point(0, 1000);
    const float half = random.below(60) == 0 ? 20.0f : 0.05f;
    boxes.push_back(box_around(center + random.point(-2, 2), {half, half, half}));
  }
  return boxes;
}

std::vector<test::NamedBoxes> hard_scenes() {
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  std::vector<test::NamedBoxes> scenes = test::box_scenes();
  scenes.push_back({"nothing", {}});
  scenes.push_back({"one", {box_around({1, 2, 3}, {1, 1, 1})}});
  scenes.push_back({"only empty ones", std::vector<Aabb>(40)});
  scenes.push_back({"dense", test::random_boxes(1500, 9, 0.5f, 1)});
  scenes.push_back({"sparse", test::random_boxes(1500, 60, 0.5f, 2)});
  scenes.push_back({"lattice", lattice(12, 11, 10)});
  scenes.push_back({"line", lattice(900, 1, 1)});
  scenes.push_back({"plane", lattice(1, 35, 30)});
  scenes.push_back({"powers of two", mixed_boxes(1200, -12, 3, 8, 3)});
  scenes.push_back({"powers of ten", mixed_boxes(600, -100, 100, 1e10f, 4)});
  scenes.push_back({"clusters", clusters(1500, 5)});
  scenes.push_back({"all equal", std::vector<Aabb>(700, box_around({3, 4, 5}, {1, 2, 3}))});
  scenes.push_back({"points", std::vector<Aabb>(300, box_around({3, 4, 5}, {0, 0, 0}))});
  std::vector<Aabb> boxes = test::random_boxes(1200, 30, 0.5f, 6);
  for (std::size_t i = 0; i < boxes.size(); i += 2) boxes[i] = box_around({7, 7, 7}, {0.25f, 0.25f, 0.25f});
  scenes.push_back({"half of them in one place", boxes});
  boxes = test::random_boxes(1500, 25, 0.5f, 7);
  boxes[3] = {{-infinity, -infinity, -infinity}, {infinity, infinity, infinity}};
  boxes[700] = {{-infinity, 3, 3}, {infinity, 4, 4}};
  boxes[701] = {{infinity, 3, 3}, {infinity, 4, 4}};
  boxes[702].min.y = nan;
  boxes[703] = Aabb{};
  boxes[704] = box_around({1e30f, -1e30f, 1e38f}, {1e29f, 1, 1});
  boxes[705] = {{-3e38f, -3e38f, -3e38f}, {3e38f, 3e38f, 3e38f}};
  boxes[706] = {{-0.0f, 0.0f, -0.0f}, {0.0f, -0.0f, 0.0f}};
  scenes.push_back({"infinite, empty and far away", boxes});
  boxes = test::random_boxes(1500, 1e-3f, 2e-5f, 8);
  for (Aabb& box : boxes) box = {box.min + Vec3f{1e4f, 1e4f, 1e4f}, box.max + Vec3f{1e4f, 1e4f, 1e4f}};
  scenes.push_back({"far from the origin", boxes});
  return scenes;
}

TEST(GridSearch, FindsThePairsOfADoubleLoop) {
  // All scenes use the same searches: state kept from one scene must not affect the next.
  GridOnly one(1), three(3);
  std::size_t with_pairs = 0, crowded = 0;
  for (const test::NamedBoxes& scene : hard_scenes()) {
    const std::vector<IndexPair> expected = double_loop(scene.boxes);
    with_pairs += !expected.empty();
    ASSERT_EQ(one.find(scene.boxes), expected) << scene.name;
    ASSERT_EQ(one.find(scene.boxes), expected) << scene.name << ", second search";
    ASSERT_EQ(three.find(scene.boxes), expected) << scene.name << ", three threads";
    EXPECT_GE(one.tests(), expected.size()) << scene.name;
    if (!one.is_crowded()) continue;
    ++crowded;
    EXPECT_GT(scene.boxes.size(), 256u) << scene.name << " is not crowded";
  }
  EXPECT_GE(with_pairs, 20u);
  EXPECT_GE(crowded, 2u);
}

TEST(BroadPhase, EveryMethodFollowsHardScenes) {
  for (const test::NamedBoxes& scene : hard_scenes()) {
    for (const BroadPhaseMethod method : test::all_methods) {
      BroadPhase broad_phase({.method = method, .scene_octree = {}, .threads = 1});
      std::vector<Aabb> boxes = scene.boxes;
      for (int step = 0; step < 3; ++step) {
        const auto found = broad_phase.find_object_pairs(boxes);
        const std::vector<IndexPair> expected = double_loop(boxes);
        ASSERT_TRUE(std::equal(found.begin(), found.end(), expected.begin(), expected.end())) << scene.name;
        for (Aabb& box : boxes) box.max.x = box.max.x + 0.25f * (box.max.x - box.min.x);
      }
    }
  }
}

TEST(GridSearch, EveryInstructionSetFindsThePairsOfADoubleLoop) {
  for (const test::NamedBoxes& scene : hard_scenes()) {
    const std::vector<IndexPair> expected = double_loop(scene.boxes);
    std::uint64_t tests = 0;
    for_each_target([&](const char* name) {
      GridOnly grid(1);
      grid.find(scene.boxes);
      // The second search knows from the first whether there are many pairs.
      const std::vector<IndexPair>& found = grid.find(scene.boxes);
      EXPECT_EQ(found, expected) << scene.name << " by " << name;
      if (tests == 0) tests = grid.tests();
      EXPECT_EQ(grid.tests(), tests) << scene.name << " by " << name;
    });
  }
}

TEST(GridSearch, AdaptsToWhereBoxesAre) {
  GridOnly grid(1);
  std::vector<Aabb> boxes = test::random_boxes(3000, 40, 0.5f, 14);
  grid.find(boxes);
  const std::uint64_t tests = grid.tests();
  const auto check = [&](const char* what) {
    ASSERT_EQ(grid.find(boxes), double_loop(boxes)) << what;
    EXPECT_LT(grid.tests(), 3 * tests) << what;
  };
  for (Aabb& box : boxes) box = {box.min + Vec3f{900, 0, 0}, box.max + Vec3f{900, 0, 0}};
  check("moved aside");
  for (Aabb& box : boxes) box = {box.min * 0.01f, box.max * 0.01f};
  check("shrunk");
  for (Aabb& box : boxes) box = {box.min * 1e4f, box.max * 1e4f};
  check("grown");
}

TEST(GridSearch, ThreadsDoTheSameTests) {
  const std::vector<Aabb> boxes = clusters(20'000, 9);
  GridOnly one(1), four(4);
  const std::vector<IndexPair> expected = one.find(boxes);
  EXPECT_GT(expected.size(), 1000u);
  EXPECT_TRUE(four.find(boxes) == expected);
  EXPECT_EQ(four.tests(), one.tests());
}

TEST(GridSearch, DividesWhatIsDense) {
  // Brute force does 200 million tests here, a sweep ten million.
  const std::vector<Aabb> boxes = test::random_boxes(20'000, 27, 0.5f, 10);
  GridOnly grid(1);
  grid.find(boxes);
  EXPECT_LT(grid.tests(), 2'000'000u);
}

TEST(GridSearch, OfSpheresKeepsThoseThatOverlap) {
  const std::vector<Aabb> boxes = test::random_boxes(900, 9, 0.5f, 11);
  const std::vector<BoundingSphere> spheres = test::spheres_in(boxes);
  std::vector<Aabb> around;
  for (const BoundingSphere& sphere : spheres) around.push_back(bounding_box(sphere));
  std::vector<IndexPair> expected = double_loop(around);
  const std::size_t of_boxes = expected.size();
  std::erase_if(expected, [&](IndexPair pair) { return !overlap(spheres[pair.a], spheres[pair.b]); });
  ASSERT_LT(expected.size(), of_boxes);
  EXPECT_EQ(GridOnly(1, BoundingVolume::sphere).find({}, spheres), expected);
}

TEST(PairSorter, SortsRunsOfAnyLength) {
  const Parallel parallel(2);
  PairSorter sorter;
  for (const std::uint32_t slots : {70u, 3000u, 500'000u}) {
    Random random(slots);
    std::vector<IndexPair> expected, sorted;
    const auto lists = sorter.start(2, slots);
    for (const std::uint32_t length : {0u, 1u, 2u, 15u, 16u, 17u, 63u, 64u, 65u, 66u, 300u, 2500u}) {
      const std::uint32_t a = random.below(slots / 2);
      for (std::uint32_t i = 0; i < length; ++i) expected.push_back({a, a + 1 + random.below(slots - a - 1)});
    }
    std::sort(expected.begin(), expected.end());
    expected.erase(std::unique(expected.begin(), expected.end()), expected.end());
    std::vector<IndexPair> mixed = expected;
    for (std::size_t i = mixed.size(); i > 1; --i)
      std::swap(mixed[i - 1], mixed[random.below(static_cast<std::uint32_t>(i))]);
    const auto put = [&](PairList& list, std::size_t first, std::size_t step) {
      std::size_t count = 0;
      for (std::size_t i = first; i < mixed.size(); i += step) {
        list.first[count] = i % 3 == 0 ? mixed[i].b : mixed[i].a;
        list.second[count++] = i % 3 == 0 ? mixed[i].a : mixed[i].b;
        if (count < 100) continue;
        list.flush(count, {});
        count = 0;
      }
      list.flush(count, {});
    };
    put(lists[0], 0, 2);
    put(lists[1], 1, 2);
    sorter.finish(parallel, sorted);
    EXPECT_EQ(sorted, expected) << slots;
    const auto again = sorter.start(2, slots);
    put(again[0], 0, 1);
    put(again[1], 0, 1);
    put(again[1], 0, 3);
    sorter.finish(parallel, sorted);
    EXPECT_TRUE(std::is_sorted(sorted.begin(), sorted.end()));
    EXPECT_GT(sorted.size(), 2 * expected.size());
    sorted.erase(std::unique(sorted.begin(), sorted.end()), sorted.end());
    EXPECT_EQ(sorted, expected) << slots << ", some pairs two or three times";
  }
}

}  // namespace supple::grid_test
