#include "broad_phase/octree/scene_octree.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "broad_phase/pair_finder.hpp"
#include "supple/description.hpp"
#include "supple/error.hpp"
#include "unit/broad_phase/volume_scenes.hpp"

namespace supple::scene_octree_test {

using test::box_around;
using test::Random;

/// The octree without the other methods, with access to its counters.
class Octree {
 public:
  explicit Octree(SceneOctreeOptions options = {})
      : finder_(BroadPhaseMethod::octree, BoundingVolume::aabb, options) {}

  const BroadPhaseStats& step(const std::vector<Aabb>& boxes,
                              std::optional<std::span<const std::uint32_t>> changed = {}) {
    const auto pairs = finder_.find_pairs({.boxes = boxes, .spheres = {}, .dirty = changed}, parallel_);
    pairs_.assign(pairs.begin(), pairs.end());
    EXPECT_EQ(finder_.validate(), "");
    return finder_.stats();
  }
  const std::vector<IndexPair>& pairs() const { return pairs_; }
  std::vector<SceneRegion> regions() const { return finder_.regions(); }

 private:
  PairFinder finder_;
  Parallel parallel_{1};
  std::vector<IndexPair> pairs_;
};

class SceneOctreeArity : public testing::TestWithParam<std::uint32_t> {};

TEST_P(SceneOctreeArity, NumbersRegionsAsThePaperDoes) {
  const std::uint32_t arity = GetParam();
  const int axes_per_level = arity == 8 ? 3 : arity == 4 ? 2 : 1;
  Octree octree({.max_level = 3, .expand_at = 2, .region_sphere_test = {}, .arity = arity});
  octree.step(test::random_boxes(40, 10, 0.2f, 1));
  const std::vector<SceneRegion> regions = octree.regions();
  ASSERT_GT(regions.size(), 9u);
  std::map<std::uint64_t, SceneRegion> by_number;
  for (const SceneRegion& region : regions) by_number[region.number] = region;
  ASSERT_EQ(by_number.size(), regions.size()) << "a number is used twice";
  EXPECT_EQ(regions[0].number, 0u);
  EXPECT_FALSE(regions[0].is_leaf);
  for (const auto& [number, region] : by_number) {
    EXPECT_EQ(by_number.contains(arity * number + 1), !region.is_leaf);
    if (region.is_leaf) continue;
    EXPECT_EQ(region.object_count, 0u);
    const Vec3f middle = (region.box.min + region.box.max) * 0.5f;
    for (std::uint64_t k = 0; k < arity; ++k) {
      ASSERT_TRUE(by_number.contains(arity * number + 1 + k)) << "a region has all its children";
      const SceneRegion& child = by_number[arity * number + 1 + k];
      EXPECT_EQ(child.level, region.level + 1);
      for (int turn = 0; turn < 3; ++turn) {
        const int axis = (static_cast<int>(region.level) * axes_per_level + turn) % 3;
        if (turn >= axes_per_level) {
          EXPECT_EQ(child.box.min[axis], region.box.min[axis]) << "not halved at this level";
          EXPECT_EQ(child.box.max[axis], region.box.max[axis]);
          continue;
        }
        const bool upper = (k >> turn & 1) != 0;
        const float center = 0.5f * (child.box.min[axis] + child.box.max[axis]);
        EXPECT_EQ(center > middle[axis], upper) << "bit " << turn << " of child " << k;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Arities, SceneOctreeArity, testing::Values(2u, 4u, 8u));

TEST(SceneOctree, ExpandsWhenTwoShareARegionAndReducesWhenTheyPart) {
  Octree octree({.max_level = 4, .expand_at = 2, .region_sphere_test = {}});
  // Small objects far apart. The first two span the root cube.
  std::vector<Aabb> boxes{box_around({0, 0, 0}, {0.01f, 0.01f, 0.01f}),
                          box_around({16, 16, 16}, {0.01f, 0.01f, 0.01f}),
                          box_around({1, 15, 1}, {0.01f, 0.01f, 0.01f})};
  octree.step(boxes);
  EXPECT_EQ(octree.regions().size(), 9u) << "each of the three is alone in a region of level 1";

  boxes[2] = box_around({0.1f, 0.1f, 0.1f}, {0.01f, 0.01f, 0.01f});
  // The octree updates incrementally only if fewer than a quarter of the objects change regions.
  std::vector<Aabb> crowd = boxes;
  Octree many({.max_level = 4, .expand_at = 2, .region_sphere_test = {}});
  for (int i = 0; i < 12; ++i) crowd.push_back(box_around({12, 2, 2}, {5, 5, 5}));
  crowd[2] = box_around({1, 15, 1}, {0.01f, 0.01f, 0.01f});
  many.step(crowd);
  const std::vector<SceneRegion> before = many.regions();

  crowd[2] = boxes[2];
  const BroadPhaseStats met = many.step(crowd);
  EXPECT_EQ(met.objects_placed, 1u);
  EXPECT_EQ(met.regions_rebuilt, 0u);
  EXPECT_GE(met.regions_expanded, 1u);
  EXPECT_EQ(many.regions().size(), before.size() + 8 * met.regions_expanded);

  crowd[2] = box_around({1, 15, 1}, {0.01f, 0.01f, 0.01f});
  const BroadPhaseStats parted = many.step(crowd);
  EXPECT_EQ(parted.regions_rebuilt, 0u);
  EXPECT_GE(parted.regions_reduced, 1u);
  EXPECT_EQ(many.regions().size(), before.size());
}

TEST(SceneOctree, LooksOnlyAtWhatMoved) {
  Octree octree;
  std::vector<Aabb> boxes = test::random_boxes(2000, 30, 0.5f, 2);
  const BroadPhaseStats first = octree.step(boxes);
  EXPECT_EQ(first.objects_changed, 2000u);
  EXPECT_EQ(first.objects_placed, 2000u);
  EXPECT_EQ(first.regions_rebuilt, 1u);
  EXPECT_GT(first.regions_expanded, 0u);
  const std::vector<IndexPair> pairs = octree.pairs();

  const BroadPhaseStats still = octree.step(boxes);
  EXPECT_EQ(still.objects_changed, 0u);
  EXPECT_EQ(still.objects_placed, 0u);
  EXPECT_EQ(still.objects_paired, 0u);
  EXPECT_EQ(still.object_pairs_tested, 0u);
  EXPECT_EQ(still.regions_expanded + still.regions_reduced + still.regions_rebuilt, 0u);
  EXPECT_EQ(octree.pairs(), pairs);

  // A move this small crosses no plane, but it may change the pairs.
  const float aside = std::nextafter(boxes[5].min.x, -1.0f);
  boxes[5].min.x = aside;
  const BroadPhaseStats nudged = octree.step(boxes);
  EXPECT_EQ(nudged.objects_changed, 1u);
  EXPECT_EQ(nudged.objects_placed, 0u);
  EXPECT_EQ(nudged.objects_paired, 1u);
  EXPECT_GT(nudged.object_pairs_tested, 0u);
  EXPECT_LT(nudged.object_pairs_tested, 2000u);

  boxes[5] = box_around({29, 29, 29}, {0.5f, 0.5f, 0.5f});
  const BroadPhaseStats moved = octree.step(boxes);
  EXPECT_EQ(moved.objects_changed, 1u);
  EXPECT_EQ(moved.objects_placed, 1u);
  EXPECT_EQ(moved.regions_rebuilt, 0u);
}

TEST(SceneOctree, TrustsTheListOfChange) {
  Octree octree;
  std::vector<Aabb> boxes = test::random_boxes(300, 10, 0.5f, 3);
  octree.step(boxes);
  const std::vector<IndexPair> before = octree.pairs();
  std::vector<std::uint32_t> changed;
  const Aabb old = boxes[4];
  boxes[4] = box_around({5, 5, 5}, {4, 4, 4});
  EXPECT_EQ(octree.step(boxes, changed).objects_changed, 0u) << "objects not listed are ignored";
  EXPECT_EQ(octree.pairs(), before);
  changed = {4, 7, 4};
  EXPECT_EQ(octree.step(boxes, changed).objects_changed, 1u);
  EXPECT_GT(octree.pairs().size(), before.size());
  boxes[4] = old;
  // New slots count as changed.
  boxes.push_back(boxes[0]);
  EXPECT_EQ(octree.step(boxes, changed).objects_changed, 2u);
  EXPECT_TRUE(std::binary_search(octree.pairs().begin(), octree.pairs().end(), IndexPair{0, 300}));
}

TEST_P(SceneOctreeArity, IsTheSameHoweverItCameAbout) {
  // After many small steps, the regions equal those of a tree built once in the same cube.
  Random random(4);
  std::vector<Aabb> boxes = test::random_boxes(400, 20, 0.4f, 5);
  SceneCubeChooser chooser;
  const SceneOctreeOptions options{
      .max_level = 5, .expand_at = 3, .region_sphere_test = {}, .arity = GetParam()};
  const SceneCube cube = chooser.choose(boxes);
  const Parallel parallel(1);
  VolumeStore volumes(BoundingVolume::aabb);
  volumes.update({.boxes = boxes}, parallel);
  SceneOctree kept(BoundingVolume::aabb, options);
  kept.build(volumes, cube);
  for (int step = 0; step < 30; ++step) {
    for (Aabb& box : boxes) {
      if (random.below(3) != 0) continue;
      box = random.below(20) == 0 ? Aabb{} : box_around(random.point(-3, 23), random.point(0.01f, 0.8f));
    }
    volumes.update({.boxes = boxes}, parallel);
    for (const std::uint32_t slot : volumes.changed())
      if (!kept.stays(slot, boxes[slot])) kept.move(volumes, slot);
    kept.settle(volumes);
    ASSERT_EQ(kept.validate(volumes), "") << "step " << step;
    SceneOctree fresh(BoundingVolume::aabb, options);
    fresh.build(volumes, cube);
    const std::vector<SceneRegion> a = kept.describe(), b = fresh.describe();
    ASSERT_EQ(a.size(), b.size()) << "step " << step;
    for (std::size_t i = 0; i < a.size(); ++i) {
      ASSERT_EQ(a[i].number, b[i].number);
      ASSERT_EQ(a[i].object_count, b[i].object_count);
      ASSERT_EQ(a[i].is_leaf, b[i].is_leaf);
    }
  }
  EXPECT_GT(kept.expanded_count(), 50u);
  EXPECT_GT(kept.reduced_count(), 50u);
}

TEST(SceneOctree, CoincidentObjectsDoNotBlowUpTheRegions) {
  // The deepest tree allowed, with objects that no subdivision separates.
  const SceneOctreeOptions deepest{.max_level = 20, .expand_at = 2, .region_sphere_test = {}};
  std::vector<Aabb> boxes(600, box_around({1, 1, 1}, {0.25f, 0.25f, 0.25f}));
  Octree coincident(deepest);
  coincident.step(boxes);
  EXPECT_EQ(coincident.pairs().size(), 600u * 599u / 2);
  EXPECT_LE(coincident.regions().size(), 8u * 8u * 3u);

  // Coincident points in a scene a million times as wide: the tree is one chain of regions, at most 8 wide.
  for (Aabb& box : boxes) box = box_around({1, 1, 1}, {0, 0, 0});
  boxes.back() = box_around({1e6f, 1e6f, 1e6f}, {1, 1, 1});
  boxes[1] = boxes.back();
  for (std::size_t i = 2; i < 40; ++i) boxes[i] = boxes.back();
  Octree points(deepest);
  points.step(boxes);
  EXPECT_LE(points.regions().size(), 2u * 8u * 8u * 20u);

  // Boxes that cover the whole scene overlap every region; they expand none of them.
  std::vector<Aabb> dust = test::random_boxes(200, 10, 0.001f, 6);
  Octree without(deepest);
  without.step(dust);
  Octree with(deepest);
  dust.push_back({{-100, -100, -100}, {100, 100, 100}});
  dust.push_back({{-100, -100, -100}, {100, 100, 100}});
  dust.push_back({{-100, -100, -100}, {100, 100, 100}});
  with.step(dust);
  EXPECT_LE(with.regions().size(), without.regions().size() + without.regions().size() / 4);
}

TEST(SceneOctree, RebuildsWhenTheSceneOutgrowsTheCube) {
  Octree octree;
  std::vector<Aabb> boxes = test::random_boxes(1000, 10, 0.2f, 7);
  octree.step(boxes);
  const float edge = octree.regions()[0].box.max.x - octree.regions()[0].box.min.x;
  // All objects move apart slowly: a few of them change regions in each step, never many at once.
  std::uint64_t rebuilt = 0;
  for (int step = 0; step < 60; ++step) {
    for (Aabb& box : boxes) box = box_around((box.min + box.max) * (0.5f * 1.05f), {0.1f, 0.1f, 0.1f});
    rebuilt += octree.step(boxes).regions_rebuilt;
  }
  EXPECT_GE(rebuilt, 1u);
  EXPECT_LT(rebuilt, 60u);
  const float edge_now = octree.regions()[0].box.max.x - octree.regions()[0].box.min.x;
  EXPECT_GT(edge_now, 8 * edge);
}

TEST(SceneOctreeRoot, IsTheCubeOfTheUserWhereverTheObjectsGo) {
  std::vector<Aabb> boxes = test::random_boxes(60, 8, 0.1f, 7);
  Octree octree({.expand_at = 2, .root = RootCube{{-8, -8, -8}, 16}});
  for (int step = 0; step < 60; ++step) {
    for (Aabb& box : boxes) box = box_around((box.min + box.max) * (0.5f * 1.05f), {0.1f, 0.1f, 0.1f});
    octree.step(boxes);
    ASSERT_EQ(octree.pairs(), test::double_loop(boxes)) << step;
    const std::vector<SceneRegion> regions = octree.regions();
    ASSERT_EQ(regions[0].number, 0u);
    ASSERT_EQ(regions[0].box, (Aabb{{-8, -8, -8}, {8, 8, 8}}));
    ASSERT_EQ(regions[8].number, 8u);
    ASSERT_EQ(regions[8].box, (Aabb{{0, 0, 0}, {8, 8, 8}})) << "the octant with the largest coordinates";
  }
  EXPECT_GT(boxes[0].min.x, 8) << "the objects leave the root";
}

TEST(SceneOctreeRoot, OfAnySizeAndPlaceLosesNoPair) {
  for (const RootCube& root :
       {RootCube{{-30, -30, -30}, 60}, RootCube{{5, 5, 5}, 4}, RootCube{{100, 100, 100}, 1},
        RootCube{{9, 9, 9}, 1e-30}, RootCube{{-1e36, -1e36, -1e36}, 1e36}}) {
    Random random(8);
    std::vector<Aabb> boxes = test::random_boxes(300, 20, 0.9f, 9);
    Octree octree({.root = root});
    for (int step = 0; step < 30; ++step) {
      for (Aabb& box : boxes) {
        if (random.below(4) == 0) box = box_around(random.point(-2, 22), random.point(0.01f, 0.9f));
      }
      octree.step(boxes);  // also validates
      ASSERT_EQ(octree.pairs(), test::double_loop(boxes)) << root.edge << ", step " << step;
    }
  }
}

TEST(SceneOctreeRoot, HasNumbersInTheirRanges) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (const RootCube& root :
       {RootCube{}, RootCube{{0, 0, 0}, -1}, RootCube{{0, 0, 0}, nan}, RootCube{{nan, 0, 0}, 1},
        RootCube{{0, test::infinity, 0}, 1}, RootCube{{0, 0, 0}, test::infinity}, RootCube{{0, 0, 1e37}, 1},
        RootCube{{0, 0, 0}, 1e37}, RootCube{{0, 0, 0}, 1e-31}}) {
    try {
      BroadPhase({.method = BroadPhaseMethod::octree, .scene_octree = {.root = root}});
      ADD_FAILURE() << text_of(root);
    } catch (const Error& error) {
      EXPECT_EQ(std::string(error.what()).rfind("SceneOctreeOptions::root is ", 0), 0u) << error.what();
    }
  }
  EXPECT_THROW(BroadPhase({.method = BroadPhaseMethod::grid, .scene_octree = {.root = RootCube{{}, 1}}}),
               Error)
      << "the grid has no root";
}

TEST(SceneOctreeRoot, FitsABox) {
  EXPECT_EQ(cube_around({-1, -2, 3}, {1, 4, 4}), (RootCube{{-3, -2, 0.5}, 6}));
  EXPECT_THROW(cube_around({1, 1, 1}, {1, 1, 1}), Error);
  EXPECT_THROW(cube_around({0, 0, 0}, {1, std::numeric_limits<double>::infinity(), 1}), Error);
}

TEST(SceneCube, IsNotLedAstrayByOutliers) {
  std::vector<Aabb> boxes = test::random_boxes(1000, 10, 0.2f, 8);
  SceneCubeChooser chooser;
  const SceneCube clean = chooser.choose(boxes);
  for (std::size_t i = 0; i < 10; ++i) boxes[i * 90] = box_around({1e30f, -1e30f, 1e20f}, {1, 1, 1});
  boxes[5] = {{-test::infinity, 0, 0}, {1, 1, test::infinity}};
  const SceneCube cube = chooser.choose(boxes);
  EXPECT_LT(cube.edge, 2 * clean.edge);
  EXPECT_GT(cube.edge, 8);
  EXPECT_FALSE(is_outdated(clean, cube));
}

TEST(SceneOctree, DividesUntilLeavesAreSmallUnlessObjectsAreLarge) {
  const auto largest_leaf = [](const Octree& octree) {
    std::uint32_t largest = 0;
    for (const SceneRegion& region : octree.regions()) largest = std::max(largest, region.object_count);
    return largest;
  };
  for (const float size : {0.001f, 0.05f, 0.3f}) {
    const std::vector<Aabb> boxes = test::random_boxes(20'000, 20, size, 9);
    Octree octree;
    octree.step(boxes);
    EXPECT_LT(largest_leaf(octree), 96u) << size;
    EXPECT_LT(octree.regions().size(), 20'000u) << size;
  }
  Octree large;
  large.step(test::random_boxes(2'000, 20, 9.0f, 10));
  EXPECT_LT(large.regions().size(), 300u) << "regions are no smaller than the objects in them";
  // With few objects, regions are divided until each object is alone.
  Octree few;
  few.step(test::random_boxes(30, 20, 0.001f, 11));
  EXPECT_EQ(largest_leaf(few), 1u);
  // Coincident objects that cannot be separated do not prevent the division of the other regions.
  std::vector<Aabb> crowd(500, box_around({10, 10, 10}, {0, 0, 0}));
  const std::vector<Aabb> rest = test::random_boxes(4000, 20, 0.01f, 12);
  crowd.insert(crowd.end(), rest.begin(), rest.end());
  Octree crowded;
  crowded.step(crowd);
  EXPECT_GT(crowded.regions().size(), 100u);
}

TEST(SceneOctree, ChoosesAnewWhenObjectsBecomeMany) {
  Octree octree;
  std::vector<Aabb> boxes = test::random_boxes(20, 10, 0.05f, 13);
  octree.step(boxes);
  std::uint64_t rebuilt = 0;
  const std::vector<Aabb> all = test::random_boxes(800, 10, 0.05f, 14);
  while (boxes.size() < all.size()) {
    for (int i = 0; i < 3; ++i) boxes.push_back(all[boxes.size()]);
    rebuilt += octree.step(boxes).regions_rebuilt;
  }
  EXPECT_GE(rebuilt, 1u);
  Octree fresh;
  fresh.step(boxes);
  EXPECT_LT(octree.regions().size(), 2 * fresh.regions().size());
}

}  // namespace supple::scene_octree_test
