// A distributed scene equals one `Scene` on one rank: random lives of scenes whose objects are on different
// ranks or in parts, appear, vanish, change their rank, crowd into a corner, and have broken coordinates.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <numeric>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "compare_results.hpp"
#include "random_lives.hpp"
#include "supple/distributed.hpp"
#include "supple/models.hpp"
#include "supple/scene.hpp"

namespace supple {
namespace {

/// How many lives each test has; the long test has more.
std::uint64_t life_count() {
  const char* const given = std::getenv("SUPPLE_LIVES");
  return given != nullptr ? static_cast<std::uint64_t>(std::atoi(given)) : 2;
}

DistributedOptions small_clusters() {
  DistributedOptions options;
  options.cluster_triangles = 16;
  options.scene.threads = 1;
  return options;
}

void live(std::uint64_t seed, ContactKinds contacts, const DistributedOptions& options, int steps) {
  Lives lives(seed, options);
  const bool is_deep = contains(contacts, ContactKinds::penetration);
  for (int i = 0; i < 6; ++i) lives.add_object(is_deep);
  for (int step = 0; step < steps; ++step) {
    const std::uint32_t what = lives.random.below(7);
    if (what == 0) lives.add_object(is_deep);
    if (what == 1) lives.remove_object();
    if (what == 2) lives.change_ranks();
    if (what == 3) lives.change_settings(!is_deep);
    lives.move_objects(lives.random.below(6) == 0);
    const DetectResult& expected = lives.plain.detect({.contacts = contacts, .curves = is_deep});
    const DetectResult& found = lives.distributed.detect({.contacts = contacts, .curves = is_deep});
    for (const auto count : {&StepStats::object_pairs, &StepStats::contacts, &StepStats::proximity_pairs,
                             &StepStats::penetrations, &StepStats::curves})
      EXPECT_EQ(found.stats.*count, expected.stats.*count);
    if (lives.distributed.rank() == 0)
      expect_same(found, expected, "seed " + std::to_string(seed) + " step " + std::to_string(step));
    int failed = testing::Test::HasFailure() ? 1 : 0;
    MPI_Bcast(&failed, 1, MPI_INT, 0, MPI_COMM_WORLD);
    if (failed != 0) return;
  }
}

/// Each step of random lives equals that of one scene.
void live_all(ContactKinds contacts, const DistributedOptions& options) {
  for (std::uint64_t seed = 1; seed <= life_count(); ++seed)
    live(100 * static_cast<std::uint64_t>(contacts) + seed, contacts, options, 10);
}

TEST(DistributedScene, IntersectionsEqualOneScene) {
  live_all(ContactKinds::intersection, small_clusters());
}
TEST(DistributedScene, ContinuousContactsEqualOneScene) {
  live_all(ContactKinds::continuous, small_clusters());
}
TEST(DistributedScene, ProximityEqualsOneScene) {
  live_all(ContactKinds::proximity, small_clusters());
}
TEST(DistributedScene, ElementsOfProximityEqualOneScene) {
  DistributedOptions options = small_clusters();
  options.scene.proximity_listing = ProximityListing::elements;
  live_all(ContactKinds::proximity, options);
}
TEST(DistributedScene, PenetrationEqualsOneScene) {
  live_all(ContactKinds::penetration, small_clusters());
}
TEST(DistributedScene, AllKindsEqualOneScene) {
  const ContactKinds kinds = ContactKinds::intersection | ContactKinds::continuous | ContactKinds::proximity;
  live_all(kinds, small_clusters());
  live_all(kinds | ContactKinds::penetration, small_clusters());
}

/// Each contact is on exactly one rank, and each list is in canonical order.
void expect_spread(ResultPlacement placement) {
  DistributedOptions options = small_clusters();
  options.results = placement;
  std::uint64_t ranks_with_contacts = 0, contacts = 0;
  for (std::uint64_t seed = 61; seed < 61 + life_count(); ++seed) {
    Lives lives(seed, options);
    for (int i = 0; i < 8; ++i) lives.add_object(false);
    for (int step = 0; step < 6; ++step) {
      lives.move_objects(step == 3);
      const DetectResult& expected = lives.plain.detect();
      const DetectResult& found = lives.distributed.detect();
      const auto key = [](const Contact& c) {
        return std::tuple(c.object_a, c.object_b, c.triangle_a, c.triangle_b);
      };
      ASSERT_TRUE(std::is_sorted(found.contacts.begin(), found.contacts.end(),
                                 [&](const Contact& p, const Contact& q) { return key(p) < key(q); }));
      for (const Contact& contact : found.contacts) {
        const auto same =
            std::lower_bound(expected.contacts.begin(), expected.contacts.end(), contact,
                             [&](const Contact& p, const Contact& q) { return key(p) < key(q); });
        ASSERT_NE(same, expected.contacts.end());
        ASSERT_EQ(key(*same), key(contact));
        ASSERT_EQ(same->normal, contact.normal);
        const auto p = found.points_of(contact), q = expected.points_of(*same);
        ASSERT_TRUE(std::equal(p.begin(), p.end(), q.begin(), q.end()));
        if (placement != ResultPlacement::owner) continue;
        const auto owner = std::find_if(lives.objects.begin(), lives.objects.end(),
                                        [&](const LivingObject& o) { return o.id == contact.object_a; });
        const int home = owner->rank_of_triangle.empty() ? owner->home
                                                         : *std::min_element(owner->rank_of_triangle.begin(),
                                                                             owner->rank_of_triangle.end());
        ASSERT_EQ(home, lives.distributed.rank());
      }
      std::uint64_t totals[] = {found.contacts.size(), found.object_pairs.size(), !found.contacts.empty()};
      MPI_Allreduce(MPI_IN_PLACE, totals, 3, MPI_UINT64_T, MPI_SUM, MPI_COMM_WORLD);
      ASSERT_EQ(totals[0], expected.contacts.size());
      ASSERT_EQ(totals[1], expected.object_pairs.size());
      contacts += totals[0];
      ranks_with_contacts = std::max(ranks_with_contacts, totals[2]);
    }
  }
  EXPECT_GT(contacts, 100u);
  EXPECT_EQ(ranks_with_contacts > 1, size_of_world() > 1);
}

TEST(DistributedScene, SpreadResultsAreOnOneRankEach) {
  expect_spread(ResultPlacement::spread);
}
TEST(DistributedScene, ResultsAreOnTheRankOfObjectA) {
  expect_spread(ResultPlacement::owner);
}

TEST(DistributedScene, EarliestImpactsEqualOneScene) {
  int impacts = 0;
  for (std::uint64_t seed = 71; seed < 72 + 2 * life_count(); ++seed) {
    Lives lives(seed, small_clusters());
    for (int i = 0; i < 6; ++i) lives.add_object(false);
    for (int step = 0; step < 4; ++step) {
      lives.move_objects(false);
      const auto expected = lives.plain.earliest_impact();
      EXPECT_EQ(lives.distributed.earliest_impact(), expected) << "seed " << seed << " step " << step;
      EXPECT_EQ(lives.distributed.max_step(), lives.plain.max_step());
      impacts += expected.has_value() ? 1 : 0;
    }
  }
  EXPECT_GT(impacts, 1);
}

/// Scenes of no, one or two objects, which often have nothing to test.
TEST(DistributedScene, UntestedKindsEqualOneScene) {
  std::set<NothingToTest> reasons;
  for (std::uint64_t seed = 111; seed < 141 + 4 * life_count(); ++seed) {
    const bool is_deep = seed % 2 == 0;
    const ContactKinds kinds = ContactKinds::intersection | ContactKinds::continuous |
                               ContactKinds::proximity |
                               (is_deep ? ContactKinds::penetration : ContactKinds::none);
    Lives lives(seed, small_clusters());
    for (int step = 0; step < 5; ++step) {
      if (lives.objects.size() < 2 && step % 2 == 1) lives.add_object(is_deep);
      lives.move_objects(false);
      for (int i = 0; i < 3; ++i) lives.change_settings(!is_deep);
      const DetectResult& expected = lives.plain.detect({.contacts = kinds});
      const DetectResult& found = lives.distributed.detect({.contacts = kinds});
      expect_same<UntestedKind>("untested", found.untested, expected.untested,
                                "seed " + std::to_string(seed) + " step " + std::to_string(step));
      for (const UntestedKind& untested : expected.untested) reasons.insert(untested.reason);
    }
  }
  for (const NothingToTest reason :
       {NothingToTest::no_objects, NothingToTest::one_object, NothingToTest::no_motion,
        NothingToTest::no_margin, NothingToTest::no_solid, NothingToTest::all_static, NothingToTest::groups,
        NothingToTest::filter})
    EXPECT_TRUE(reasons.contains(reason)) << static_cast<int>(reason);
}

/// A fan of triangles in parts, which tests itself unless no element is finite.
TEST(DistributedScene, AFanInPartsIsUntestedWithoutFiniteElements) {
  const auto ranks = static_cast<std::uint32_t>(size_of_world()),
             rank = static_cast<std::uint32_t>(rank_of_world());
  constexpr std::uint32_t count = 12;
  std::vector<Vec3d> corners{{0, 0, 0}};
  std::vector<Triangle> fan;
  for (std::uint32_t i = 0; i < count; ++i) {
    corners.push_back({1.0 + i, 1.0 * i * i, 1});
    if (i > 0) fan.push_back({0, i, i + 1});
  }
  Scene plain;
  DistributedScene distributed(MPI_COMM_WORLD);
  const ObjectOptions options{.name = "fan", .self_collision = true};
  const ObjectId id = plain.add(corners, fan, options);
  std::vector<std::uint32_t> vertices(corners.size()), mine;
  std::iota(vertices.begin(), vertices.end(), 0u);
  std::vector<Triangle> triangles;
  for (std::uint32_t t = rank; t < fan.size(); t += ranks) {
    mine.push_back(t);
    triangles.push_back(fan[t]);
  }
  distributed.add_part(id, corners, triangles, {vertices, mine}, options);
  const auto compare = [&] {
    const auto expected = plain.detect().untested, found = distributed.detect().untested;
    expect_same<UntestedKind>("untested", found, expected, "");
    return expected.empty() ? -1 : static_cast<int>(expected[0].reason);
  };
  EXPECT_EQ(compare(), -1);
  for (Vec3d& p : corners) p.x = std::numeric_limits<double>::quiet_NaN();
  plain.set_positions(id, corners);
  distributed.set_positions(id, corners);
  EXPECT_EQ(compare(), static_cast<int>(NothingToTest::not_finite));
}

TEST(DistributedScene, SafeStepsEqualOneScene) {
  int limited = 0, whole = 0;
  for (std::uint64_t seed = 81; seed < 85 + 2 * life_count(); ++seed) {
    Lives lives(seed, small_clusters());
    for (int i = 0; i < 5; ++i) lives.add_object(false);
    for (int step = 0; step < 4; ++step) {
      lives.move_objects(false, true);  // a vertex far away makes all pairs near
      if (lives.random.below(2) == 0) lives.change_settings(true);
      const StepOptions options{.keep = lives.random.uniform(0, 0.9)};
      const SafeStep expected = lives.plain.collision_free_step(options);
      EXPECT_EQ(lives.distributed.collision_free_step(options), expected)
          << "seed " << seed << " step " << step;
      (expected.step > 0 && expected.step < 1 ? limited : whole) += 1;
    }
  }
  EXPECT_GT(limited, 1);
  EXPECT_GT(whole, 1);
}

/// All records of the ranks, in order, on rank 0.
template <class Row>
std::vector<Row> gathered(const std::vector<Row>& rows) {
  const int bytes = static_cast<int>(rows.size() * sizeof(Row));
  std::vector<int> sizes(static_cast<std::size_t>(size_of_world())), starts = sizes;
  MPI_Gather(&bytes, 1, MPI_INT, sizes.data(), 1, MPI_INT, 0, MPI_COMM_WORLD);
  std::exclusive_scan(sizes.begin(), sizes.end(), starts.begin(), 0);
  std::vector<Row> all(static_cast<std::size_t>(starts.back() + sizes.back()) / sizeof(Row));
  MPI_Gatherv(rows.data(), bytes, MPI_BYTE, all.data(), sizes.data(), starts.data(), MPI_BYTE, 0,
              MPI_COMM_WORLD);
  return all;
}

TEST(DistributedScene, DistancesEqualOneScene) {
  std::size_t apart = 0, touching = 0;
  for (const ResultPlacement placement : {ResultPlacement::gathered, ResultPlacement::owner}) {
    DistributedOptions options = small_clusters();
    options.results = placement;
    for (std::uint64_t seed = 91; seed < 92 + life_count(); ++seed) {
      Lives lives(seed, options);
      for (int i = 0; i < 6; ++i) lives.add_object(false);
      for (int step = 0; step < 4; ++step) {
        lives.move_objects(step == 2);
        if (step == 3) lives.change_settings(true);
        for (const double most : {0.0, 0.3, 5.0, std::numeric_limits<double>::infinity()}) {
          const std::vector<ProximityPair> expected = lives.plain.distances(most);
          std::vector<ProximityPair> found = gathered(lives.distributed.distances(most));
          if (placement == ResultPlacement::owner)
            std::sort(found.begin(), found.end(), [](const ProximityPair& p, const ProximityPair& q) {
              return std::pair(p.object_a, p.object_b) < std::pair(q.object_a, q.object_b);
            });
          if (rank_of_world() == 0) expect_same<ProximityPair>("distances", found, expected, "");
          for (const ProximityPair& pair : expected) (pair.distance > 0 ? apart : touching) += 1;
        }
      }
    }
  }
  EXPECT_GT(apart, 20u);
  EXPECT_GT(touching, 5u);
}

/// Points near and far, at vertices and in the middle between two objects, others on each rank.
std::vector<Vec3d> points_near(Lives& lives) {
  RandomNumbers random(1000 + static_cast<std::uint64_t>(rank_of_world()));
  std::vector<Vec3d> points{{0, 0, 0}, {1e6, -1e6, 3}, {1e30, 0, 0}, {1e300, 1e300, 0}};
  points.push_back({std::numeric_limits<double>::quiet_NaN(), 0, 0});
  for (int i = 0; i < 40; ++i) points.push_back(random.vector(4));
  for (const LivingObject& object : lives.objects) {
    points.push_back(object.now[random.below(static_cast<std::uint32_t>(object.now.size()))]);
    points.push_back(0.5 * (object.place + lives.objects.front().place));
  }
  return points;
}

TEST(DistributedScene, ClosestPointsEqualOneScene) {
  std::size_t found_any = 0;
  for (std::uint64_t seed = 101; seed < 102 + life_count(); ++seed) {
    Lives lives(seed, small_clusters());
    for (int i = 0; i < 6; ++i) lives.add_object(false);
    for (int step = 0; step < 4; ++step) {
      lives.move_objects(step == 2);
      const std::vector<Vec3d> points = points_near(lives);
      std::vector<ClosestOptions> searches(4);
      searches[1].max_distance = 0.4;
      searches[2].filter.mask = 2;
      searches[3].filter.object = lives.objects[1].id;
      for (const ClosestOptions& options : searches) {
        std::vector<std::optional<ClosestPoint>> expected(points.size()), found(points.size());
        lives.plain.closest(points, expected, options);
        lives.distributed.closest(points, found, options);
        for (std::size_t i = 0; i < points.size(); ++i)
          ASSERT_EQ(found[i], expected[i]) << "seed " << seed << " step " << step << " point " << i;
        found_any += static_cast<std::size_t>(std::count_if(
            found.begin(), found.end(), [](const auto& closest) { return closest.has_value(); }));
      }
    }
  }
  EXPECT_GT(found_any, 100u);
}

/// Points at the same distance of two triangles that are in different clusters, on different ranks.
TEST(DistributedScene, TheFirstOfTrianglesAtTheSameDistance) {
  const TriangleMesh ball = make_icosphere(6);
  const auto ranks = static_cast<std::uint32_t>(size_of_world());
  Scene plain;
  DistributedScene distributed(MPI_COMM_WORLD, small_clusters());
  std::vector<Vec3d> centers, points;
  for (std::uint32_t i = 0; i < 8; ++i) {
    std::vector<Vec3d> positions = ball.positions;
    for (Vec3d& p : positions) p.x += 3.0 * i;
    const ObjectId id = plain.add(positions, ball.triangles);
    if (i % ranks == static_cast<std::uint32_t>(rank_of_world()))
      distributed.add(id, positions, ball.triangles);
    points.push_back({3.0 * i, 0, 0});
    points.push_back({3.0 * i + 1.5, 0, 0});
    points.insert(points.end(), positions.begin(), positions.begin() + 40);
  }
  std::vector<std::optional<ClosestPoint>> expected(points.size()), found(points.size());
  plain.closest(points, expected);
  distributed.closest(points, found);
  EXPECT_EQ(found, expected);
}

/// A checkpoint of all ranks goes on with one rank, and one of one rank goes on with all: each time with the
/// results and events of a scene that never stopped.
TEST(DistributedScene, ACheckpointGoesOnWithOtherRanks) {
  const std::string path = path_of_job("supple_checkpoint"),
                    own_path = path + "_of_" + std::to_string(rank_of_world());
  for (std::uint64_t seed = 151; seed < 152 + life_count(); ++seed) {
    Lives lives(seed, small_clusters());
    for (int i = 0; i < 6; ++i) lives.add_object(false);
    const ContactKinds kinds =
        ContactKinds::intersection | ContactKinds::continuous | ContactKinds::proximity;
    for (int step = 0; step < 6; ++step) {
      lives.move_objects(false);
      lives.change_settings(true);
      if (step == 2 || step == 4) {
        lives.plain.set_pair_filter({});  // the file has no filter
        lives.distributed.save(path);
        {
          DistributedScene alone(MPI_COMM_SELF, small_clusters());
          alone.load(path);
          EXPECT_EQ(alone.objects().size(), lives.objects.size());
          MPI_Barrier(MPI_COMM_WORLD);
          alone.save(own_path);
        }
        MPI_Barrier(MPI_COMM_WORLD);
        lives.distributed = DistributedScene(MPI_COMM_WORLD, small_clusters());
        lives.distributed.load(step == 2 ? path : path + "_of_0");
      }
      const DetectResult& expected = lives.plain.detect({.contacts = kinds});
      const DetectResult& found = lives.distributed.detect({.contacts = kinds});
      if (rank_of_world() == 0)
        expect_same(found, expected, "seed " + std::to_string(seed) + " step " + std::to_string(step));
      if (step == 2 || step == 4) lives.settle_all();
    }
  }
  std::remove(own_path.c_str());
  if (rank_of_world() == 0) std::remove(path.c_str());
}

TEST(DistributedScene, WorkIsSpreadOverTheRanks) {
  DistributedOptions options = small_clusters();
  options.cluster_triangles = 64;
  DistributedScene scene(MPI_COMM_WORLD, options);
  const TriangleMesh ball = make_icosphere(8);
  // All on rank 0; the computation spreads.
  std::vector<Vec3d> positions = ball.positions;
  for (std::uint32_t i = 0; i < 64 && scene.rank() == 0; ++i) {
    const Vec3d place{0.8 * (i % 4), 0.8 * (i / 4 % 4), 0.8 * (i / 16)};
    for (std::size_t v = 0; v < positions.size(); ++v) positions[v] = ball.positions[v] + place;
    scene.add(ObjectId{i}, positions, ball.triangles);
  }
  scene.detect();
  EXPECT_TRUE(scene.stats().divided);
  EXPECT_GT(scene.stats().triangles, 0u);
  EXPECT_LT(scene.stats().imbalance, 1.8);
  scene.detect();
  const std::uint64_t sent = scene.stats().bytes_sent;
  scene.detect();
  EXPECT_FALSE(scene.stats().divided);
  EXPECT_EQ(scene.stats().bytes_sent, sent);  // boxes, requests and results, but no positions
  EXPECT_EQ(scene.stats().bytes_sent > 0, scene.rank_count() > 1);
}

}  // namespace
}  // namespace supple
