#include "supple/broad_phase.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <vector>

#include "broad_phase/volume_store.hpp"
#include "geometry/aabb.hpp"
#include "geometry/sphere.hpp"
#include "supple/description.hpp"
#include "supple/error.hpp"
#include "unit/broad_phase/volume_scenes.hpp"

namespace supple::broad_phase_test {

using test::box_around;
using test::double_loop;
using test::infinity;
using test::Random;

const char* name_of(BroadPhaseMethod method) {
  constexpr std::array names{"automatic", "octree", "grid", "sweep", "brute", "sweep3"};
  return names[static_cast<std::size_t>(method)];
}

template <class Volume>
std::vector<IndexPair> find(BroadPhase& broad_phase, const std::vector<Volume>& volumes) {
  const auto pairs = broad_phase.find_object_pairs(std::span<const Volume>(volumes));
  return {pairs.begin(), pairs.end()};
}

/// One set of options per method, and all variants of the octree.
std::vector<BroadPhaseOptions> all_options() {
  std::vector<BroadPhaseOptions> all;
  const auto octree = [](const SceneOctreeOptions& options) {
    return BroadPhaseOptions{.method = BroadPhaseMethod::octree, .scene_octree = options, .threads = 1};
  };
  for (const BroadPhaseMethod method : test::all_methods)
    all.push_back({.method = method, .scene_octree = {}, .threads = 1});
  for (const RegionSphereTest test : {RegionSphereTest::arvo, RegionSphereTest::grown_box})
    for (const std::uint32_t max_level : {0u, 1u, 4u, 20u})
      for (const std::uint32_t expand_at : {0u, 2u, 9u})
        all.push_back(octree({.max_level = max_level, .expand_at = expand_at, .region_sphere_test = test}));
  for (const RegionSphereTest test : {RegionSphereTest::arvo, RegionSphereTest::grown_box})
    for (const std::uint32_t max_level : {0u, 1u, 20u})
      for (const std::uint32_t arity : {2u, 4u})
        all.push_back(
            octree({.max_level = max_level, .expand_at = 2, .region_sphere_test = test, .arity = arity}));
  // The paper's Figure 2 to the letter.
  for (const RegionSphereTest test : {RegionSphereTest::arvo, RegionSphereTest::grown_box})
    for (const std::uint32_t max_level : {1u, 2u, 4u})
      for (const std::uint32_t min_level : {0u, 1u, 3u})
        for (const std::uint32_t arity : {2u, 8u})
          all.push_back(octree({.max_level = max_level,
                                .expand_at = 2,
                                .region_sphere_test = test,
                                .expand_for_large_objects = true,
                                .min_level = min_level,
                                .arity = arity}));
  // Roots around many objects, around few, beside all, smaller and larger than all, and far away.
  for (const RootCube& root : {RootCube{{-10, -10, -10}, 20}, RootCube{{0, 0, 0}, 1},
                               RootCube{{1e6, 1e6, -1e6}, 3}, RootCube{{0.1, 0.2, 0.3}, 1e-30},
                               RootCube{{-1e36, -1e36, -1e36}, 1e36}, RootCube{{1e36, 0, 0}, 1e-30}})
    for (const RegionSphereTest test : {RegionSphereTest::arvo, RegionSphereTest::grown_box})
      for (const std::uint32_t arity : {2u, 8u})
        all.push_back(octree({.expand_at = 2, .region_sphere_test = test, .arity = arity, .root = root}));
  return all;
}

std::string describe(const BroadPhaseOptions& options) {
  return std::string(name_of(options.method)) + " max_level " +
         std::to_string(options.scene_octree.max_level) + " expand_at " +
         std::to_string(options.scene_octree.expand_at) + " sphere test " +
         std::to_string(static_cast<int>(options.scene_octree.region_sphere_test)) + " arity " +
         std::to_string(options.scene_octree.arity) +
         (options.scene_octree.root ? " root " + text_of(*options.scene_octree.root) : "");
}

TEST(BroadPhase, EveryMethodFindsTheBoxPairsOfADoubleLoop) {
  for (const test::NamedBoxes& scene : test::box_scenes()) {
    const std::vector<IndexPair> expected = double_loop(scene.boxes);
    for (const BroadPhaseOptions& options : all_options()) {
      BroadPhase broad_phase(options);
      ASSERT_EQ(find(broad_phase, scene.boxes), expected) << scene.name << ", " << describe(options);
      ASSERT_EQ(broad_phase.validate(), "") << scene.name << ", " << describe(options);
      // The second call reuses the state of the first.
      ASSERT_EQ(find(broad_phase, scene.boxes), expected) << scene.name << ", " << describe(options);
    }
  }
}

TEST(BroadPhase, EveryMethodFindsTheSpherePairsOfADoubleLoop) {
  for (const test::NamedBoxes& scene : test::box_scenes()) {
    const std::vector<BoundingSphere> spheres = test::spheres_in(scene.boxes);
    const std::vector<IndexPair> expected = double_loop(spheres);
    for (const BroadPhaseOptions& options : all_options()) {
      BroadPhase broad_phase(options);
      ASSERT_EQ(find(broad_phase, spheres), expected) << scene.name << ", " << describe(options);
      ASSERT_EQ(broad_phase.validate(), "") << scene.name << ", " << describe(options);
      ASSERT_EQ(find(broad_phase, spheres), expected) << scene.name << ", " << describe(options);
    }
  }
}

TEST(BroadPhase, ScenesOfTheTestsHavePairs) {
  std::size_t with_pairs = 0;
  for (const test::NamedBoxes& scene : test::box_scenes()) with_pairs += !double_loop(scene.boxes).empty();
  EXPECT_GE(with_pairs, 13u);
}

TEST(BroadPhase, TouchingCounts) {
  const std::vector<Aabb> boxes{
      {{0, 0, 0}, {1, 1, 1}}, {{1, 1, 1}, {2, 2, 2}}, {{std::nextafter(1.0f, 2.0f), 0, 0}, {2, 1, 1}}};
  for (const BroadPhaseOptions& options : all_options()) {
    BroadPhase broad_phase(options);
    EXPECT_EQ(find(broad_phase, boxes), (std::vector<IndexPair>{{0, 1}, {1, 2}})) << describe(options);
  }
  const std::vector<BoundingSphere> spheres{{{0, 0, 0}, 1}, {{3, 0, 0}, 2}, {{3, 4.001f, 0}, 2}};
  for (const BroadPhaseOptions& options : all_options()) {
    BroadPhase broad_phase(options);
    EXPECT_EQ(find(broad_phase, spheres), (std::vector<IndexPair>{{0, 1}})) << describe(options);
  }
}

TEST(BroadPhase, TouchingSpheresOfAnySizeShareARegion) {
  // Pairs at the limit of the sphere test: the placement in regions must not be stricter than that test.
  Random random(11);
  std::vector<BoundingSphere> spheres;
  for (int i = 0; i < 200; ++i) {
    const Vec3f center = random.point(-100, 100);
    const float radius = std::ldexp(random.uniform(0.5f, 1), -static_cast<int>(random.below(30)));
    const float reach = random.uniform(0.5f, 8);
    spheres.push_back({center, radius});
    // A second sphere that touches the first along one axis, as exactly as floats allow.
    const int axis = static_cast<int>(random.below(3));
    Vec3f beside = center;
    beside[axis] += radius + reach;
    spheres.push_back({beside, static_cast<float>(std::fabs(double{beside[axis]} - center[axis]) - radius)});
  }
  const std::vector<IndexPair> expected = double_loop(spheres);
  ASSERT_GE(expected.size(), 100u);
  for (const BroadPhaseOptions& options : all_options()) {
    BroadPhase broad_phase(options);
    ASSERT_EQ(find(broad_phase, spheres), expected) << describe(options);
  }
}

TEST(BroadPhase, SpheresThatAreNotFiniteFollowTheSphereTest) {
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  std::vector<BoundingSphere> spheres = test::spheres_in(test::random_boxes(60, 8, 0.6f, 12));
  spheres[2] = {{infinity, 0, 0}, 1};
  spheres[9] = {{infinity, 5, 5}, 2};
  spheres[17] = {{0, 0, 0}, infinity};
  spheres[23] = {{-infinity, infinity, 0}, 1};
  spheres[31] = {{nan, 0, 0}, 1};
  spheres[40] = {{1e30f, 1e30f, 1e30f}, 3e38f};
  spheres[41] = {{0, 0, 0}, -1};
  const std::vector<IndexPair> expected = double_loop(spheres);
  for (const BroadPhaseOptions& options : all_options()) {
    BroadPhase broad_phase(options);
    EXPECT_EQ(find(broad_phase, spheres), expected) << describe(options);
    EXPECT_EQ(find(broad_phase, spheres), expected) << describe(options);
  }
}

TEST(BroadPhase, ABoxWithANanIsEmpty) {
  std::vector<Aabb> boxes(4, box_around({0, 0, 0}, {1, 1, 1}));
  boxes[1].max.y = std::numeric_limits<float>::quiet_NaN();
  for (const BroadPhaseOptions& options : all_options()) {
    BroadPhase broad_phase(options);
    EXPECT_EQ(find(broad_phase, boxes), (std::vector<IndexPair>{{0, 2}, {0, 3}, {2, 3}}))
        << describe(options);
  }
}

/// Boxes that drift, jump, change size, appear and disappear. The kind of motion changes every 10 steps.
class MovingBoxes {
 public:
  MovingBoxes() : boxes_(test::random_boxes(140, 10, 0.5f, 21)), random_(22) {}
  const std::vector<Aabb>& boxes() const { return boxes_; }

  void step(int step) {
    const int gait = step / 10 % 6;
    for (Aabb& box : boxes_) {
      const bool moves = gait == 0 || gait == 5 || (gait == 1 && random_.below(40) == 0) ||
                         (gait == 2 && random_.below(4) == 0);
      if (!moves || box.empty()) continue;
      const float stretch = random_.uniform(0.8f, 1.25f);
      const Vec3f center = (box.min + box.max) * 0.5f + random_.point(-0.3f, 0.3f);
      Vec3f half = (box.max - box.min) * (0.5f * stretch);
      for (int axis = 0; axis < 3; ++axis) half[axis] = std::clamp(half[axis], 0.02f, 3.0f);
      box = gait == 5 && random_.below(3) == 0 ? box_around(random_.point(-40, 40), half)
                                               : box_around(center, half);
    }
    if (gait == 3) boxes_[random_.below(static_cast<std::uint32_t>(boxes_.size()))] = Aabb{};
    if (gait == 3 || gait == 4) {
      const Vec3f center = random_.point(0, 12);
      for (Aabb& box : boxes_)
        if (box.empty()) box = box_around(center, {0.4f, 0.4f, 0.4f});
      boxes_.push_back(box_around(random_.point(0, 12), random_.point(0.1f, 0.6f)));
    }
    if (step == 75) boxes_.resize(boxes_.size() / 2);
    if (step == 120) boxes_[7] = box_around({6, 6, 6}, {1e4f, 1e4f, 1e4f});
    if (step == 140) boxes_.clear();
    if (step == 143) boxes_ = test::random_boxes(160, 2000, 60, 23);
    if (step == 190)
      for (Aabb& box : boxes_) box = box_around({1, 1, 1}, {1, 1, 1});
  }

 private:
  std::vector<Aabb> boxes_;
  Random random_;
};

TEST(BroadPhase, FollowsMovingBoxesForManySteps) {
  std::vector<BroadPhase> kept;
  const std::vector<BroadPhaseOptions> options = all_options();
  for (const BroadPhaseOptions& option : options) kept.emplace_back(option);
  MovingBoxes world;
  for (int step = 0; step < 80; ++step) {
    world.step(step);
    const std::vector<IndexPair> expected = double_loop(world.boxes());
    for (std::size_t i = 0; i < kept.size(); ++i) {
      ASSERT_EQ(find(kept[i], world.boxes()), expected) << "step " << step << ", " << describe(options[i]);
      ASSERT_EQ(kept[i].validate(), "") << "step " << step << ", " << describe(options[i]);
    }
  }
}

TEST(BroadPhase, FollowsMovingSpheresForManySteps) {
  std::vector<BroadPhase> kept;
  const std::vector<BroadPhaseOptions> options = all_options();
  for (const BroadPhaseOptions& option : options) kept.emplace_back(option);
  MovingBoxes world;
  for (int step = 0; step < 80; ++step) {
    world.step(step);
    const std::vector<BoundingSphere> spheres = test::spheres_in(world.boxes());
    const std::vector<IndexPair> expected = double_loop(spheres);
    for (std::size_t i = 0; i < kept.size(); ++i) {
      ASSERT_EQ(find(kept[i], spheres), expected) << "step " << step << ", " << describe(options[i]);
      ASSERT_EQ(kept[i].validate(), "") << "step " << step << ", " << describe(options[i]);
    }
  }
}

TEST(BroadPhase, AnyNumberOfThreadsGivesTheSamePairs) {
  // More objects than one thread receives in one chunk.
  std::vector<Aabb> boxes = test::random_boxes(9'000, 30, 0.6f, 31);
  const std::vector<BoundingSphere> spheres = test::spheres_in(boxes);
  BroadPhase reference_boxes({.method = BroadPhaseMethod::brute, .scene_octree = {}, .threads = 1});
  const std::vector<IndexPair> box_pairs = find(reference_boxes, boxes);
  const std::vector<IndexPair> sphere_pairs = find(reference_boxes, spheres);
  ASSERT_GT(box_pairs.size(), 2'000u);
  for (const BroadPhaseMethod method : test::all_methods) {
    for (const std::uint32_t threads : {1u, 2u, 3u, 8u}) {
      BroadPhase broad_phase({.method = method, .scene_octree = {}, .threads = threads});
      EXPECT_TRUE(find(broad_phase, boxes) == box_pairs) << name_of(method) << " with " << threads;
      EXPECT_TRUE(find(broad_phase, spheres) == sphere_pairs) << name_of(method) << " with " << threads;
    }
  }
}

TEST(BroadPhase, SortsThePairsOfVolumesThatHaveMany) {
  // Most bins are sorted by digits, and those of the small boxes in the second half by runs.
  std::vector<Aabb> boxes = test::random_boxes(5'000, 10, 3.0f, 34);
  for (std::size_t i = boxes.size() / 2; i < boxes.size(); ++i)
    boxes[i].max = boxes[i].min + 0.05f * (boxes[i].max - boxes[i].min);
  const std::vector<IndexPair> expected = double_loop(boxes);
  ASSERT_GT(expected.size(), 30 * boxes.size());
  for (const std::uint32_t threads : {1u, 3u}) {
    BroadPhase broad_phase({.method = BroadPhaseMethod::automatic, .scene_octree = {}, .threads = threads});
    EXPECT_TRUE(find(broad_phase, boxes) == expected) << threads;
  }
}

TEST(BroadPhase, AnyNumberOfThreadsDoesTheSameWork) {
  std::vector<BroadPhase> kept;
  for (const BroadPhaseMethod method : test::all_methods)
    for (const std::uint32_t threads : {1u, 2u, 8u})
      kept.emplace_back(BroadPhaseOptions{method, {}, threads});
  Random random(32);
  std::vector<Aabb> boxes = test::random_boxes(8'000, 40, 0.6f, 33);
  for (int step = 0; step < 6; ++step) {
    for (Aabb& box : boxes) {
      if (step % 2 == 1 && random.below(50) != 0) continue;
      const Vec3f by = random.point(-0.2f, 0.2f);
      box = {box.min + by, box.max + by};
    }
    std::vector<IndexPair> expected;
    for (std::size_t i = 0; i < kept.size(); ++i) {
      const std::vector<IndexPair> found = find(kept[i], boxes);
      if (i == 0) expected = found;
      EXPECT_TRUE(found == expected) << "step " << step;
      const BroadPhase& one_thread = kept[i / 3 * 3];
      EXPECT_EQ(kept[i].stats().object_pairs_tested, one_thread.stats().object_pairs_tested)
          << "step " << step << ", contestant " << i;
    }
  }
}

TEST(BroadPhase, SwitchingBetweenBoxesAndSpheresStartsAfresh) {
  const std::vector<Aabb> boxes = test::random_boxes(100, 5, 0.5f, 41);
  const std::vector<BoundingSphere> spheres = test::spheres_in(boxes);
  for (const BroadPhaseOptions& options : all_options()) {
    BroadPhase broad_phase(options);
    EXPECT_EQ(find(broad_phase, boxes), double_loop(boxes));
    EXPECT_EQ(find(broad_phase, spheres), double_loop(spheres));
    EXPECT_EQ(find(broad_phase, boxes), double_loop(boxes));
  }
}

TEST(BroadPhase, RefusesOptionsOutOfRange) {
  BroadPhaseOptions options;
  options.scene_octree.max_level = 21;
  EXPECT_THROW(BroadPhase{options}, Error);
  options.scene_octree.max_level = 20;
  options.scene_octree.expand_at = 1;
  EXPECT_THROW(BroadPhase{options}, Error);
  options.scene_octree.expand_at = 2;
  EXPECT_NO_THROW(BroadPhase{options});
  options.scene_octree.arity = 6;
  EXPECT_THROW(BroadPhase{options}, Error);
  options.scene_octree.arity = 8;
  options.method = static_cast<BroadPhaseMethod>(9);
  EXPECT_THROW(BroadPhase{options}, Error);
}

TEST(BroadPhase, RefusesOptionsThatHaveNoEffectWithTheMethod) {
  const std::vector<SceneOctreeOptions> not_default{
      {.max_level = 3}, {.expand_at = 4}, {.region_sphere_test = RegionSphereTest::grown_box}, {.arity = 2}};
  for (const BroadPhaseMethod method : test::all_methods) {
    const bool has_octree = method == BroadPhaseMethod::automatic || method == BroadPhaseMethod::octree;
    EXPECT_NO_THROW(BroadPhase({.method = method}));
    for (const SceneOctreeOptions& octree : not_default) {
      try {
        BroadPhase broad_phase({.method = method, .scene_octree = octree});
        EXPECT_TRUE(has_octree) << name_of(method);
      } catch (const Error& error) {
        EXPECT_FALSE(has_octree) << name_of(method);
        EXPECT_NE(std::string(error.what()).find(name_of(method)), std::string::npos) << error.what();
      }
    }
  }
}

TEST(BroadPhase, SaysWhichMethodRan) {
  const std::vector<Aabb> boxes = test::random_boxes(200, 8, 0.5f, 61);
  for (const BroadPhaseMethod method : test::all_methods) {
    BroadPhase broad_phase({.method = method});
    broad_phase.find_object_pairs(boxes);
    const auto expected = method == BroadPhaseMethod::automatic ? BroadPhaseMethod::grid : method;
    EXPECT_EQ(broad_phase.stats().method, expected);
    EXPECT_EQ(broad_phase.regions().empty(), method != BroadPhaseMethod::octree);
    broad_phase.find_object_pairs(boxes);
    EXPECT_EQ(broad_phase.stats().method, expected) << "nothing changed, so no method ran again";
    EXPECT_EQ(broad_phase.stats().objects_changed, 0u);
  }
}

TEST(BoundingBox, OfTouchingSpheresTouch) {
  // Radii far below the spacing of floats at the centre: rounding must not separate the boxes.
  const BoundingSphere at{{1e6f, 0, 0}, 1e-30f}, there{{1e6f, 1e-30f, 0}, 1e-30f};
  ASSERT_TRUE(overlap(at, there));
  EXPECT_TRUE(overlap(bounding_box(at), bounding_box(there)));
  EXPECT_TRUE(bounding_box(BoundingSphere{}).empty());
}

}  // namespace supple::broad_phase_test
