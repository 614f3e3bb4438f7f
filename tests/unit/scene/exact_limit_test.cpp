// `SceneOptions::max_exact_bits`.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

#include "supple/error.hpp"
#include "supple/inspection.hpp"
#include "support/random.hpp"
#include "support/scenes.hpp"
#include "support/soups.hpp"

namespace supple {
namespace {

using Vertices = std::vector<Vec3d>;

constexpr std::uint32_t limit = 252;

SceneOptions options_of(ContactKinds contacts, std::uint32_t max_exact_bits, std::uint32_t threads) {
  SceneOptions options;
  options.contacts = contacts;
  options.max_exact_bits = max_exact_bits;
  options.threads = threads;
  return options;
}

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
Scene hostile_scene(std::uint64_t seed, double separation, std::uint32_t max_exact_bits,
                    std::uint32_t threads) {
  SceneOptions options = options_of(ContactKinds::continuous, max_exact_bits, threads);
  options.impact.min_separation = separation;
  Scene scene(options);
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

TEST(ExactLimit, ReportsWhatExactArithmeticWouldDecideAsWithinTolerance) {
  const bool is_slow = std::getenv("SUPPLE_SANITIZED") != nullptr;
  std::size_t uncertain = 0, not_touching = 0;
  for (std::uint64_t seed = 0; seed < (is_slow ? 3 : 15); ++seed) {
    for (const double separation : {0.0, 0.25}) {
      Scene exact = hostile_scene(seed, separation, most_exact_bits, 1);
      const std::vector<ContinuousContact> expected = contacts_of(exact);
      Scene limited = hostile_scene(seed, separation, limit, 1);
      const std::vector<ContinuousContact> found = contacts_of(limited);
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
      ASSERT_LE(limited.max_step().step, exact.max_step().step);
      ASSERT_LE(limited.collision_free_step().step, exact.collision_free_step().step);
      for (const std::uint32_t threads : {2u, 5u}) {
        Scene parallel = hostile_scene(seed, separation, limit, threads);
        ASSERT_EQ(contacts_of(parallel), found) << "seed " << seed << ", threads " << threads;
        ASSERT_EQ(parallel.earliest_impact(), limited.earliest_impact());
        ASSERT_EQ(parallel.collision_free_step().step, limited.collision_free_step().step);
      }
    }
  }
  EXPECT_GT(uncertain, 10u);
  EXPECT_GT(not_touching, 0u) << "the limit never had to be conservative";
}

/// What `detect` reports for meshes of ordinary size.
template <class Get>
void expect_no_effect(ContactKinds kinds, const Get& get) {
  const auto result_of = [&](std::uint32_t max_exact_bits) {
    Scene scene(options_of(kinds, max_exact_bits, 2));
    std::vector<ObjectId> ids;
    for (std::uint64_t seed = 0; seed < 3; ++seed)
      ids.push_back(scene.add(random_soup(40, 1, 0.4, seed), {.self_collision = true, .margin = 0.01}));
    RandomNumbers random(7);
    Vertices from, to;
    for (int i = 0; i < 120; ++i) from.push_back(random.vector(1)), to.push_back(random.vector(1));
    // Sliding in one plane, and touching at rest, which only exact arithmetic decides.
    for (std::size_t i = 0; i < 30; ++i) from[i].y = to[i].y = 0;
    scene.set_motion(ids[0], from, to);
    scene.set_motion(ids[1], to, from);
    const auto list = get(scene.detect());
    return std::vector(list.begin(), list.end());
  };
  const auto expected = result_of(most_exact_bits);
  EXPECT_GT(expected.size(), 10u);
  EXPECT_EQ(result_of(limit), expected);
}

TEST(ExactLimit, HasNoEffectOnOrdinaryCoordinates) {
  expect_no_effect(ContactKinds::continuous, [](const DetectResult& r) { return r.continuous_contacts; });
  expect_no_effect(ContactKinds::intersection, [](const DetectResult& r) { return r.contacts; });
  expect_no_effect(ContactKinds::proximity, [](const DetectResult& r) { return r.proximity_pairs; });
}

std::string message_of(Scene& scene) {
  try {
    scene.detect();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

/// Two triangles that intersect. The first one has a corner with a tiny coordinate.
struct Pair {
  Scene scene;
  ObjectId first, second;

  explicit Pair(const SceneOptions& options, double tiny = 0x1p-400) : scene(options) {
    first = scene.add({"tiny", {{0, 0, 0}, {4, 0, tiny}, {0, 4, 0}}, {{0, 1, 2}}}, {.margin = 0.5});
    second = scene.add({"large", {{1, 1, -1}, {1, 1, 0x1p9}, {2, 1, 1}}, {{0, 1, 2}}});
  }
};

constexpr const char* message =
    "detect: vertex 1 of large and vertex 1 of tiny have coordinates of 410 bits together, but "
    "max_exact_bits is 252; raise it, or set coordinates below 2^-190 to 0";

TEST(ExactLimit, IsAnErrorForOtherKindsOfContacts) {
  for (const ContactKinds kinds :
       {ContactKinds::intersection, ContactKinds::proximity, ContactKinds::penetration,
        ContactKinds::intersection | ContactKinds::continuous}) {
    for (const std::uint32_t threads : {1u, 2u}) {
      Pair pair(options_of(kinds, limit, threads));
      EXPECT_EQ(message_of(pair.scene), message);
    }
  }
  Pair enough(options_of(ContactKinds::intersection, 410, 1));
  EXPECT_EQ(enough.scene.detect().contacts.size(), 1u);
  Pair too_few(options_of(ContactKinds::intersection, 409, 1));
  EXPECT_NE(message_of(too_few.scene), "");
  Pair counted(options_of(ContactKinds::none, limit, 1));
  EXPECT_EQ(message_of(counted.scene), "") << "without contacts there is no exact work";
}

TEST(ExactLimit, AFollowingStepIsThatOfANewScene) {
  Pair pair(options_of(ContactKinds::intersection, limit, 1)),
      plain(options_of(ContactKinds::intersection, limit, 1), 0);
  EXPECT_EQ(message_of(pair.scene), message);
  EXPECT_EQ(message_of(pair.scene), message) << "the same again";
  pair.scene.set_positions(pair.first, Vertices{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}});
  const auto contacts = pair.scene.detect().contacts;
  ASSERT_EQ(contacts.size(), 1u);
  EXPECT_EQ(contacts[0], plain.scene.detect().contacts[0]);
  EXPECT_EQ(pair.scene.result().contact_events.begin.size(), 1u);
  EXPECT_TRUE(pair.scene.verify().agrees());
}

TEST(ExactLimit, CountsOnlyObjectsThatMayTouchAndTheirElements) {
  Pair pair(options_of(ContactKinds::intersection, limit, 1));
  pair.scene.translate(pair.second, {100, 0, 0});
  EXPECT_EQ(message_of(pair.scene), "");
  // A vertex of no triangle, and one that is not finite.
  Scene scene(options_of(ContactKinds::intersection, limit, 1));
  scene.add({"unused", {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {0x1p-900, 0, 0}}, {{0, 1, 2}}});
  scene.add({"broken", {{1, 1, -1}, {1, 1, 1}, {2, 1, 1}, {NAN, 0, 0}}, {{0, 1, 2}, {0, 1, 3}}});
  EXPECT_EQ(message_of(scene), "");
  EXPECT_EQ(scene.result().contacts.size(), 1u);
}

TEST(ExactLimit, NamesTheMargin) {
  Scene scene(options_of(ContactKinds::proximity, limit, 1));
  scene.add({"a", {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}, {{0, 1, 2}}}, {.margin = 0x1p-300});
  scene.add({"b", {{1, 1, -1}, {1, 1, 1}, {2, 1, 1}}, {{0, 1, 2}}});
  EXPECT_NE(message_of(scene).find("vertex 1 of a and the margin of a have coordinates of 303 bits"),
            std::string::npos)
      << message_of(scene);
}

}  // namespace
}  // namespace supple
