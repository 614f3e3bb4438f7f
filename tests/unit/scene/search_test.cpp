// `Scene::search`: the contacts of `detect` without a step.

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "supple/error.hpp"
#include "supple/models.hpp"
#include "supple/scene.hpp"
#include "supple/verify.hpp"
#include "support/random.hpp"

namespace supple::search_test {

constexpr ContactKinds three_kinds =
    ContactKinds::intersection | ContactKinds::continuous | ContactKinds::proximity;

/// Balls that overlap at random, some of them on a path.
class BallsOfASearch {
 public:
  explicit BallsOfASearch(Scene& scene) : scene_(scene) {
    for (int i = 0; i < 12; ++i) {
      ids.push_back(scene.add(ball_, {.self_collision = i % 3 == 0, .margin = 0.1}));
      place(ids.back());
    }
  }
  void place(ObjectId id) {
    const Vec3d offset = random_.vector(2.5), way = random_.vector(0.5);
    std::vector<Vec3d> from = ball_.positions, to = ball_.positions;
    for (std::size_t v = 0; v < from.size(); ++v) {
      from[v] = from[v] + offset;
      to[v] = from[v] + way;
    }
    if (id.index % 2 == 0) {
      scene_.set_motion(id, from, to);
    } else {
      scene_.set_positions(id, from);
    }
  }

  std::vector<ObjectId> ids;

 private:
  Scene& scene_;
  RandomNumbers random_{5};
  TriangleMesh ball_ = make_icosphere(3);
};

void expect_equal(const DetectResult& p, const DetectResult& q) {
  EXPECT_TRUE(std::ranges::equal(p.contacts, q.contacts));
  EXPECT_TRUE(std::ranges::equal(p.continuous_contacts, q.continuous_contacts));
  EXPECT_TRUE(std::ranges::equal(p.proximity_pairs, q.proximity_pairs));
  EXPECT_TRUE(std::ranges::equal(p.object_pairs, q.object_pairs));
}

TEST(SceneSearch, FindsWhatDetectFinds) {
  for (const std::uint32_t threads : {1u, 3u}) {
    Scene scene({.contacts = three_kinds, .threads = threads});
    BallsOfASearch balls(scene);
    for (int step = 0; step < 5; ++step) {
      balls.place(balls.ids[static_cast<std::size_t>(step)]);
      const DetectResult& apart = scene.search({});
      EXPECT_FALSE(apart.contacts.empty());
      EXPECT_FALSE(apart.continuous_contacts.empty());
      EXPECT_FALSE(apart.proximity_pairs.empty());
      EXPECT_TRUE(apart.contact_events.begin.empty());
      expect_equal(apart, scene.detect());
      expect_equal(scene.search({}), scene.result());
    }
  }
}

TEST(SceneSearch, DoesNotMakeAStep) {
  Scene scene;
  BallsOfASearch balls(scene);
  Scene without;
  BallsOfASearch same(without);
  for (int step = 0; step < 6; ++step) {
    const std::size_t place = static_cast<std::size_t>(step);
    balls.place(balls.ids[place]);
    scene.search({.contacts = three_kinds});  // in the middle of a step
    balls.place(balls.ids[place + 1]);
    same.place(same.ids[place]);
    same.place(same.ids[place + 1]);
    const DetectResult &p = scene.detect(), &q = without.detect();
    const std::size_t count = p.contacts.size();
    scene.search({.contacts = ContactKinds::proximity});
    EXPECT_EQ(p.step, q.step);
    EXPECT_EQ(p.contacts.size(), count);
    expect_equal(p, q);
    const auto expect_equal_events = [](const PairEvents& of_p, const PairEvents& of_q) {
      EXPECT_TRUE(std::ranges::equal(of_p.begin, of_q.begin));
      EXPECT_TRUE(std::ranges::equal(of_p.stay, of_q.stay));
      EXPECT_TRUE(std::ranges::equal(of_p.end, of_q.end));
    };
    expect_equal_events(p.contact_events, q.contact_events);
    expect_equal_events(p.volume_events, q.volume_events);
  }
  EXPECT_TRUE(verify(scene).agrees());
}

TEST(SceneSearch, TestsOnlyWhatTheFunctionAccepts) {
  Scene scene({.contacts = three_kinds});
  BallsOfASearch balls(scene);
  scene.set_pair_filter([](ObjectId a, ObjectId b) { return a.index + b.index != 5; });
  const auto is_wanted = [](ObjectId a, ObjectId b) { return a.index % 4 != 0 && b.index % 2 == 1; };
  std::vector<Contact> expected;
  for (const Contact& contact : scene.detect().contacts) {
    if (is_wanted(contact.object_a, contact.object_b)) expected.push_back(contact);
  }
  const DetectResult& found = scene.search({}, is_wanted);
  EXPECT_FALSE(expected.empty());
  EXPECT_LT(expected.size(), scene.result().contacts.size());
  ASSERT_EQ(found.contacts.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(found.contacts[i].triangle_a, expected[i].triangle_a);
    EXPECT_EQ(found.contacts[i].triangle_b, expected[i].triangle_b);
  }
  EXPECT_TRUE(found.untested.empty());
  const DetectResult& nothing = scene.search({}, [](ObjectId, ObjectId) { return false; });
  EXPECT_TRUE(nothing.contacts.empty());
  ASSERT_EQ(nothing.untested.size(), 3u);
  EXPECT_EQ(nothing.untested[0].reason, NothingToTest::filter);
}

TEST(SceneSearch, AsksForSelfCollisionToo) {
  Scene scene;
  TriangleMesh two = make_icosphere(4);  // two balls that overlap, as one object
  const std::size_t vertices = two.positions.size(), triangles = two.triangles.size();
  for (std::size_t v = 0; v < vertices; ++v) two.positions.push_back(two.positions[v] + Vec3d{0.7, 0.1, 0.2});
  for (std::size_t t = 0; t < triangles; ++t) {
    Triangle moved = two.triangles[t];
    for (std::uint32_t& v : moved) v += static_cast<std::uint32_t>(vertices);
    two.triangles.push_back(moved);
  }
  const ObjectId id = scene.add(two, {.self_collision = true});
  EXPECT_FALSE(scene.search({}, [&](ObjectId a, ObjectId b) { return a == id && b == id; }).contacts.empty());
  EXPECT_TRUE(scene.search({}, [](ObjectId a, ObjectId b) { return a != b; }).contacts.empty());
}

TEST(SceneSearch, MakesNoManifolds) {
  Scene scene({.contacts = ContactKinds::proximity, .manifolds = true});
  BallsOfASearch balls(scene);
  EXPECT_TRUE(scene.search({}).manifolds.empty());
  EXPECT_FALSE(scene.detect().manifolds.empty());
  EXPECT_THROW(scene.search({.manifolds = true}), Error);
}

TEST(SceneSearch, SeesRemovedAndAddedObjects) {
  Scene scene({.contacts = three_kinds});
  BallsOfASearch balls(scene);
  scene.search({});
  scene.detect();
  for (int i = 0; i < 4; ++i) {
    scene.remove(balls.ids[static_cast<std::size_t>(i)]);
    if (i % 2 == 0) scene.add(make_icosphere(3), {.margin = 0.2});
    expect_equal(scene.search({}), scene.detect());
  }
}

}  // namespace supple::search_test
