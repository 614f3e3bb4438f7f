// A distributed scene equals one `Scene` on one rank: random lives of scenes whose objects are on different
// ranks or in parts, appear, vanish, change their rank, crowd into a corner, and have broken coordinates.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <numeric>
#include <set>
#include <string>
#include <vector>

#include "random_lives.hpp"
#include "supple/distributed.hpp"
#include "supple/models.hpp"
#include "supple/result_lists.hpp"
#include "supple/scene.hpp"

namespace supple {
namespace {

/// Equality of records, in which a NaN equals itself.
bool same_number(double p, double q) {
  return p == q || (p != p && q != q);
}
template <class Row>
bool same_row(const Row& p, const Row& q) {
  if constexpr (std::is_same_v<Row, NonFiniteVertex>) {
    return p.object == q.object && p.vertex == q.vertex && same_number(p.position.x, q.position.x) &&
           same_number(p.position.y, q.position.y) && same_number(p.position.z, q.position.z);
  } else {
    return p == q;
  }
}
bool same_row(const ContactGroup& p, const ContactGroup& q) {
  return p.a == q.a && p.b == q.b && p.first_contact == q.first_contact && p.contact_count == q.contact_count;
}

template <class Row>
void expect_same(const char* name, std::span<const Row> found, std::span<const Row> expected,
                 const std::string& where) {
  ASSERT_EQ(found.size(), expected.size()) << name << " " << where;
  for (std::size_t i = 0; i < found.size(); ++i)
    ASSERT_TRUE(same_row(found[i], expected[i])) << name << " " << i << " " << where;
}

void expect_same(const DetectResult& found, const DetectResult& expected, const std::string& where) {
  EXPECT_EQ(found.step, expected.step) << where;
  for_each_list([&]<class Row>(const ResultList<Row>& list, auto member) {
    expect_same<Row>(list.name, member(found), member(expected), where);
  });
  expect_same<ContactGroup>("groups", found.groups, expected.groups, where);
  expect_same<ContactGroup>("continuous_groups", found.continuous_groups, expected.continuous_groups, where);
  expect_same<ContactGroup>("proximity_groups", found.proximity_groups, expected.proximity_groups, where);
  expect_same<NonFiniteVertex>("non_finite", found.non_finite_vertices, expected.non_finite_vertices, where);
  expect_same<ObjectPair>("volume stay", found.volume_events.stay, expected.volume_events.stay, where);
  expect_same<ObjectPair>("contact stay", found.contact_events.stay, expected.contact_events.stay, where);
}

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
    const std::uint32_t what = lives.random.below(6);
    if (what == 0) lives.add_object(is_deep);
    if (what == 1) lives.remove_object();
    if (what == 2) lives.change_ranks();
    lives.move_objects(lives.random.below(6) == 0);
    const DetectResult& expected = lives.plain.detect({.contacts = contacts});
    const DetectResult& found = lives.distributed.detect({.contacts = contacts});
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
