// Requests to one scene: different kinds of contacts, limits of their number, and stops.

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <span>
#include <stop_token>
#include <string_view>
#include <thread>
#include <vector>

#include "supple/error.hpp"
#include "supple/inspection.hpp"
#include "supple/models.hpp"
#include "supple/verify.hpp"
#include "support/hard_scenes.hpp"
#include "support/scenes.hpp"

namespace supple::request_test {

constexpr ContactKinds both = ContactKinds::intersection | ContactKinds::continuous;

/// Copies of the lists of a result.
struct Lists {
  std::vector<Contact> contacts;
  std::vector<ContactPoint> points;
  std::vector<ContinuousContact> continuous;
  std::vector<ObjectPair> touching;

  explicit Lists(const DetectResult& result)
      : contacts(result.contacts.begin(), result.contacts.end()),
        points(result.contact_points.begin(), result.contact_points.end()),
        continuous(result.continuous_contacts.begin(), result.continuous_contacts.end()) {
    for (const auto groups : {result.groups, result.continuous_groups}) {
      for (const ContactGroup& group : groups) {
        if (group.a != group.b) touching.push_back({group.a, group.b});
      }
    }
    std::sort(touching.begin(), touching.end());
    touching.erase(std::unique(touching.begin(), touching.end()), touching.end());
  }
};

void expect_equal_contacts(const Lists& found, const Lists& expected) {
  ASSERT_EQ(found.contacts.size(), expected.contacts.size());
  for (std::size_t i = 0; i < found.contacts.size(); ++i) {
    const Contact &p = found.contacts[i], &q = expected.contacts[i];
    ASSERT_TRUE(p.object_a == q.object_a && p.object_b == q.object_b && p.triangle_a == q.triangle_a &&
                p.triangle_b == q.triangle_b && p.kind == q.kind && p.point_count == q.point_count &&
                p.first_point == q.first_point && p.normal == q.normal)
        << i;
  }
  ASSERT_EQ(found.points, expected.points);
}

/// The groups of each kind cover its list.
void expect_groups_fit(const DetectResult& result) {
  std::uint32_t next = 0;
  for (const ContactGroup& group : result.groups) {
    ASSERT_EQ(group.first_contact, next);
    ASSERT_GT(group.contact_count, 0u);
    for (const Contact& contact : result.contacts_of(group))
      ASSERT_TRUE(contact.object_a == group.a && contact.object_b == group.b);
    next += group.contact_count;
  }
  ASSERT_EQ(next, result.contacts.size());
  next = 0;
  for (const ContactGroup& group : result.continuous_groups) {
    ASSERT_EQ(group.first_contact, next);
    for (const ContinuousContact& contact : result.continuous_contacts_of(group))
      ASSERT_TRUE(contact.object_a == group.a && contact.object_b == group.b);
    next += group.contact_count;
  }
  ASSERT_EQ(next, result.continuous_contacts.size());
}

TriangleMesh cropped(TriangleMesh mesh) {
  mesh.triangles.resize(std::min(mesh.triangles.size(), std::size_t{16}));
  return mesh;
}

/// Objects that move in every supported way. Scenes with the same seed get the same motion.
class Lives {
 public:
  Lives(const Family& family, std::uint64_t seed) : random_(seed) {
    for (const TriangleMesh& mesh : family.make(seed)) meshes_.push_back(cropped(mesh));
    double largest = 0;
    for (const TriangleMesh& mesh : meshes_) {
      for (const Vec3d& p : mesh.positions) {
        for (int axis = 0; axis < 3; ++axis)
          if (std::isfinite(p[axis])) largest = std::max(largest, std::fabs(p[axis]));
      }
    }
    if (largest > 0) size_ = largest;
  }
  void add_to(Scene& scene) const {
    for (const TriangleMesh& mesh : meshes_)
      scene.add(mesh, {.self_collision = true, .octree = {.leaf_size = 3}});
  }
  /// Moves some of the objects.
  void step(const std::vector<Scene*>& scenes) {
    for (std::uint32_t i = 0; i < meshes_.size(); ++i) {
      const std::uint32_t way = random_.below(6);
      std::vector<Vec3d> from = meshes_[i].positions, to = from;
      for (Vec3d& p : to) p = p + random_.vector(0.2 * size_);
      const Vec3d offset = random_.vector(0.3 * size_);
      for (Scene* const scene : scenes) {
        const ObjectId id = scene->objects()[i];
        if (way == 0) scene->set_positions(id, to);
        if (way == 1) scene->translate(id, offset);
        if (way == 2)
          scene->set_transform(id, {.rotation = {0, -1, 0, 1, 0, 0, 0, 0, 1}, .translation = offset});
        if (way == 3 || way == 4) scene->set_motion(id, from, to);
      }
    }
  }

 private:
  std::vector<TriangleMesh> meshes_;
  double size_ = 1;  // motion is proportional to the coordinates
  RandomNumbers random_;
};

class OneScene : public testing::TestWithParam<Family> {};

TEST_P(OneScene, AnswersWhatTwoWouldInAnyOrder) {
  const std::string_view family = GetParam().name;
  // The exact check of continuous contacts takes minutes for mixed scales, and with a separation for all
  // families but one.
  const bool is_slow_to_verify = family == "MixedScales";
  const bool has_separation = family == "RandomSoups";
  for (const double separation : {0.0, has_separation ? 0.05 : 0.0}) {
    for (const std::uint32_t threads : {1u, 3u}) {
      const auto options = [&](ContactKinds contacts) {
        SceneOptions result;
        result.contacts = contacts;
        result.impact.min_separation = separation;
        result.threads = threads;
        return result;
      };
      Scene one(options(ContactKinds::intersection)), two(options(both));
      Scene at_rest(options(ContactKinds::intersection)), moving(options(ContactKinds::continuous));
      Lives lives(GetParam(), 3);
      for (Scene* scene : {&one, &two, &at_rest, &moving}) lives.add_to(*scene);
      for (int step = 0; step < (is_slow_to_verify ? 3 : 5); ++step) {
        if (step > 0) lives.step({&one, &two, &at_rest, &moving});
        const Lists contacts(at_rest.detect()), impacts(moving.detect());
        const DetectResult& result = two.detect();
        expect_groups_fit(result);
        const Lists found(result);
        expect_equal_contacts(found, contacts);
        ASSERT_EQ(found.continuous, impacts.continuous) << step;
        ASSERT_TRUE(is_slow_to_verify || verify(two).agrees()) << step;
        // Requests both kinds of contacts, in an order that alternates between steps.
        for (const int turn : {step, step + 1}) {
          const bool is_continuous = turn % 2 == 0;
          const DetectResult& answer =
              one.detect({.contacts = is_continuous ? ContactKinds::continuous : ContactKinds::intersection});
          expect_groups_fit(answer);
          if (is_continuous) {
            ASSERT_EQ(Lists(answer).continuous, impacts.continuous) << step;
            ASSERT_TRUE(answer.contacts.empty() && answer.groups.empty() && answer.contact_points.empty());
          } else {
            expect_equal_contacts(Lists(answer), contacts);
            ASSERT_TRUE(answer.continuous_contacts.empty() && answer.continuous_groups.empty());
          }
          ASSERT_TRUE((is_slow_to_verify && is_continuous) || verify(one).agrees()) << step;
          ASSERT_EQ(SceneInspector(one).validate(), "") << step;
        }
        if (HasFatalFailure()) return;
      }
    }
  }
}

TEST_P(OneScene, TheEarliestImpactLeavesTheResultAsItWas) {
  Scene scene, moving({.contacts = ContactKinds::continuous});
  Lives lives(GetParam(), 4);
  lives.add_to(scene);
  lives.add_to(moving);
  for (int step = 0; step < 4; ++step) {
    lives.step({&scene, &moving});
    const std::uint64_t before = hash_of(scene.detect());
    const std::uint64_t number = scene.result().step;
    EXPECT_EQ(scene.earliest_impact(), moving.earliest_impact());
    EXPECT_EQ(hash_of(scene.result()), before);
    EXPECT_EQ(scene.result().step, number);
    EXPECT_TRUE(verify(scene).agrees());
    EXPECT_NO_THROW(SceneInspector(scene).candidates(10));
    EXPECT_EQ(SceneInspector(scene).validate(), "");
  }
}

TEST_P(OneScene, ListsTheFirstContacts) {
  for (const std::uint32_t threads : {1u, 2u, 7u}) {
    Scene scene({.contacts = both, .threads = threads});
    Lives lives(GetParam(), 5);
    lives.add_to(scene);
    lives.step({&scene});
    const Lists all(scene.detect());
    EXPECT_FALSE(scene.result().truncated);
    const std::size_t most = std::max(all.contacts.size(), all.continuous.size());
    for (const std::size_t limit :
         {std::size_t{0}, std::size_t{1}, std::size_t{7}, most / 2, most - 1, most}) {
      const DetectResult& result = scene.detect({.max_contacts = limit});
      expect_groups_fit(result);
      EXPECT_EQ(result.truncated, limit < most);
      Lists expected = all;
      expected.contacts.resize(std::min(limit, all.contacts.size()));
      expected.continuous.resize(std::min(limit, all.continuous.size()));
      std::size_t points = 0;
      for (const Contact& contact : expected.contacts) points += contact.point_count;
      expected.points.resize(points);
      const Lists found(result);
      expect_equal_contacts(found, expected);
      ASSERT_EQ(found.continuous, expected.continuous);
      if (result.truncated) {
        EXPECT_THROW(verify(scene), Error);
      }
      // The next step does not treat omitted contacts as known.
      const Lists again(scene.detect());
      expect_equal_contacts(again, all);
      ASSERT_EQ(again.continuous, all.continuous);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Families, OneScene, testing::ValuesIn(hard_families()),
                         [](const auto& family) { return family.param.name; });

/// Dense triangle soups: nearly every triangle intersects many others.
Scene crowded(ContactKinds contacts, std::uint32_t threads, std::uint32_t triangles = 800) {
  Scene scene({.contacts = contacts, .threads = threads});
  for (std::uint64_t i = 0; i < 3; ++i) {
    const TriangleMesh soup = random_soup(triangles, 1, 0.3, 20 + i);
    const ObjectId id = scene.add(soup, {.self_collision = true});
    std::vector<Vec3d> to = soup.positions;
    RandomNumbers random(i);
    for (Vec3d& p : to) p = p + random.vector(0.02);
    scene.set_motion(id, soup.positions, to);
  }
  return scene;
}

TEST(MaxContacts, SavesTheTestsOfWhatIsLeftOut) {
  for (const std::uint32_t threads : {1u, 4u}) {
    Scene scene = crowded(both, threads);
    const StepStats all = scene.detect().stats;
    const Lists lists(scene.result());
    for (const std::uint64_t limit : {10u, 3000u}) {
      Scene other = crowded(both, threads);
      const DetectResult& result = other.detect({.max_contacts = limit});
      EXPECT_TRUE(result.truncated);
      ASSERT_EQ(result.contacts.size(), limit);
      ASSERT_EQ(result.continuous_contacts.size(), limit);
      for (std::size_t i = 0; i < limit; ++i) {
        ASSERT_EQ(result.contacts[i].triangle_a, lists.contacts[i].triangle_a);
        ASSERT_EQ(result.contacts[i].triangle_b, lists.contacts[i].triangle_b);
        ASSERT_EQ(result.continuous_contacts[i], lists.continuous[i]);
      }
      // Several threads may work on later jobs before the first ones end.
      if (threads == 1) {
        EXPECT_LT(result.stats.node_pairs_visited, all.node_pairs_visited);
      }
    }
  }
}

TEST(MaxContacts, CutsTheListOfOneTask) {
  Scene scene({.contacts = ContactKinds::continuous, .threads = 1});
  for (std::uint64_t i = 0; i < 2; ++i) {
    const TriangleMesh soup = random_soup(400, 1, 0.5, 20 + i);
    std::vector<Vec3d> to = soup.positions;
    RandomNumbers random(i);
    for (Vec3d& p : to) p = p + random.vector(0.3);
    scene.set_motion(scene.add(soup, {}), soup.positions, to);
  }
  const Lists all(scene.detect());
  ASSERT_GT(all.continuous.size(), 4000u);
  for (const std::size_t limit : {0u, 5u, 100u, 700u, 3000u}) {
    const DetectResult& result = scene.detect({.max_contacts = limit});
    EXPECT_TRUE(result.truncated);
    ASSERT_TRUE(std::ranges::equal(result.continuous_contacts, std::span(all.continuous).first(limit)));
  }
}

TEST(MaxContacts, CutsTheListAndThePointsOfOneTask) {
  Scene scene({.threads = 1});
  for (std::uint64_t i = 0; i < 3; ++i) scene.add(random_soup(300, 1, 1.0, 40 + i), {.self_collision = true});
  const Lists all(scene.detect());
  ASSERT_GT(all.contacts.size(), 8000u);
  for (const std::size_t limit : {0u, 5u, 100u, 700u, 3000u}) {
    Lists expected = all;
    expected.contacts.resize(limit);
    std::size_t points = 0;
    for (const Contact& contact : expected.contacts) points += contact.point_count;
    expected.points.resize(points);
    const DetectResult& result = scene.detect({.max_contacts = limit});
    EXPECT_TRUE(result.truncated);
    expect_equal_contacts(Lists(result), expected);
  }
}

TEST(Stop, BeforeAnythingIsFoundLeavesTheSceneAsItWas) {
  Scene scene = crowded(both, 2, 200), other = crowded(both, 2, 200);
  scene.detect();
  other.detect();
  for (const ObjectId id : scene.objects()) {
    scene.translate(id, {0.25 * id.index, 0, 0});
    other.translate(id, {0.25 * id.index, 0, 0});
  }
  std::stop_source source;
  source.request_stop();
  const DetectResult& stopped = scene.detect({.stop = source.get_token()});
  EXPECT_TRUE(stopped.stopped);
  EXPECT_TRUE(stopped.object_pairs.empty() && stopped.groups.empty() && stopped.contacts.empty() &&
              stopped.continuous_groups.empty() && stopped.continuous_contacts.empty() &&
              stopped.volume_events.begin.empty() && stopped.contact_events.end.empty());
  EXPECT_THROW(verify(scene), Error);
  EXPECT_EQ(SceneInspector(scene).validate(), "");
  const DetectResult& result = scene.detect();
  EXPECT_FALSE(result.stopped);
  const DetectResult& expected = other.detect();
  EXPECT_EQ(hash_of(result), hash_of(expected));
  EXPECT_EQ(result.step, expected.step);
}

/// Two solids that penetrate each other, and a third one near them.
Scene three_balls(ContactKinds contacts, std::uint32_t subdivisions) {
  Scene scene({.contacts = contacts, .threads = 1});
  const TriangleMesh ball = make_icosphere(subdivisions);
  for (const double x : {0.0, 1.5, 3.52}) {
    const ObjectId id = scene.add(ball, {.margin = 0.05, .solid = true});
    std::vector<Vec3d> from = ball.positions, to;
    for (Vec3d& p : from) p.x += x;
    for (const Vec3d& p : from) to.push_back({p.x - 0.1 * x, p.y, p.z});
    scene.set_motion(id, from, to);
  }
  return scene;
}

TEST(Stop, InThePairFilterEndsTheStepOfEveryKind) {
  for (const ContactKinds contacts : {ContactKinds::intersection, ContactKinds::continuous,
                                      ContactKinds::proximity, ContactKinds::penetration}) {
    Scene scene = three_balls(contacts, 2);
    std::stop_source source;
    scene.set_pair_filter([&](ObjectId, ObjectId) {
      source.request_stop();
      return true;
    });
    EXPECT_TRUE(scene.detect({.stop = source.get_token()}).stopped);
    EXPECT_EQ(SceneInspector(scene).validate(), "");
    scene.set_pair_filter({});
    EXPECT_FALSE(scene.detect().stopped);
    Scene other = three_balls(contacts, 2);
    other.detect();
    const DetectResult &result = scene.result(), &expected = other.result();
    EXPECT_EQ(hash_of(result), hash_of(expected));
    EXPECT_EQ(result.proximity_pairs.size(), expected.proximity_pairs.size());
    EXPECT_EQ(result.penetrations.size(), expected.penetrations.size());
    EXPECT_TRUE(verify(scene).agrees());
  }
}

/// Starts a search and requests a stop from another thread. Returns whether the search was stopped.
bool stop_from_another_thread(Scene& scene) {
  std::stop_source source;
  std::atomic<bool> is_searching = false;
  scene.set_pair_filter([&](ObjectId, ObjectId) {
    is_searching = true;
    return true;
  });
  std::thread stopper([&] {
    while (!is_searching) std::this_thread::yield();
    source.request_stop();
  });
  const bool stopped = scene.detect({.stop = source.get_token()}).stopped;
  stopper.join();
  scene.set_pair_filter({});
  return stopped;
}

TEST(Stop, FromAnotherThreadEndsALongSearch) {
  constexpr int most_attempts = 50;  // on a busy machine, a search may end before the other thread runs
  for (const ContactKinds contacts : {ContactKinds::intersection, ContactKinds::continuous}) {
    for (const std::uint32_t threads : {1u, 2u}) {
      Scene fresh = crowded(contacts, threads);
      const std::uint64_t all = hash_of(fresh.detect());
      bool stopped = false;
      for (int attempt = 0; attempt < most_attempts && !stopped; ++attempt) {
        Scene scene = crowded(contacts, threads);
        stopped = stop_from_another_thread(scene);
        if (stopped) {
          EXPECT_EQ(hash_of(scene.detect()), all);
        }
      }
      EXPECT_TRUE(stopped);
    }
  }
}

/// Compares contacts after translations and transforms with those of a scene that gets the same positions
/// directly.
TEST(Translation, GivesTheContinuousContactsOfTheSamePositions) {
  RandomNumbers random(31);
  for (const double separation : {0.0, 0.03}) {
    for (const bool floats : {false, true}) {
      SceneOptions options;
      options.contacts = both;
      options.impact.min_separation = separation;
      options.threads = 2;
      Scene moved(options), given(options);
      std::vector<ObjectId> ids, given_ids;
      for (std::uint64_t seed = 0; seed < 4; ++seed) {
        const TriangleMesh mesh = random_soup(seed % 2 == 0 ? 12 : 24, 0.5, 0.3, seed);
        const ObjectOptions object{.self_collision = seed == 1, .octree = {.leaf_size = 4}};
        ids.push_back(moved.add(mesh, object));
        given_ids.push_back(given.add(mesh, object));
        std::vector<Vec3f> singles;
        for (const Vec3d& p : mesh.positions)
          singles.push_back({static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)});
        if (floats) moved.set_positions(ids.back(), singles);
      }
      std::size_t found = 0;
      for (int step = 0; step < 10; ++step) {
        // Far from the origin, sums are rounded.
        const Vec3d far = step < 5 ? Vec3d{} : Vec3d{1e9, -3e7, 1e4};
        for (std::size_t i = 0; i < ids.size(); ++i) {
          if (i == 3 && step != 5) continue;
          if (i == 0 && step % 2 == 1) continue;  // moves on a path, see below
          if (i == 2) {
            moved.set_transform(
                ids[i], {.rotation = {0, 0, 1, 0, 1, 0, -1, 0, 0}, .translation = far + random.vector(0.4)});
          } else {
            moved.translate(ids[i], (step == 5 ? far : Vec3d{}) + random.vector(0.2));
          }
        }
        for (std::size_t i = 0; i < ids.size(); ++i) {
          std::vector<Vec3d> positions;
          for (std::uint32_t v = 0; v < moved.vertex_count(ids[i]); ++v)
            positions.push_back(moved.position(ids[i], v));
          given.set_positions(given_ids[i], positions);
          if (i != 0 || step % 2 == 0) continue;
          std::vector<Vec3d> from = positions;
          for (Vec3d& p : from) p = p + random.vector(0.3);
          given.set_motion(given_ids[i], from, positions);
          moved.set_motion(ids[i], from, positions);
        }
        const std::uint64_t refitted = moved.detect().stats.triangles_refitted;
        EXPECT_EQ(refitted, step == 0 ? 72u : 12u);
        const Lists lists(moved.result()), expected(given.detect());
        expect_equal_contacts(lists, expected);
        ASSERT_EQ(lists.continuous, expected.continuous) << step;
        ASSERT_TRUE(verify(moved).agrees()) << step;
        ASSERT_EQ(SceneInspector(moved).validate(), "") << step;
        found += lists.continuous.size();
      }
      EXPECT_GT(found, 50u);
    }
  }
}

/// Objects at rest, or with unchanged paths, keep their continuous contacts.
TEST(Known, ContinuousContactsAreThoseOfANewScene) {
  SceneOptions options;
  options.contacts = ContactKinds::continuous;
  options.threads = 3;
  Scene scene(options);
  std::vector<ObjectId> ids;
  const TriangleMesh ball = make_icosphere(4);
  RandomNumbers random(5);
  for (int i = 0; i < 8; ++i) {
    ids.push_back(scene.add(ball, {.self_collision = i == 0}));
    scene.translate(ids.back(), {1.8 * (i % 2), 1.8 * (i / 2 % 2), 1.8 * (i / 4)});
  }
  scene.detect();
  const std::uint64_t all = scene.result().stats.node_pairs_visited;
  for (int step = 0; step < 6; ++step) {
    const ObjectId id = ids[static_cast<std::size_t>(step)];
    std::vector<Vec3d> from, to;
    for (std::uint32_t v = 0; v < scene.vertex_count(id); ++v) {
      from.push_back(scene.position(id, v));
      to.push_back(from.back() + random.vector(0.1));
    }
    scene.set_motion(id, from, to);
    const Lists found(scene.detect());
    EXPECT_LT(scene.result().stats.node_pairs_visited, all);
    EXPECT_TRUE(verify(scene).agrees());
    // A request with another separation does not reuse these contacts.
    scene.detect({.impact = ImpactOptions{.min_separation = 0.1}});
    EXPECT_GT(scene.result().continuous_contacts.size(), found.continuous.size());
    EXPECT_EQ(Lists(scene.detect()).continuous, found.continuous);
  }
}

TEST(Events, AreOfPairsThatTouchInAnyWay) {
  Scene scene({.contacts = both, .threads = 1});
  const ObjectId floor = scene.add({"floor", {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}, {{0, 1, 2}}});
  const std::vector<Vec3d> above{{1, 1, 1}, {1, 1.5, 2}, {1.5, 1, 2}},
      below{{1, 1, -2}, {1, 1.5, -1}, {1.5, 1, -1}};
  const ObjectId stone = scene.add({"stone", above, {{0, 1, 2}}});
  EXPECT_TRUE(scene.detect().contact_events.begin.empty());
  scene.set_motion(stone, above, below);
  const DetectResult& through = scene.detect();
  EXPECT_TRUE(through.contacts.empty());
  EXPECT_FALSE(through.continuous_contacts.empty());
  ASSERT_EQ(through.contact_events.begin.size(), 1u);
  EXPECT_EQ(through.contact_events.begin[0], (ObjectPair{floor, stone}));
  scene.set_positions(stone, std::vector<Vec3d>{{1, 1, -1}, {1, 1.5, 1}, {1.5, 1, 1}});
  EXPECT_EQ(scene.detect().contact_events.stay.size(), 1u);
  EXPECT_FALSE(scene.result().contacts.empty());
  scene.set_positions(stone, above);
  EXPECT_EQ(scene.detect().contact_events.end.size(), 1u);
}

/// Stops after more and more time, so that each stage is stopped in some attempt.
TEST(Stop, AtAnyTimeLeavesTheNextStepAsItWouldBe) {
  for (const ContactKinds contacts : {ContactKinds::proximity, ContactKinds::penetration,
                                      both | ContactKinds::proximity | ContactKinds::penetration}) {
    Scene fresh = three_balls(contacts, 4);
    fresh.detect();
    int stops = 0;
    for (int spins = 0; spins < 1 << 16; spins = 2 * spins + 1) {
      Scene scene = three_balls(contacts, 4);
      std::stop_source source;
      std::atomic<bool> is_started = false;
      std::thread stopper([&] {
        for (int i = 0; i < spins; ++i) is_started = true;
        source.request_stop();
      });
      while (spins > 0 && !is_started) std::this_thread::yield();
      if (spins == 0) stopper.join();
      const bool was_stopped = scene.detect({.stop = source.get_token()}).stopped;
      if (spins > 0) stopper.join();
      EXPECT_EQ(SceneInspector(scene).validate(), "");
      // A request that comes too late stops nothing, and then the next step has no pairs that begin.
      if (!was_stopped) continue;
      ++stops;
      const DetectResult &result = scene.detect(), &expected = fresh.result();
      EXPECT_FALSE(result.stopped);
      EXPECT_EQ(hash_of(result), hash_of(expected));
      EXPECT_TRUE(std::ranges::equal(result.proximity_pairs, expected.proximity_pairs));
      EXPECT_TRUE(std::ranges::equal(result.penetrations, expected.penetrations));
      EXPECT_TRUE(std::ranges::equal(result.curve_contacts, expected.curve_contacts));
    }
    EXPECT_GT(stops, 0);
  }
}

}  // namespace supple::request_test
