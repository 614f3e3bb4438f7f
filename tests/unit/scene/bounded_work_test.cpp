// The work of queries is bounded: for objects that are far from each other, and where many triangles are at
// the same distance. The tests count decisions; they do not measure time.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "core/parallel.hpp"
#include "manifold/curves/curve_finder.hpp"
#include "queries/object_queries.hpp"
#include "queries/pairs/nearest_pair.hpp"
#include "supple/models.hpp"
#include "supple/scene.hpp"
#include "supple/trigonometry.hpp"
#include "supple/verify.hpp"
#include "world/object/world_object.hpp"

namespace supple::bounded_work_test {

/// One object as searches see it.
class Searched {
 public:
  Searched(const TriangleMesh& mesh, std::uint32_t number)
      : id_{number, 0}, object_(mesh.positions, mesh.triangles, {}, {}, {}, Parallel(1)) {
    object_.move().set_positions(mesh.positions, Parallel(1));
    object_.update({.resting = true}, Parallel(1));
    // As a scene does for objects that are far from their origin or from each other.
    object_.update_fine_boxes();
  }
  QueriedObject view() const {
    return {id_,
            object_.resting_view(),
            &object_.placement().end(),
            object_.octree().triangles(),
            object_.octree().triangle_ids(),
            object_.box(),
            object_.has_inert_faces(),
            object_.fine_boxes()};
  }
  SurfaceView surface() {
    return {&object_.octree(), &object_.vertex_triangles(), &object_.placement().end()};
  }

 private:
  ObjectId id_;
  WorldObject object_;
};

TriangleMesh moved(TriangleMesh mesh, const Vec3d& offset) {
  for (Vec3d& p : mesh.positions) p += offset;
  return mesh;
}

TriangleMesh scaled(TriangleMesh mesh, double factor) {
  for (Vec3d& p : mesh.positions) p *= factor;
  return mesh;
}

struct Work {
  std::uint64_t triangles = 0, elements = 0;
  std::optional<ProximityPair> nearest;
};

Work work_of_distance(const TriangleMesh& a, const TriangleMesh& b) {
  const Searched of_a(a, 0), of_b(b, 1);
  NearestPairSearch search;
  Work work;
  work.nearest = search.nearest(of_a.view(), of_b.view(), any_distance, {}, {});
  work.triangles = search.decided_triangles();
  work.elements = search.decided_elements();
  return work;
}

const std::vector<double> ratios{2.0, 1e3, 1e6, 1e9, 1e12, 1e15, 1e30, 1e100};

/// From here on, the coordinates of a distant object have so few bits that it is flat, or a line, or a point.
/// Then many of its triangles have the same distance.
constexpr double collapsing_ratio = 1e15;

const std::vector<Vec3d>& directions() {
  static const std::vector<Vec3d> all{{1, 0, 0}, {0, 0, -1}, {1, 1, 0}, {0.3, -0.5, 0.7}};
  return all;
}

TEST(BoundedWork, OfADistanceIsThatOfNearObjects) {
  const TriangleMesh ball = make_icosphere(6);
  for (const Vec3d& direction : directions()) {
    for (const double ratio : ratios) {
      const Work work = work_of_distance(ball, moved(ball, ratio * direction + Vec3d{0.01, 0.02, 0.03}));
      ASSERT_TRUE(work.nearest);
      const std::size_t most = ratio < collapsing_ratio ? 300 : 100 * ball.triangles.size();
      EXPECT_LT(work.triangles, most) << ratio;
      EXPECT_LT(work.elements, most) << ratio;
    }
  }
}

/// Triangles with vertices of their own at the same three places.
TriangleMesh equal_triangles(std::uint32_t count, const std::array<Vec3d, 3>& corners) {
  TriangleMesh mesh;
  for (std::uint32_t t = 0; t < count; ++t) {
    mesh.positions.insert(mesh.positions.end(), corners.begin(), corners.end());
    mesh.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
  }
  return mesh;
}

/// One above the other, so that their corners are nearest.
TEST(BoundedWork, OfADistanceOfEqualTrianglesIsThatOfOne) {
  const std::array<Vec3d, 3> corners{Vec3d{0, 0, 0}, Vec3d{1, 0, 0}, Vec3d{0, 1, 0}};
  for (const bool are_points : {false, true}) {
    TriangleMesh below = equal_triangles(3000, are_points ? std::array<Vec3d, 3>{} : corners),
                 above = moved(below, {0, 0, 2});
    const Work work = work_of_distance(below, above);
    EXPECT_LT(work.triangles, 300u);
    EXPECT_LT(work.elements, 300u);
  }
}

/// A fan of needles whose ends are on a circle, as far as doubles can say, and equal needles at its centre:
/// each needle of the fan is decided once, not once for each of the others.
TEST(BoundedWork, OfADistanceOfAFanAndEqualNeedlesIsThatOfTheFan) {
  constexpr std::uint32_t count = 500;
  TriangleMesh fan;
  for (std::uint32_t i = 0; i < count; ++i) {
    const double turns = 1.0 * i / count, x = cos_turns(turns), y = sin_turns(turns);
    fan.positions.insert(fan.positions.end(), {{x, y, 0}, {2 * x, 2 * y, 1e-3}, {2 * x, 2 * y, -1e-3}});
    fan.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  const TriangleMesh needles =
      equal_triangles(count, {Vec3d{0, 0, 0}, Vec3d{1e-3, 0, -1}, Vec3d{-1e-3, 0, -1}});
  const Work work = work_of_distance(fan, needles);
  ASSERT_TRUE(work.nearest);
  EXPECT_NEAR(work.nearest->distance, 1, 1e-6);
  EXPECT_LT(work.elements, 60 * count);
}

/// All triangles of a sphere are about as far from a tiny one at its centre.
TEST(BoundedWork, OfADistanceOfATinySphereInASphereIsNotTheirProduct) {
  const TriangleMesh ball = make_icosphere(8), tiny = scaled(ball, 1e-9);
  const Work work = work_of_distance(ball, tiny);
  ASSERT_TRUE(work.nearest);
  EXPECT_LT(work.triangles, 20 * ball.triangles.size());
}

TEST(BoundedWork, OfADistanceDoesNotGrowWithTheCoordinates) {
  const TriangleMesh ball = make_icosphere(9);
  for (const double offset : {1e3, 1e6, 1e9, 1e12}) {
    const Vec3d far{offset, -0.5 * offset, 0.25 * offset};
    const Work work = work_of_distance(moved(ball, far), moved(ball, far + Vec3d{2.5, 0.1, 0.2}));
    EXPECT_LT(work.triangles, 300u) << offset;
    EXPECT_LT(work.elements, 300u) << offset;
  }
}

TEST(BoundedWork, OfADistanceDoesNotGrowWithTheSizes) {
  const TriangleMesh ball = make_icosphere(9);
  for (const double size : {1e-12, 1e-6, 1e6, 1e12}) {
    const Work work = work_of_distance(ball, moved(scaled(ball, size), {1.5 + 2 * size, 0.1, 0.2}));
    EXPECT_LT(work.triangles, 300u) << size;
    EXPECT_LT(work.elements, 300u) << size;
  }
}

TEST(BoundedWork, OfParallelFacesIsLinear) {
  const TriangleMesh plate = make_cloth(12, 12);
  const std::uint64_t triangles = plate.triangles.size();
  for (const double ratio : ratios) {
    for (const Vec3d& aside : {Vec3d{}, Vec3d{0.011, 0, 0.017}}) {
      Vec3d normal = cross(plate.positions[1] - plate.positions[0], plate.positions[14] - plate.positions[0]);
      normal = normal / norm(normal);
      const Work work = work_of_distance(plate, moved(plate, ratio * normal + aside));
      EXPECT_LT(work.triangles, 40 * triangles) << ratio;
      EXPECT_LT(work.elements, 40 * triangles) << ratio;
    }
  }
}

/// Triangles around the first vertex, or the last one, which is their lowest or highest point.
TriangleMesh make_fan(std::uint32_t count, const Vec3d& apex, double height, bool is_last) {
  TriangleMesh fan;
  const std::uint32_t top = is_last ? count : 0;
  if (!is_last) fan.positions.push_back(apex);
  for (std::uint32_t i = 0; i < count; ++i) {
    const double turns = static_cast<double>(i) / count;
    fan.positions.push_back(apex + Vec3d{cos_turns(turns), sin_turns(turns), height});
  }
  if (is_last) fan.positions.push_back(apex);
  const std::uint32_t first = is_last ? 0 : 1;
  for (std::uint32_t i = 0; i < count; ++i)
    fan.triangles.push_back({top, first + i, first + (i + 1) % count});
  return fan;
}

/// The same triangles, each with vertices of its own.
TriangleMesh separated(const TriangleMesh& mesh) {
  TriangleMesh soup;
  for (const Triangle& t : mesh.triangles) {
    const auto first = static_cast<std::uint32_t>(soup.positions.size());
    for (const std::uint32_t v : t) soup.positions.push_back(mesh.positions[v]);
    soup.triangles.push_back({first, first + 1, first + 2});
  }
  return soup;
}

TEST(BoundedWork, OfEqualDistancesIsLinear) {
  constexpr std::uint32_t count = 400;
  for (const bool is_last : {false, true}) {
    for (const bool is_soup : {false, true}) {
      TriangleMesh low = make_fan(count, {0, 0, 0}, -0.5, is_last),
                   high = make_fan(count, {0, 0, 1}, 0.5, !is_last);
      if (is_soup) low = separated(low), high = separated(high);
      const Work work = work_of_distance(low, high);
      ASSERT_TRUE(work.nearest);
      EXPECT_EQ(work.nearest->distance, 1);
      EXPECT_LT(work.triangles, 8 * count);
      EXPECT_LT(work.elements, 8 * count);
    }
  }
}

TEST(BoundedWork, OfASheetAboveAnotherOneIsFewDecisions) {
  const auto sheet = [](double size, double height) {
    TriangleMesh mesh = make_cloth(20, 20);
    for (Vec3d& p : mesh.positions) p = {size * p.x + height / 7, height, size * p.z + 0.01};
    return mesh;
  };
  for (const double gap : {1.0, 0x1p-10, 0x1p-40}) {
    const TriangleMesh below = sheet(1, 0);
    const Work work = work_of_distance(below, sheet(1 + 0x1p-5, gap));
    ASSERT_TRUE(work.nearest);
    EXPECT_EQ(work.nearest->distance, gap);
    EXPECT_LT(work.elements, 2 * below.triangles.size()) << gap;
  }
}

TEST(BoundedWork, OfEqualTrianglesIsLinear) {
  constexpr std::uint32_t count = 400;
  TriangleMesh a{"", {{0, 0, 0}, {1, 0, 0.1}, {0, 1, 0.2}}, {}},
      b{"", {{1, 1, 1}, {0.7, 0.9, 2}, {0, 0, 1.4}}, {}};
  for (std::uint32_t i = 0; i < count; ++i) {
    a.triangles.push_back({i % 3, (i + 1) % 3, (i + 2) % 3});
    b.triangles.push_back({0, 1, 2});
  }
  const Work work = work_of_distance(a, b);
  EXPECT_LT(work.triangles, 8 * count);
  EXPECT_LT(work.elements, 8 * count);
}

TEST(BoundedWork, OfOneContactOfManyIsLinear) {
  constexpr std::uint32_t count = 400;
  const Work work =
      work_of_distance(make_fan(count, {0, 0, 0}, -0.5, false), make_fan(count, {0, 0, 0}, 0.5, true));
  ASSERT_TRUE(work.nearest);
  EXPECT_EQ(work.nearest->distance, 0);
  EXPECT_LT(work.triangles, 8 * count);
}

TEST(BoundedWork, OfAClosestPointIsThatOfANearOne) {
  const TriangleMesh ball = make_icosphere(9);
  for (const Vec3d& direction : directions()) {
    for (const double ratio : ratios) {
      const Vec3d aside{0.01, 0.02, 0.03};
      for (const bool moves_ball : {false, true}) {
        const Searched searched(moves_ball ? moved(ball, ratio * direction) : ball, 0);
        const QueriedObject object = searched.view();
        const Vec3d point = moves_ball ? aside : ratio * direction + aside;
        ObjectQueries queries;
        queries.start();
        ASSERT_TRUE(queries.nearest({&object, 1}, point, any_distance));
        const bool is_flat = moves_ball && ratio >= collapsing_ratio;
        EXPECT_LT(queries.decided(), is_flat ? 2 * ball.triangles.size() : 100u)
            << ratio << " " << moves_ball;
      }
    }
  }
}

TEST(BoundedWork, OfClosestPointsThatFollowEachOther) {
  const TriangleMesh ball = make_icosphere(30);
  const Searched searched(ball, 0);
  const QueriedObject object = searched.view();
  constexpr std::uint32_t count = 100;
  for (const double ratio : ratios) {
    ObjectQueries queries;
    queries.start();
    for (std::uint32_t i = 0; i < count; ++i) {
      const double turns = 1e-3 * i;
      ASSERT_TRUE(queries.nearest({&object, 1}, ratio * Vec3d{cos_turns(turns), sin_turns(turns), 0.3},
                                  any_distance));
    }
    EXPECT_LT(queries.bounded(), count * ball.triangles.size() / 20) << ratio;
  }
}

TEST(BoundedWork, OfARayIsThatOfANearOne) {
  const TriangleMesh ball = make_icosphere(9);
  for (const Vec3d& direction : directions()) {
    for (const double ratio : ratios) {
      for (const double offset : {0.0, 1e9}) {
        const Vec3d center{offset, offset, offset};
        const Searched searched(moved(ball, center), 0);
        const QueriedObject object = searched.view();
        ObjectQueries queries;
        queries.start();
        queries.cast({&object, 1}, {center + ratio * direction, -direction}, true);
        EXPECT_LT(queries.decided(), 100u) << ratio << " " << offset;
      }
    }
  }
}

/// The work for the only curve of two meshes.
std::size_t work_of_curve(const TriangleMesh& mesh_a, const TriangleMesh& mesh_b, double depth) {
  Scene scene({.contacts = ContactKinds::intersection});
  scene.add(mesh_a, {.solid = true});
  scene.add(mesh_b, {.solid = true});
  const DetectResult& result = scene.detect();
  Searched a(mesh_a, 0), b(mesh_b, 1);
  const PenetratedObject of_a{a.view(), a.surface(), true}, of_b{b.view(), b.surface(), true};
  CurveFinder finder;
  CurveLists lists;
  finder.find({&of_a, &of_b, &result.groups[0], &result}, lists);
  EXPECT_EQ(lists.curves.size(), 1u);
  EXPECT_NEAR(lists.curves[0].depth, depth, 0.01);
  return finder.visited();
}

TEST(BoundedWork, OfACurveIsThatOfItsContacts) {
  // A ball that is pressed into a block of `cells` cells of length 1.
  const auto work_of = [](std::uint32_t cells) {
    const double length = cells;
    return work_of_curve(moved(scaled(make_icosphere(8), 2.5), {0, 1.75, 0}),
                         moved(make_box({length, length, length}, cells), {0.25, -length / 2, 0.125}), 0.75);
  };
  EXPECT_LT(work_of(16), 2000u);
  EXPECT_EQ(work_of(80), work_of(16));
}

/// Each triangle is beside all others, at a vertex of many triangles.
TEST(BoundedWork, OfTheCurveOfTwoTipsIsLinear) {
  const auto cone = [](std::uint32_t count, double tip, double base) {
    TriangleMesh mesh{"cone", {{0, tip, 0}, {0, base, 0}}, {}};
    for (std::uint32_t i = 0; i < count; ++i) {
      const double turns = static_cast<double>(i) / count;
      mesh.positions.push_back({cos_turns(turns), base, sin_turns(turns)});
      const std::uint32_t p = 2 + i, q = 2 + (i + 1) % count;
      mesh.triangles.push_back(base > tip ? Triangle{0, p, q} : Triangle{0, q, p});
      mesh.triangles.push_back(base > tip ? Triangle{1, q, p} : Triangle{1, p, q});
    }
    return mesh;
  };
  const auto work_of = [&](std::uint32_t count) {
    return work_of_curve(cone(count, -0.1, 0.9), cone(count, 0, -1), 0.1);
  };
  EXPECT_LT(work_of(800), 5 * work_of(200));
}

/// Small objects, so that exact brute force decides in time.
TEST(FarObjects, HaveExactAnswers) {
  const TriangleMesh ball{"",
                          {{1, 0, 0}, {-0.5, 0.8, 0.1}, {-0.5, -0.9, 0}, {0, 0.1, 1.5}},
                          {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};
  const TriangleMesh box = make_box({1, 2, 3});
  for (const Vec3d& direction : directions()) {
    for (const double ratio : {2.0, 1e6, 1e12, 1e30}) {
      for (const Vec3d& common : {Vec3d{}, Vec3d{1e9, -1e9, 1e12}}) {
        Scene scene;
        const ObjectId a = scene.add(moved(ball, common)),
                       b = scene.add(moved(box, common + ratio * direction + Vec3d{0.125, 0, 0.25}));
        for (const auto& wrong : verify_distance(scene, a, b, scene.distance(a, b)))
          ADD_FAILURE() << ratio << ": found " << wrong.found << ", expected " << wrong.expected;
        const std::vector<Vec3d> points{common, common + ratio * direction, common - 0.5 * ratio * direction};
        std::vector<std::optional<ClosestPoint>> nearest(points.size());
        scene.closest(points, nearest);
        for (const auto& wrong : verify_closest(scene, points, nearest))
          ADD_FAILURE() << ratio << ": found " << wrong.found << ", expected " << wrong.expected;
        const std::vector<Ray> rays{{common + ratio * direction, -direction},
                                    {common, ratio * direction},
                                    {common - ratio * direction, direction}};
        std::vector<std::optional<RayHit>> hits(rays.size());
        scene.cast(rays, hits);
        for (const auto& wrong : verify_cast(scene, rays, hits))
          ADD_FAILURE() << ratio << ": found " << wrong.found << ", expected " << wrong.expected;
      }
    }
  }
}

TEST(FarObjects, PlacedByATransformHaveExactAnswers) {
  for (const double ratio : {1e6, 1e12, 1e30}) {
    Scene scene;
    const ObjectId a = scene.add(make_box({1, 1, 1})), b = scene.add(make_box({1, 2, 1}));
    scene.translate(b, {ratio, 0.5 * ratio, 0.25});
    for (const auto& wrong : verify_distance(scene, a, b, scene.distance(a, b)))
      ADD_FAILURE() << ratio << ": found " << wrong.found << ", expected " << wrong.expected;
  }
}

TEST(FarObjects, HaveAnInfiniteDistanceWhereNoDoubleHoldsIt) {
  constexpr double largest = std::numeric_limits<double>::max();
  Scene scene;
  const ObjectId a = scene.add({"a", {{-largest, 0, 0}, {-largest, 1, 0}, {-largest, 0, 1}}, {{0, 1, 2}}}),
                 b = scene.add({"b", {{largest, 0, 0}, {largest, 2, 0}, {largest, 0, 1}}, {{0, 1, 2}}});
  const auto found = scene.distance(a, b);
  ASSERT_TRUE(found);
  EXPECT_TRUE(std::isinf(found->distance));
  for (const auto& wrong : verify_distance(scene, a, b, found))
    ADD_FAILURE() << "found " << wrong.found << ", expected " << wrong.expected;
  EXPECT_EQ(verify_distance(scene, a, b, {}).size(), 1u);
  EXPECT_TRUE(verify_distances(scene, any_distance, scene.distances(any_distance)).empty());
  EXPECT_EQ(scene.distances(any_distance).size(), 1u);
  EXPECT_TRUE(scene.distances(largest).empty());
  EXPECT_TRUE(verify_distances(scene, largest, {}).empty());
}

}  // namespace supple::bounded_work_test
