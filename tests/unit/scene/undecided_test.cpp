// `ImpactOptions::exact` off: what floating point cannot decide on hostile coordinates.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <vector>

#include "supple/scene.hpp"
#include "support/random.hpp"

namespace supple::undecided_test {

using Vertices = std::vector<Vec3d>;

/// Numbers of a few values, so that elements often touch. One in eight is tiny, so that pairs have many bits.
double hostile_number(RandomNumbers& random) {
  const int value = static_cast<int>(random.below(5)) - 2;
  return random.below(8) == 0 ? std::ldexp(value + 0.25, -320) : value;
}

Vertices hostile_vertices(RandomNumbers& random) {
  Vertices vertices(12);
  for (Vec3d& p : vertices) p = {hostile_number(random), hostile_number(random), hostile_number(random)};
  return vertices;
}

/// Three objects on hostile paths.
Scene hostile_scene(std::uint64_t seed, double separation, bool exact, std::uint32_t threads) {
  Scene scene({.contacts = ContactKinds::continuous,
               .impact = {.min_separation = separation, .exact = exact},
               .threads = threads});
  RandomNumbers random(seed);
  for (int i = 0; i < 3; ++i) {
    const Vertices from = hostile_vertices(random), to = hostile_vertices(random);
    const TriangleMesh mesh{"hostile", from, {{0, 1, 2}, {3, 4, 5}, {6, 7, 8}, {9, 10, 11}}};
    scene.set_motion(scene.add(mesh, {.octree = {.leaf_size = threads}}), from, to);
  }
  return scene;
}

std::vector<ContinuousContact> contacts_of(Scene& scene) {
  const auto contacts = scene.detect().continuous_contacts;
  return {contacts.begin(), contacts.end()};
}

bool have_same_elements(const ContinuousContact& p, const ContinuousContact& q) {
  return p.object_a == q.object_a && p.object_b == q.object_b && p.kind == q.kind &&
         p.element_a == q.element_a && p.element_b == q.element_b;
}

TEST(Undecided, ContactsAreReportedAndNeverMissed) {
  const bool is_slow = std::getenv("SUPPLE_SANITIZED") != nullptr;
  std::size_t uncertain = 0, not_touching = 0;
  for (std::uint64_t seed = 0; seed < (is_slow ? 3 : 15); ++seed) {
    for (const double separation : {0.0, 0.25}) {
      Scene exact = hostile_scene(seed, separation, true, 1);
      const std::vector<ContinuousContact> expected = contacts_of(exact);
      Scene rounded = hostile_scene(seed, separation, false, 1);
      const std::vector<ContinuousContact> found = contacts_of(rounded);
      for (const ContinuousContact& contact : expected) {
        const auto same = std::ranges::find_if(
            found, [&](const ContinuousContact& other) { return have_same_elements(contact, other); });
        ASSERT_NE(same, found.end()) << "missed, seed " << seed;
        ASSERT_LE(same->toi, contact.toi);
        if (same->certainty == ImpactCertainty::certain) {
          ASSERT_EQ(*same, contact);
        }
      }
      not_touching += found.size() - expected.size();
      for (const ContinuousContact& contact : found)
        uncertain += contact.certainty == ImpactCertainty::within_tolerance ? 1 : 0;
      ASSERT_LE(rounded.max_step().step, exact.max_step().step);
      ASSERT_LE(rounded.collision_free_step().step, exact.collision_free_step().step);
      for (const std::uint32_t threads : {2u, 5u}) {
        Scene parallel = hostile_scene(seed, separation, false, threads);
        ASSERT_EQ(contacts_of(parallel), found) << "seed " << seed << ", threads " << threads;
      }
    }
  }
  EXPECT_GT(uncertain, 10u);
  EXPECT_GT(not_touching, 0u) << "no undecided pair was reported that does not touch";
}

}  // namespace supple::undecided_test
