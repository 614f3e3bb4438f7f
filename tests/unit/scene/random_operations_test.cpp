// Long random sequences of operations: objects are added and removed, move in every supported way and change
// filters. After every step the contacts equal exact brute force, every structure is valid, and the events
// match the changes of the pairs.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "supple/inspection.hpp"
#include "support/option_word.hpp"
#include "support/scenes.hpp"
#include "support/soups.hpp"

namespace supple::random_operations_test {

/// The active pairs according to the events so far.
class EventLedger {
 public:
  void apply(const PairEvents& events) {
    std::set<ObjectPair> stayed = alive_;
    for (const ObjectPair& pair : events.end) {
      EXPECT_EQ(alive_.erase(pair), 1u) << "ended before it began";
      stayed.erase(pair);
    }
    EXPECT_TRUE(std::equal(stayed.begin(), stayed.end(), events.stay.begin(), events.stay.end()));
    for (const ObjectPair& pair : events.begin) EXPECT_TRUE(alive_.insert(pair).second) << "began twice";
  }
  const std::set<ObjectPair>& alive() const { return alive_; }

 private:
  std::set<ObjectPair> alive_;
};

struct LivingScene {
  LivingScene(const SceneOptions& options, std::uint64_t seed) : scene(options), random(seed) {}

  void add() {
    const std::uint32_t kind = random.below(4);
    const TriangleMesh mesh = kind == 0 ? crumpled_sheet(4, 3, 0.15, random.below(1000))
                                        : random_soup(random.below(30), 0.5, 0.3, random.below(1000));
    const auto build = static_cast<ObjectOctreeBuild>(random.below(3));
    const ObjectId id =
        scene.add(mesh, {.self_collision = random.below(2) == 0,
                         .octree = {.max_level = random.below(8),
                                    .leaf_size = 1 + random.below(6),
                                    .arity = build == ObjectOctreeBuild::balanced ? 8 : 2u << random.below(3),
                                    .build = build}});
    meshes.resize(std::max<std::size_t>(meshes.size(), id.index + 1));
    meshes[id.index] = mesh;
    scene.translate(id, random.vector(1));
  }

  void change(ObjectId id) {
    const TriangleMesh& mesh = meshes[id.index];
    switch (random.below(10)) {
      case 0:
        return scene.translate(id, random.vector(0.3));
      case 1:
        return scene.translate(id, random.vector(random.below(8) == 0 ? 1e31 : 3));
      case 2: {
        const double c = random.uniform(-1, 1), s = random.uniform(-1, 1);
        return scene.set_transform(id, {{c, -s, 0, s, c, 0, 0, 0, 1}, random.vector(0.7)});
      }
      case 3:
        return scene.set_transform(id, {{1, 0, 0, 0, 1, 0, 0, 0, 1}, random.vector(0.7)});
      case 4: {
        std::vector<Vec3f> moved;
        for (const Vec3d& p : mesh.positions) {
          const Vec3d q = p + random.vector(0.2);
          moved.push_back({static_cast<float>(q.x), static_cast<float>(q.y), static_cast<float>(q.z)});
        }
        return scene.set_positions(id, moved);
      }
      case 5: {
        std::vector<Vec3d> moved = mesh.positions;
        for (Vec3d& p : moved) {
          p = p + random.vector(0.2);
          if (random.below(40) == 0) p.x = std::numeric_limits<double>::quiet_NaN();
        }
        return scene.set_positions(id, moved);
      }
      case 9: {
        std::vector<std::uint32_t> ids;
        std::vector<Vec3d> moved;
        for (std::uint32_t v = 0; v < mesh.positions.size(); v += 1 + random.below(20)) {
          ids.push_back(v);
          moved.push_back(mesh.positions[v] + random.vector(0.2));
          if (random.below(60) == 0) moved.back().y = std::numeric_limits<double>::infinity();
        }
        scene.set_positions(id, mesh.positions);
        return scene.set_vertices(id, ids, moved);
      }
      case 6:
        return scene.set_options(id, {.group = 1 + random.below(3), .mask = 1 + random.below(3)});
      case 7:
        return scene.set_options(id, {.self_collision = random.below(2) == 0});
      default:
        return scene.remove(id);
    }
  }

  Scene scene;
  RandomNumbers random;
  std::vector<TriangleMesh> meshes;  // by slot
};

class RandomOperations
    : public testing::TestWithParam<std::tuple<OptionWord<BoundingVolume>, OptionWord<BroadPhaseMethod>>> {};

void expect_pairs(const std::set<ObjectPair>& expected, std::span<const ObjectPair> pairs) {
  ASSERT_TRUE(std::equal(expected.begin(), expected.end(), pairs.begin(), pairs.end()));
}

void live(const SceneOptions& options, std::uint64_t seed) {
  LivingScene life(options, seed);
  EventLedger volumes, leaves, contacts;
  std::size_t total = 0;
  for (int step = 0; step < 100; ++step) {
    SCOPED_TRACE("seed " + std::to_string(seed) + ", step " + std::to_string(step));
    const std::vector<ObjectId> objects = life.scene.objects();
    if (objects.size() < 7) life.add();
    for (const ObjectId id : objects) {
      if (life.random.below(3) == 0) life.change(id);
    }
    const DetectResult& result = life.scene.detect();
    total += result.contacts.size();
    ASSERT_EQ(differences(life.scene), "");
    ASSERT_EQ(SceneInspector(life.scene).validate(), "");
    volumes.apply(result.volume_events);
    leaves.apply(result.narrow_phase_events);
    contacts.apply(result.contact_events);
    expect_pairs(volumes.alive(), result.object_pairs);
    std::vector<ObjectPair> overlapping_leaves, touching;
    for (const CollidingVertices& group : result.colliding_vertex_groups) {
      if (group.a != group.b) overlapping_leaves.push_back({group.a, group.b});
    }
    expect_pairs(leaves.alive(), overlapping_leaves);
    for (const ContactGroup& group : result.groups) {
      if (group.a != group.b) touching.push_back({group.a, group.b});
    }
    expect_pairs(contacts.alive(), touching);
    if (testing::Test::HasFailure()) return;
  }
  EXPECT_GT(total, 500u);
}

TEST_P(RandomOperations, EveryStepEqualsBruteForce) {
  const auto [volume, method] = GetParam();
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    live({.bounding_volume = volume,
          .broad_phase = method,
          .threads = 2,
          .comparison = {.sphere_fit = seed < 3    ? SphereFit::vertices
                                       : seed == 3 ? SphereFit::minimal
                                                   : SphereFit::medial,
                         .colliding_vertices = seed % 2 == 0}},
         seed);
  }
}

std::string configuration_name(const testing::TestParamInfo<RandomOperations::ParamType>& info) {
  constexpr std::array methods{"Automatic", "Octree", "Grid", "Sweep", "Brute", "Sweep3"};
  return name_of(std::get<0>(info.param)) + methods[static_cast<std::size_t>(std::get<1>(info.param).value)];
}

constexpr std::array all_methods{BroadPhaseMethod::automatic, BroadPhaseMethod::octree,
                                 BroadPhaseMethod::grid,      BroadPhaseMethod::sweep,
                                 BroadPhaseMethod::brute,     BroadPhaseMethod::sweep3};
INSTANTIATE_TEST_SUITE_P(Configurations, RandomOperations,
                         testing::Combine(testing::Values(BoundingVolume::aabb, BoundingVolume::sphere),
                                          testing::ValuesIn(option_words(all_methods))),
                         configuration_name);
// Broad phases do not distinguish these volumes, except by their test after that of the boxes.
INSTANTIATE_TEST_SUITE_P(OtherVolumes, RandomOperations,
                         testing::Combine(testing::Values(BoundingVolume::obb, BoundingVolume::kdop14,
                                                          BoundingVolume::kdop18, BoundingVolume::kdop26),
                                          testing::Values(BroadPhaseMethod::automatic)),
                         configuration_name);

}  // namespace supple::random_operations_test
