// Queries are const: several threads may ask at the same time.

#include <gtest/gtest.h>

#include <cstdint>
#include <functional>
#include <optional>
#include <thread>
#include <vector>

#include "supple/models.hpp"
#include "supple/scene.hpp"
#include "support/random.hpp"

namespace supple::concurrent_queries_test {

/// The answers to all kinds of queries.
struct Answers {
  std::vector<std::optional<ClosestPoint>> closest;
  std::vector<std::optional<RayHit>> hits;
  std::vector<Containment> sides;
  std::vector<ListedRayHit> listed;
  std::vector<Overlap> overlaps;
  std::vector<ProximityPair> distances;
  std::optional<ProximityPair> distance;
  bool touch = false;

  bool operator==(const Answers&) const = default;
};

struct Asked {
  std::vector<Vec3d> points;
  std::vector<Ray> rays;
  std::vector<QuerySphere> spheres;

  Asked() {
    RandomNumbers random(3);
    for (int i = 0; i < 300; ++i) {
      points.push_back(random.vector(3));
      rays.push_back({random.vector(3), random.vector(1)});
      spheres.push_back({random.vector(3), 0.3});
    }
  }
  Answers ask(const Scene& scene, ObjectId a, ObjectId b) const {
    Answers answers;
    answers.closest.resize(points.size());
    answers.hits.resize(rays.size());
    answers.sides.resize(points.size());
    scene.closest(points, answers.closest);
    scene.cast(rays, answers.hits);
    scene.inside(points, answers.sides);
    answers.listed = scene.cast_all(rays);
    answers.overlaps = scene.overlaps(spheres);
    answers.distances = scene.distances(5);
    answers.distance = scene.distance(a, b);
    answers.touch = scene.any_contact(a, b);
    return answers;
  }
};

TEST(ConcurrentSceneQueries, GiveTheAnswersOfOneThread) {
  const Asked asked;
  for (const std::uint32_t workers : {1u, 2u}) {
    std::vector<Answers> expected;
    std::vector<std::vector<Answers>> found;
    for (const bool concurrent : {false, true}) {
      Scene scene({.threads = workers});
      std::vector<ObjectId> ids;
      RandomNumbers random(9);
      for (int i = 0; i < 6; ++i) ids.push_back(scene.add(make_icosphere(5)));
      scene.translate(ids[5], {1e7, 0, 0});  // far: needs boxes in double
      for (int round = 0; round < 3; ++round) {
        for (int i = 0; i < 5; ++i) {
          std::vector<Vec3d> moved = make_icosphere(5).positions;
          const Vec3d offset = random.vector(2.5);
          for (Vec3d& p : moved) p = p + offset;
          scene.set_positions(ids[static_cast<std::size_t>(i)], moved);
        }
        if (!concurrent) {
          expected.push_back(asked.ask(scene, ids[0], ids[5]));
          continue;
        }
        // All of them refit, because nothing has yet asked since the objects moved.
        std::vector<Answers> of_round(4);
        std::vector<std::thread> threads;
        for (Answers& answers : of_round)
          threads.emplace_back([&] { answers = asked.ask(scene, ids[0], ids[5]); });
        for (std::thread& thread : threads) thread.join();
        found.push_back(of_round);
      }
    }
    for (std::size_t round = 0; round < expected.size(); ++round) {
      EXPECT_FALSE(expected[round].listed.empty());
      for (const Answers& answers : found[round]) EXPECT_EQ(answers, expected[round]);
    }
  }
}

}  // namespace supple::concurrent_queries_test
