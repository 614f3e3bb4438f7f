// Functions of the user that throw: the call of the scene ends with what they throw, and the next call gives
// the same answers as without it.

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "supple/models.hpp"
#include "supple/scene.hpp"

namespace supple::throwing_functions_test {

constexpr int never = 1 << 30;

struct Thrown {
  int call;
};

/// Counts the calls of a function and throws at one of them.
struct Trap {
  int calls = 0, throws_at = never;

  void step() {
    if (calls++ == throws_at) throw Thrown{throws_at};
  }
};

constexpr ContactKinds all_kinds = ContactKinds::intersection | ContactKinds::continuous |
                                   ContactKinds::proximity | ContactKinds::penetration;

/// Four balls in a row that overlap and fly.
void fill(Scene& scene) {
  for (int i = 0; i < 4; ++i) {
    TriangleMesh ball = make_icosphere(1);
    for (Vec3d& p : ball.positions) p += Vec3d{0.8 * i, 0.1 * i, 0};
    const ObjectId id = scene.add(ball, {.margin = 0.05, .solid = true});
    std::vector<Vec3d> from = ball.positions;
    for (Vec3d& p : from) p += Vec3d{0, 3.0 * i, 0};
    scene.set_motion(id, from, ball.positions);
  }
}

using Numbers = std::vector<double>;
struct Call {
  std::string name;
  std::function<Numbers(Scene&)> make;
};

Numbers numbers_of(const DetectResult& result) {
  Numbers numbers;
  for (const Contact& contact : result.contacts)
    numbers.push_back(contact.triangle_a + 1e4 * contact.triangle_b);
  for (const ContinuousContact& contact : result.continuous_contacts) numbers.push_back(contact.toi);
  for (const ProximityPair& pair : result.proximity_pairs) numbers.push_back(pair.distance);
  for (const Penetration& vertex : result.penetrations) numbers.push_back(vertex.depth);
  for (const ObjectPair& pair : result.contact_events.begin) numbers.push_back(pair.b.index);
  return numbers;
}

std::vector<Call> calls() {
  return {
      {"detect", [](Scene& scene) { return numbers_of(scene.detect({.contacts = all_kinds})); }},
      {"search", [](Scene& scene) { return numbers_of(scene.search({.contacts = all_kinds})); }},
      {"earliest_impact", [](Scene& scene) { return Numbers{scene.earliest_impact().value().toi}; }},
      {"max_step", [](Scene& scene) { return Numbers{scene.max_step().step}; }},
      {"collision_free_step", [](Scene& scene) { return Numbers{scene.collision_free_step().step}; }},
      {"collision_free_steps",
       [](Scene& scene) {
         Numbers numbers;
         for (const ObjectStep& step : scene.collision_free_steps()) numbers.push_back(step.safe.step);
         return numbers;
       }},
      {"distances",
       [](Scene& scene) {
         Numbers numbers;
         for (const ProximityPair& pair : scene.distances(100)) numbers.push_back(pair.distance);
         return numbers;
       }},
  };
}

TEST(ThrowingFunctions, APairFilterThatThrowsAtAnyCallLeavesTheSceneUsable) {
  for (const std::uint32_t threads : {1u, 2u}) {
    for (const Call& call : calls()) {
      Trap trap;
      const auto filter = [&](ObjectId a, ObjectId b) {
        trap.step();
        return a.index + b.index != 4;
      };
      Scene plain({.threads = threads});
      fill(plain);
      plain.set_pair_filter(filter);
      const Numbers expected = call.make(plain);
      const int count = trap.calls;
      EXPECT_FALSE(expected.empty()) << call.name;
      ASSERT_GT(count, 0) << call.name;
      const Numbers then = numbers_of(plain.detect({.contacts = all_kinds}));
      for (int at = 0; at < count; ++at) {
        Scene scene({.threads = threads});
        fill(scene);
        scene.set_pair_filter(filter);
        trap = {0, at};
        EXPECT_THROW(call.make(scene), Thrown) << call.name << " " << at;
        trap = {};
        EXPECT_EQ(call.make(scene), expected) << call.name << " " << at;
        EXPECT_EQ(numbers_of(scene.detect({.contacts = all_kinds})), then) << call.name << " " << at;
      }
    }
  }
}

TEST(ThrowingFunctions, AFilterOfOneSearchThatThrowsLeavesTheSceneUsable) {
  Trap trap;
  Scene scene({.threads = 2});
  fill(scene);
  const auto search = [&] {
    return numbers_of(scene.search({.contacts = all_kinds}, [&](ObjectId, ObjectId) {
      trap.step();
      return true;
    }));
  };
  const Numbers expected = search();
  const int count = trap.calls;
  ASSERT_GT(count, 0);
  for (int at = 0; at < count; ++at) {
    trap = {0, at};
    EXPECT_THROW(search(), Thrown) << at;
    trap = {};
    EXPECT_EQ(search(), expected) << at;
  }
}

TEST(ThrowingFunctions, AnObserverThatThrowsKeepsTheResult) {
  for (const std::uint32_t threads : {1u, 2u}) {
    Trap trap;
    Scene plain({.threads = threads}), scene({.threads = threads});
    fill(plain);
    fill(scene);
    scene.set_observer([&](const Scene&, const DetectRequest&) { trap.step(); });
    for (int at = 0; at < 3; ++at) {
      trap = {0, 0};
      EXPECT_THROW(scene.detect({.contacts = all_kinds}), Thrown);
      EXPECT_EQ(numbers_of(scene.result()), numbers_of(plain.detect({.contacts = all_kinds}))) << at;
      trap = {};
      EXPECT_EQ(numbers_of(scene.detect()), numbers_of(plain.detect())) << at;
    }
  }
}

}  // namespace supple::throwing_functions_test
