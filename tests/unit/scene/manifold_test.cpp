// Manifolds: a normal, a depth and at most four points for each patch of contacts, with ids that last.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "supple/error.hpp"
#include "supple/models.hpp"
#include "supple/scene.hpp"
#include "supple/trigonometry.hpp"

namespace supple::manifold_test {

constexpr SceneOptions touching{.contacts = ContactKinds::penetration, .manifolds = true};
constexpr SceneOptions near{.contacts = ContactKinds::proximity, .manifolds = true};

/// A floor from -10 to 10 at y = 0, of 2 n² triangles.
TriangleMesh floor_of(std::uint32_t n) {
  TriangleMesh floor;
  for (std::uint32_t i = 0; i <= n; ++i) {
    for (std::uint32_t k = 0; k <= n; ++k)
      floor.positions.push_back({20.0 * i / n - 10, 0, 20.0 * k / n - 10});
  }
  const auto at = [&](std::uint32_t i, std::uint32_t k) { return i * (n + 1) + k; };
  for (std::uint32_t i = 0; i < n; ++i) {
    for (std::uint32_t k = 0; k < n; ++k) {
      floor.triangles.push_back({at(i, k), at(i, k + 1), at(i + 1, k + 1)});
      floor.triangles.push_back({at(i, k), at(i + 1, k + 1), at(i + 1, k)});
    }
  }
  return floor;
}

std::vector<Vec3d> sorted_positions(std::span<const ManifoldPoint> points) {
  std::vector<Vec3d> positions;
  for (const ManifoldPoint& point : points) positions.push_back(point.position);
  std::sort(positions.begin(), positions.end(), [](const Vec3d& p, const Vec3d& q) {
    return std::tuple(std::nearbyint(64 * p.x), p.z) < std::tuple(std::nearbyint(64 * q.x), q.z);
  });
  return positions;
}

std::vector<std::uint64_t> ids_of(std::span<const ManifoldPoint> points) {
  std::vector<std::uint64_t> ids;
  for (const ManifoldPoint& point : points) ids.push_back(point.id);
  std::sort(ids.begin(), ids.end());
  return ids;
}

/// The area of the polygon of the points, seen along the normal: positive when they turn counter-clockwise
/// for eyes on the side of a.
double area_of(std::span<const ManifoldPoint> points, const Vec3d& normal) {
  Vec3d sum;
  for (std::size_t i = 0; i < points.size(); ++i) {
    sum += cross(points[i].position - points[0].position,
                 points[(i + 1) % points.size()].position - points[0].position);
  }
  return 0.5 * dot(sum, normal);
}

TEST(Manifold, BoxOnFloorHasItsCorners) {
  for (const std::uint32_t n : {1u, 3u, 16u}) {
    for (const bool intersects : {true, false}) {
      Scene scene(intersects ? touching : near);
      const ObjectId box = scene.add(make_box({2, 2, 2}), {.margin = 0.01, .solid = true});
      scene.add(floor_of(n), {.name = "floor", .margin = 0.01});
      scene.translate(box, {0.125, intersects ? 1 : 1.0078125, 0.25});
      const DetectResult& result = scene.detect();
      ASSERT_EQ(result.manifolds.size(), 1u) << n;
      const Manifold& manifold = result.manifolds[0];
      EXPECT_EQ(manifold.a, box);
      EXPECT_EQ(manifold.source, intersects ? ManifoldSource::curve : ManifoldSource::pairs);
      EXPECT_LE(norm(manifold.normal - Vec3d{0, 1, 0}), 1e-15) << n;
      EXPECT_EQ(manifold.depth, intersects ? 0 : -0.0078125);
      const auto points = result.points_of(manifold);
      ASSERT_EQ(points.size(), 4u);
      const double y = intersects ? 0 : 0.00390625;
      const Vec3d corners[] = {{-0.875, y, -0.75}, {-0.875, y, 1.25}, {1.125, y, -0.75}, {1.125, y, 1.25}};
      const std::vector<Vec3d> found = sorted_positions(points);
      for (std::size_t i = 0; i < 4; ++i) EXPECT_LE(norm(found[i] - corners[i]), 1e-14);
      EXPECT_NEAR(area_of(points, manifold.normal), 4, 1e-12);
      for (const ManifoldPoint& point : points) EXPECT_EQ(point.depth, manifold.depth);
      EXPECT_EQ(manifold.lasting, Lasting::begin);
      EXPECT_EQ(points[0].lasting, Lasting::begin);
    }
  }
}

// Only corners of equal boxes in a stack are nearest features, so no two pairs have a vertex in common.
TEST(Manifold, EqualBoxesInAStackHaveOnePatch) {
  for (const std::uint32_t n : {1u, 4u}) {
    Scene scene(near);
    const ObjectId box = scene.add(make_box({2, 2, 2}, n), {.margin = 0.0625});
    scene.add(make_box({2, 2, 2}, n), {.margin = 0.0625});
    for (const double shift : {0.0, 0.25, 0.0}) {
      scene.set_transform(box, {.translation = {shift, 2.125, 0}});
      const DetectResult& result = scene.detect();
      ASSERT_EQ(result.manifolds.size(), 1u) << n << ' ' << shift;
      EXPECT_EQ(result.manifolds[0].id, 1u);
      EXPECT_EQ(result.manifolds[0].normal, (Vec3d{0, 1, 0}));
      EXPECT_EQ(result.manifolds[0].depth, -0.125);
      ASSERT_EQ(result.manifolds[0].point_count, 4u) << n << ' ' << shift;
      EXPECT_NEAR(area_of(result.points_of(result.manifolds[0]), {0, 1, 0}), 2 * (2 - shift), 1e-12);
    }
  }
}

TEST(Manifold, BoxInFloorHasItsCornersWithTheirDepths) {
  Scene scene(touching);
  const ObjectId box = scene.add(make_box({2, 2, 2}, 3), {.solid = true});
  scene.add(floor_of(2), {.name = "floor"});
  scene.translate(box, {0.125, 0.9375, 0.25});
  const DetectResult& result = scene.detect();
  ASSERT_EQ(result.manifolds.size(), 1u);
  EXPECT_EQ(result.manifolds[0].normal, (Vec3d{0, 1, 0}));
  EXPECT_EQ(result.manifolds[0].depth, 0.0625);
  const auto points = result.points_of(result.manifolds[0]);
  ASSERT_EQ(points.size(), 4u);
  for (const ManifoldPoint& point : points) {
    EXPECT_EQ(point.depth, 0.0625);
    EXPECT_EQ(point.position.y, -0.0625);
  }
  EXPECT_NEAR(area_of(points, {0, 1, 0}), 4, 1e-12);
}

TEST(Manifold, BoxOnItsEdgeHasTwoPoints) {
  for (const bool intersects : {true, false}) {
    Scene scene(intersects ? touching : near);
    const ObjectId box = scene.add(make_box({2, 2, 2}), {.margin = 0.01});
    scene.add(floor_of(5), {.name = "floor", .margin = 0.01});
    // Half a right angle around z, scaled so that the numbers are exact.
    scene.set_transform(box, {{1, -1, 0, 1, 1, 0, 0, 0, 1}, {0.125, intersects ? 2 : 2.0078125, 0.25}});
    const DetectResult& result = scene.detect();
    ASSERT_EQ(result.manifolds.size(), 1u);
    const auto positions = sorted_positions(result.points_of(result.manifolds[0]));
    ASSERT_EQ(positions.size(), 2u) << intersects;
    EXPECT_EQ(positions[0].z, -0.75);
    EXPECT_EQ(positions[1].z, 1.25);
    EXPECT_EQ(positions[0].x, 0.125);
  }
}

TEST(Manifold, SphereOnFloorHasOnePoint) {
  for (const bool intersects : {true, false}) {
    Scene scene(intersects ? touching : near);
    TriangleMesh ball = make_icosphere(4);
    const auto lowest = std::min_element(ball.positions.begin(), ball.positions.end(),
                                         [](const Vec3d& p, const Vec3d& q) { return p.y < q.y; });
    // Only this vertex touches.
    const double y = lowest->y;
    *lowest = {lowest->x, y - 0.0625, lowest->z};
    const ObjectId id = scene.add(ball, {.margin = 0.001});
    scene.add(floor_of(3), {.name = "floor", .margin = 0.001});
    scene.translate(id, {0.3, 0.0625 - y, 0.2});
    const DetectResult& result = scene.detect();
    ASSERT_EQ(result.manifolds.size(), 1u);
    ASSERT_EQ(result.manifolds[0].point_count, 1u);
    EXPECT_NEAR(result.manifold_points[0].position.y, 0, 1e-12);
  }
}

TEST(Manifold, SphereInFloorHasItsDeepestPoint) {
  Scene scene(touching);
  const ObjectId ball = scene.add(make_icosphere(6), {.solid = true});
  scene.add(floor_of(3), {.name = "floor"});
  scene.translate(ball, {0.3, 0.8, 0.2});
  const DetectResult& result = scene.detect();
  ASSERT_EQ(result.manifolds.size(), 1u);
  const Manifold& manifold = result.manifolds[0];
  const auto points = result.points_of(manifold);
  EXPECT_EQ(points.size(), 4u);
  double deepest = 0;
  for (const ManifoldPoint& point : points) deepest = std::max(deepest, point.depth);
  EXPECT_NEAR(deepest, manifold.depth, 1e-12);
  EXPECT_GT(area_of(points, manifold.normal), 0.25);
}

TEST(Manifold, IdsLastWhileABoxSlides) {
  for (const bool intersects : {true, false}) {
    Scene scene(intersects ? touching : near);
    const ObjectId box = scene.add(make_box({2, 2, 2}, 3), {.margin = 0.01});
    scene.add(floor_of(7), {.name = "floor", .margin = 0.01});
    const double height = intersects ? 1 : 1.005;
    scene.translate(box, {-5, height, 0.25});
    const DetectResult& first = scene.detect();
    ASSERT_EQ(first.manifolds.size(), 1u);
    const std::uint64_t id = first.manifolds[0].id;
    const auto points = ids_of(first.manifold_points);
    std::vector<Vec3d> before(4);
    for (const ManifoldPoint& point : first.manifold_points)
      before[static_cast<std::size_t>(std::find(points.begin(), points.end(), point.id) - points.begin())] =
          point.position;
    for (int step = 0; step < 40; ++step) {
      scene.translate(box, {0.25, 0, 0.03125});
      const DetectResult& result = scene.detect();
      ASSERT_EQ(result.manifolds.size(), 1u);
      EXPECT_EQ(result.manifolds[0].id, id);
      EXPECT_EQ(result.manifolds[0].lasting, Lasting::stay);
      ASSERT_EQ(ids_of(result.manifold_points), points) << step;
      EXPECT_TRUE(result.ended_manifolds.empty());
      for (const ManifoldPoint& point : result.manifold_points) {
        EXPECT_EQ(point.lasting, Lasting::stay);
        Vec3d& was = before[static_cast<std::size_t>(std::find(points.begin(), points.end(), point.id) -
                                                     points.begin())];
        EXPECT_LE(norm(point.position - (was + Vec3d{0.25, 0, 0.03125})), 1e-12)
            << "each corner keeps its id";
        was = point.position;
      }
    }
    scene.translate(box, {0, 5, 0});
    const DetectResult& apart = scene.detect();
    EXPECT_TRUE(apart.manifolds.empty());
    ASSERT_EQ(apart.ended_manifolds.size(), 1u);
    EXPECT_EQ(apart.ended_manifolds[0].id, id);
    EXPECT_TRUE(scene.detect().ended_manifolds.empty());
    scene.translate(box, {0, -5, 0});
    const DetectResult& again = scene.detect();
    ASSERT_EQ(again.manifolds.size(), 1u);
    EXPECT_EQ(again.manifolds[0].lasting, Lasting::begin);
    EXPECT_GT(again.manifolds[0].id, id);
  }
}

TEST(Manifold, AStackHasOneForEachTwoBoxes) {
  Scene scene(touching);
  const ObjectId floor = scene.add(floor_of(3), {.name = "floor"});
  std::vector<ObjectId> boxes;
  for (int i = 0; i < 5; ++i) {
    boxes.push_back(scene.add(make_box({2, 2, 2}), {.solid = true}));
    scene.translate(boxes.back(), {0.25 * i, 1 + 2.0 * i, 0.125 * i});
  }
  std::set<std::uint64_t> ids;
  for (int step = 0; step < 3; ++step) {
    const DetectResult& result = scene.detect();
    ASSERT_EQ(result.manifolds.size(), 5u);
    for (std::size_t i = 0; i < 5; ++i) {
      const Manifold& manifold = result.manifolds[i];
      EXPECT_EQ(manifold.a, i == 0 ? floor : boxes[i - 1]);
      EXPECT_EQ(manifold.b, boxes[i]);
      EXPECT_EQ(manifold.normal, (Vec3d{0, -1, 0}));
      EXPECT_EQ(manifold.depth, 0);
      EXPECT_EQ(manifold.point_count, 4u);
      EXPECT_EQ(ids.insert(manifold.id).second, step == 0);
    }
  }
}

/// A table with four legs of width 1, whose feet are at y = 0.
TriangleMesh table() {
  TriangleMesh mesh;
  const auto add = [&](TriangleMesh part, Vec3d at) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const Vec3d& p : part.positions) mesh.positions.push_back(p + at);
    for (const auto& [v, w, x] : part.triangles) mesh.triangles.push_back({v + first, w + first, x + first});
  };
  for (const double x : {-3.0, 3.0}) {
    for (const double z : {-3.0, 3.0}) add(make_box({1, 4, 1}), {x, 2, z});
  }
  return mesh;
}

TEST(Manifold, PatchesSplitAndMerge) {
  Scene scene(touching);
  const ObjectId legs = scene.add(table(), {});
  TriangleMesh ground = floor_of(20);
  const ObjectId floor = scene.add(ground, {.name = "floor"});
  scene.translate(legs, {0, -0.25, 0});
  ASSERT_EQ(scene.detect().manifolds.size(), 4u);
  std::vector<std::uint64_t> ids;
  for (const Manifold& manifold : scene.result().manifolds) ids.push_back(manifold.id);
  // The floor sinks below one leg: its patch ends, the others stay.
  std::vector<Vec3d> hole = ground.positions;
  for (Vec3d& p : hole) {
    if (p.x > 1 && p.z > 1) p.y = -2;
  }
  scene.set_positions(floor, hole);
  const DetectResult& three = scene.detect();
  ASSERT_EQ(three.manifolds.size(), 3u);
  ASSERT_EQ(three.ended_manifolds.size(), 1u);
  std::set<std::uint64_t> seen{three.ended_manifolds[0].id};
  for (const Manifold& manifold : three.manifolds) {
    EXPECT_EQ(manifold.lasting, Lasting::stay);
    seen.insert(manifold.id);
  }
  EXPECT_EQ(seen, std::set<std::uint64_t>(ids.begin(), ids.end()));
  scene.set_positions(floor, ground.positions);
  const DetectResult& four = scene.detect();
  ASSERT_EQ(four.manifolds.size(), 4u);
  EXPECT_EQ(std::count_if(four.manifolds.begin(), four.manifolds.end(),
                          [](const Manifold& m) { return m.lasting == Lasting::begin; }),
            1);
  // A bar across two bumps: one patch when it lies flat, two when the middle of it is bent upwards.
  Scene bars(touching);
  const TriangleMesh bar = make_box({8, 1, 1}, 8);
  const ObjectId id = bars.add(bar);
  bars.add(floor_of(16), {.name = "floor"});
  std::vector<Vec3d> flat = bar.positions, bent = bar.positions;
  for (Vec3d& p : flat) p.y += 0.375;
  for (Vec3d& p : bent) p.y += std::fabs(p.x) < 2.5 ? 2 : 0.375;
  bars.set_positions(id, flat);
  ASSERT_EQ(bars.detect().manifolds.size(), 1u);
  const std::uint64_t whole = bars.result().manifolds[0].id;
  bars.set_positions(id, bent);
  ASSERT_EQ(bars.detect().manifolds.size(), 2u);
  const auto& split = bars.result().manifolds;
  EXPECT_TRUE((split[0].id == whole) != (split[1].id == whole)) << "one part stays";
  EXPECT_TRUE(bars.result().ended_manifolds.empty());
  bars.set_positions(id, flat);
  ASSERT_EQ(bars.detect().manifolds.size(), 1u);
  EXPECT_EQ(bars.result().manifolds[0].lasting, Lasting::stay);
  EXPECT_EQ(bars.result().ended_manifolds.size(), 1u);
}

TEST(Manifold, PatchesOfPairsHaveOneSide) {
  // A ball in a corner of three walls, and a cloth around a ball: no patch looks both ways.
  Scene scene(near);
  TriangleMesh corner = floor_of(4);
  const TriangleMesh one = corner;
  for (const int turn : {1, 2}) {
    const auto first = static_cast<std::uint32_t>(corner.positions.size());
    for (const Vec3d& p : one.positions)
      corner.positions.push_back(turn == 1 ? Vec3d{p.y, p.z, p.x} : Vec3d{p.z, p.x, p.y});
    for (const auto& [v, w, x] : one.triangles) corner.triangles.push_back({v + first, w + first, x + first});
  }
  const ObjectId ball = scene.add(make_icosphere(4), {.margin = 0.06});
  scene.add(corner, {.margin = 0.06});
  scene.translate(ball, {1.05, 1.05, 1.05});
  const DetectResult& result = scene.detect();
  ASSERT_GE(result.manifolds.size(), 3u);
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_TRUE(std::any_of(result.manifolds.begin(), result.manifolds.end(),
                            [&](const Manifold& m) { return m.normal[axis] > 0.99; }));
  }
  Scene wrapped(near);
  wrapped.add(make_icosphere(6), {.margin = 0.05});
  TriangleMesh shell = make_icosphere(6);
  for (Vec3d& p : shell.positions) p = 1.08 * p;
  wrapped.add(shell, {.margin = 0.05});
  const DetectResult& around = wrapped.detect();
  EXPECT_GT(around.manifolds.size(), 5u);
  EXPECT_LT(around.manifolds.size(), 60u);
}

TEST(Manifold, HasNoneWithoutRequest) {
  Scene scene({.contacts = ContactKinds::penetration});
  scene.add(make_box({2, 2, 2}));
  scene.add(make_box({1, 4, 1}));
  EXPECT_TRUE(scene.detect().manifolds.empty());
  DetectRequest request;
  request.manifolds = true;
  ASSERT_EQ(scene.detect(request).manifolds.size(), 2u);
  const std::uint64_t id = scene.result().manifolds[0].id;
  EXPECT_EQ(scene.detect(request).manifolds[0].id, id);
  EXPECT_EQ(scene.detect().ended_manifolds.size(), 2u) << "a step without manifolds ends all";
  EXPECT_EQ(scene.detect(request).manifolds[0].lasting, Lasting::begin);
  request.contacts = ContactKinds::intersection | ContactKinds::continuous;
  EXPECT_THROW(scene.detect(request), Error);
  request.contacts = ContactKinds::proximity;
  EXPECT_NO_THROW(scene.detect(request));
}

TEST(Manifold, EndsWithItsObject) {
  Scene scene(touching);
  scene.add(make_box({2, 2, 2}));
  const ObjectId bar = scene.add(make_box({1, 4, 1}));
  scene.detect();
  scene.remove(bar);
  const ObjectId other = scene.add(make_box({1, 4, 1}));
  EXPECT_EQ(other.index, bar.index);
  const DetectResult& result = scene.detect();
  ASSERT_EQ(result.ended_manifolds.size(), 2u);
  EXPECT_EQ(result.ended_manifolds[0].b, bar);
  ASSERT_EQ(result.manifolds.size(), 2u);
  EXPECT_EQ(result.manifolds[0].lasting, Lasting::begin);
}

/// Bodies and sheets that move, deform and go through each other.
TEST(Manifold, IsTheSameForAnyNumberOfThreadsAndSpansItsPatch) {
  for (const ContactKinds kinds : {ContactKinds::penetration, ContactKinds::proximity,
                                   ContactKinds::penetration | ContactKinds::proximity}) {
    std::vector<Manifold> manifolds;
    std::vector<ManifoldPoint> points;
    for (const std::uint32_t threads : {1u, 2u, 5u}) {
      Scene scene({.contacts = kinds, .manifolds = true, .threads = threads});
      const TriangleMesh ball = make_icosphere(3);
      std::vector<ObjectId> ids;
      for (int i = 0; i < 12; ++i)
        ids.push_back(scene.add(ball, {.self_collision = i % 3 == 0, .margin = 0.05, .solid = i % 2 == 0}));
      std::vector<Manifold> found;
      std::vector<ManifoldPoint> found_points;
      std::set<std::uint64_t> alive, alive_points;
      for (int step = 0; step < 12; ++step) {
        for (std::size_t i = 0; i < ids.size(); ++i) {
          std::vector<Vec3d> positions = ball.positions;
          const double turns = 0.02 * step + 0.13 * static_cast<double>(i);
          for (Vec3d& p : positions) {
            p = p + Vec3d{2 * cos_turns(turns), 1.5 * sin_turns(3 * turns), 2 * sin_turns(turns)} +
                0.1 * sin_turns(p.x + p.y) * p;
          }
          scene.set_positions(ids[i], positions);
        }
        const DetectResult& result = scene.detect();
        std::set<std::uint64_t> now, now_points;
        for (const Manifold& m : result.manifolds) {
          EXPECT_TRUE(now.insert(m.id).second) << "an id is taken twice";
          EXPECT_EQ(m.lasting == Lasting::stay, alive.contains(m.id));
          ASSERT_GE(m.point_count, 1u);
          ASSERT_LE(m.point_count, 4u);
          EXPECT_NEAR(norm(m.normal), 1, 1e-12);
          for (const ManifoldPoint& p : result.points_of(m)) {
            EXPECT_TRUE(now_points.insert(p.id).second);
            EXPECT_EQ(p.lasting == Lasting::stay, alive_points.contains(p.id));
            EXPECT_LE(p.depth, m.depth + 1e-12);
            EXPECT_TRUE(m.source == ManifoldSource::pairs || p.depth >= 0);
          }
          const bool of_curve = m.source == ManifoldSource::curve;
          ASSERT_LT(m.record, of_curve ? result.curves.size() : result.proximity_pairs.size());
          EXPECT_EQ(of_curve ? result.curves[m.record].normal : result.proximity_pairs[m.record].normal,
                    m.normal);
        }
        for (const EndedManifold& ended : result.ended_manifolds) {
          EXPECT_TRUE(alive.contains(ended.id));
          EXPECT_FALSE(now.contains(ended.id));
        }
        std::size_t stayed = 0;
        for (const std::uint64_t id : now) stayed += alive.contains(id) ? 1 : 0;
        EXPECT_EQ(stayed + result.ended_manifolds.size(), alive.size());
        alive = now;
        alive_points = now_points;
        found.insert(found.end(), result.manifolds.begin(), result.manifolds.end());
        found_points.insert(found_points.end(), result.manifold_points.begin(), result.manifold_points.end());
      }
      // Bodies that cut through each other have no manifolds of pairs.
      EXPECT_GT(found.size(), kinds == ContactKinds::proximity ? 8u : 100u);
      if (threads == 1) {
        manifolds = found;
        points = found_points;
      }
      EXPECT_TRUE(found == manifolds);
      EXPECT_TRUE(found_points == points);
    }
  }
}

TEST(Manifold, TakesCoordinatesOfAnySize) {
  for (const double size : {0x1p-1000, 0x1p-500, 0x1p500, 0x1p1000}) {
    Scene scene(touching);
    TriangleMesh box = make_box({2, 2, 2}), bar = make_box({1, 4, 1});
    for (TriangleMesh* mesh : {&box, &bar}) {
      for (Vec3d& p : mesh->positions) p *= size;
    }
    scene.add(box);
    scene.add(bar);
    const DetectResult& result = scene.detect();
    ASSERT_EQ(result.manifolds.size(), 2u);
    for (const Manifold& manifold : result.manifolds) {
      EXPECT_EQ(manifold.point_count, 4u) << size;
      for (const ManifoldPoint& point : result.points_of(manifold)) EXPECT_TRUE(std::isfinite(point.depth));
    }
  }
}

}  // namespace supple::manifold_test
