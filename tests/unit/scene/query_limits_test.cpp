// Limits of queries: `CallLimits::stop` and `SceneOptions::max_exact_bits`.

#include <gtest/gtest.h>

#include <functional>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "supple/error.hpp"
#include "supple/models.hpp"
#include "supple/scene.hpp"

namespace supple {
namespace {

/// A ball and a box that is near.
struct Objects {
  Scene scene;
  ObjectId ball, box;

  explicit Objects(const SceneOptions& options = {}, double tiny = 0) : scene(options) {
    TriangleMesh mesh = make_box({1, 1, 1});
    for (Vec3d& p : mesh.positions) p += {2, tiny, 0};
    ball = scene.add(make_icosphere(4), {.name = "ball"});
    box = scene.add(mesh, {.name = "box"});
  }
};

TEST(StoppedQuery, HasNoAnswers) {
  Objects objects;
  Scene& scene = objects.scene;
  std::stop_source source;
  const CallLimits stopped{source.get_token()};
  source.request_stop();
  const std::vector<Vec3d> points{{0, 0, 0}, {3, 0, 0}};
  const std::vector<Ray> rays{{{-5, 0, 0}, {1, 0, 0}}};
  const std::vector<QueryBox> boxes{{{-1, -1, -1}, {1, 1, 1}}};
  const std::vector<QuerySphere> spheres{{{0, 0, 0}, 2}};

  std::vector<std::optional<ClosestPoint>> nearest(2);
  std::vector<std::optional<RayHit>> hits(1);
  std::vector<Containment> places(2);
  for (const bool stops : {true, false}) {
    const CallLimits limits = stops ? stopped : CallLimits{};
    scene.closest(points, nearest, {.limits = limits});
    scene.cast(rays, hits, {.limits = limits});
    scene.inside(points, places, {}, limits);
    EXPECT_EQ(nearest[0].has_value(), !stops);
    EXPECT_EQ(hits[0].has_value(), !stops);
    EXPECT_EQ(places[0], stops ? Containment::outside : Containment::inside);
    EXPECT_EQ(scene.cast_all(rays, {}, limits).empty(), stops);
    EXPECT_EQ(scene.overlaps(boxes, {}, limits).empty(), stops);
    EXPECT_EQ(scene.overlaps(spheres, {}, limits).empty(), stops);
    EXPECT_EQ(scene.distance(objects.ball, objects.box, limits).has_value(), !stops);
    EXPECT_EQ(scene.distances(2, limits).empty(), stops);
  }
  scene.translate(objects.box, {-1.5, 0, 0});
  EXPECT_FALSE(scene.any_contact(objects.ball, objects.box, stopped));
  EXPECT_TRUE(scene.any_contact(objects.ball, objects.box));
}

TEST(StoppedQuery, OfVerifySaysSo) {
  Objects objects;
  std::stop_source source;
  objects.scene.detect();
  EXPECT_FALSE(objects.scene.verify({source.get_token()}).stopped);
  source.request_stop();
  const VerifyReport report = objects.scene.verify({source.get_token()});
  EXPECT_TRUE(report.stopped);
  EXPECT_EQ(report.triangle_pairs_checked, 0u);
}

std::string message_of(const std::function<void()>& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(QueryExactLimit, IsAnErrorThatNamesObjectAndQuery) {
  constexpr double tiny = 0x1p-400;
  Objects objects({.max_exact_bits = 252});
  Scene& scene = objects.scene;
  const auto expect = [&](const std::string& call, const std::string& query,
                          const std::function<void()>& run) {
    const std::string found = message_of(run);
    EXPECT_EQ(found.substr(0, call.size() + 1), call + ":");
    EXPECT_NE(found.find(query), std::string::npos) << found;
    EXPECT_NE(found.find("with ball, "), std::string::npos) << found;
    EXPECT_NE(found.find("but max_exact_bits is 252; raise it"), std::string::npos) << found;
  };
  std::vector<std::optional<ClosestPoint>> nearest(2);
  std::vector<std::optional<RayHit>> hits(1);
  std::vector<Containment> places(2);
  const std::vector<Vec3d> points{{0, 0, 0}, {0.5, tiny, 0}};
  const std::vector<Ray> rays{{{-5, 0, 0}, {1, tiny, 0}}};
  const std::vector<QueryBox> boxes{{{-1, -1, -1}, {1, 1, tiny}}};
  const std::vector<QuerySphere> spheres{{{0, 0, tiny}, 1}};
  expect("closest", "point 1", [&] { scene.closest(points, nearest); });
  expect("inside", "point 1", [&] { scene.inside(points, places); });
  expect("cast", "ray 0", [&] { scene.cast(rays, hits); });
  expect("cast_all", "ray 0", [&] { scene.cast_all(rays); });
  expect("overlaps", "box 0", [&] { scene.overlaps(boxes); });
  expect("overlaps", "sphere 0", [&] { scene.overlaps(spheres); });
  const std::vector<Vec3d> plain{{0, 0, 0}, {0.5, 0, 0}};
  EXPECT_EQ(message_of([&] { scene.closest(plain, nearest); }), "");
  EXPECT_EQ(message_of([&] { scene.closest(plain, nearest, {.max_distance = 2}); }), "");
  expect("closest", "the largest distance", [&] { scene.closest(plain, nearest, {.max_distance = tiny}); });
}

TEST(QueryExactLimit, CountsTheObjectsOfAPair) {
  Objects objects({.max_exact_bits = 252});
  Scene& scene = objects.scene;
  EXPECT_TRUE(scene.distance(objects.ball, objects.box));
  const ObjectId tiny = scene.add({"tiny", {{1.5, 0, 0}, {1.6, 0x1p-400, 0}, {1.5, 1, 0}}, {{0, 1, 2}}});
  for (const auto& call : std::vector<std::function<void()>>{[&] { scene.distance(objects.ball, tiny); },
                                                             [&] { scene.any_contact(tiny, objects.ball); },
                                                             [&] { scene.distances(10); }}) {
    const std::string found = message_of(call);
    EXPECT_NE(found.find("with ball and tiny, "), std::string::npos) << found;
    EXPECT_NE(found.find("but max_exact_bits is 252"), std::string::npos) << found;
  }
  EXPECT_TRUE(scene.distance(objects.ball, objects.box));
  Objects without({}, 0x1p-400);
  EXPECT_TRUE(without.scene.distance(without.ball, without.box));
}

}  // namespace
}  // namespace supple
