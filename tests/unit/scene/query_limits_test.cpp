// Limits of queries: `CallLimits::stop`.

#include <gtest/gtest.h>

#include <optional>
#include <stop_token>
#include <vector>

#include "supple/models.hpp"
#include "supple/scene.hpp"
#include "supple/verify.hpp"

namespace supple::query_limits_test {

/// A ball and a box that is near.
struct Objects {
  Scene scene;
  ObjectId ball, box;

  Objects() {
    TriangleMesh mesh = make_box({1, 1, 1});
    for (Vec3d& p : mesh.positions) p += {2, 0, 0};
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
  EXPECT_FALSE(verify(objects.scene, {source.get_token()}).stopped);
  source.request_stop();
  const VerifyReport report = verify(objects.scene, {source.get_token()});
  EXPECT_TRUE(report.stopped);
  EXPECT_EQ(report.triangle_pairs_checked, 0u);
}

}  // namespace supple::query_limits_test
