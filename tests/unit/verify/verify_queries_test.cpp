// Brute force checks the answers to queries: right ones agree with it, and it notices every wrong one.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <optional>
#include <vector>

#include "supple/description.hpp"
#include "supple/error.hpp"
#include "supple/mesh_file.hpp"
#include "supple/models.hpp"
#include "supple/scene.hpp"
#include "supple/verify.hpp"
#include "support/hard_scenes.hpp"
#include "support/random.hpp"
#include "support/shared_meshes.hpp"

namespace supple::verify_queries_test {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinite = std::numeric_limits<double>::infinity();

/// The first wrong answer, for messages; empty if there is none.
std::string first_of(const std::vector<WrongAnswer>& wrong) {
  if (wrong.empty()) return {};
  return std::to_string(wrong.size()) + " wrong, the first " + std::to_string(wrong[0].query) + ": found " +
         wrong[0].found + ", expected " + wrong[0].expected;
}

/// Queries at places where many answers tie: at vertices, on edges, along edges and in planes.
struct HardQueries {
  std::vector<Vec3d> points;
  std::vector<Ray> rays;
  std::vector<QueryBox> boxes;
  std::vector<QuerySphere> spheres;

  HardQueries(const std::vector<Vec3d>& vertices, std::size_t count, std::uint64_t seed) {
    RandomNumbers random(seed);
    const auto vertex = [&] { return vertices[random.below(static_cast<std::uint32_t>(vertices.size()))]; };
    for (std::size_t i = 0; i < count; ++i) {
      const Vec3d p = vertex(), q = vertex(), r = vertex();
      points.push_back(random.below(2) == 0 ? 0.5 * p + 0.5 * q : p);
      Vec3d direction = q - p;
      if (random.below(3) == 0) direction = {0, random.below(2) == 0 ? 1.0 : -1.0, 0};
      rays.push_back({random.below(2) == 0 ? p : r - direction, direction});
      boxes.push_back({{std::min(p.x, q.x), std::min(p.y, q.y), std::min(p.z, q.z)},
                       {std::max(p.x, q.x), std::max(p.y, q.y), std::max(p.z, q.z)}});
      spheres.push_back({p, i % 3 == 0 ? 0 : std::fabs(p.x - q.x)});
    }
    points.push_back({nan, 0, 0});
    rays.push_back({{0, infinite, 0}, {1, 0, 0}});
    rays.push_back({points[0], {0, 0, 0}});
    boxes.push_back({{1, 0, 0}, {0, 1, 1}});
    spheres.push_back({points[0], -1});
  }
};

/// Asks and checks everything that needs no closed surface.
void expect_all_right(Scene& scene, const HardQueries& queries) {
  for (const double max_distance : {infinite, 0.25, 0.0}) {
    const ClosestOptions options{.max_distance = max_distance};
    std::vector<std::optional<ClosestPoint>> closest(queries.points.size());
    scene.closest(queries.points, closest, options);
    EXPECT_EQ(first_of(verify_closest(scene, queries.points, closest, options)), "");
  }
  EXPECT_EQ(first_of(verify_distances(scene, 0.25, scene.distances(0.25))), "");
  for (const bool counts : {false, true}) {
    std::vector<std::optional<RayHit>> hits(queries.rays.size());
    scene.cast(queries.rays, hits, {.count_hits = counts});
    EXPECT_EQ(first_of(verify_cast(scene, queries.rays, hits, {.count_hits = counts})), "");
  }
  EXPECT_EQ(first_of(verify_cast_all(scene, queries.rays, scene.cast_all(queries.rays))), "");
  EXPECT_EQ(first_of(verify_overlaps(scene, queries.boxes, scene.overlaps(queries.boxes))), "");
  EXPECT_EQ(first_of(verify_overlaps(scene, queries.spheres, scene.overlaps(queries.spheres))), "");
  const std::vector<ObjectId> objects = scene.objects();
  const ObjectId a = objects[0], b = objects[1];
  EXPECT_EQ(first_of(verify_distance(scene, b, a, scene.distance(a, b))), "");
  EXPECT_EQ(first_of(verify_any_contact(scene, a, b, scene.any_contact(a, b))), "");
}

bool is_finite_point(const Vec3d& p) {
  return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}

class VerifiedQueries : public testing::TestWithParam<Family> {};

TEST_P(VerifiedQueries, AreRightWhereverTheirObjectsAre) {
#ifdef NDEBUG
  constexpr std::size_t most = 10, count = 12;
#else
  constexpr std::size_t most = 5, count = 4;  // rationals are slow in builds with sanitizers
#endif
  for (const bool is_translated : {false, true}) {
    std::vector<TriangleMesh> meshes = GetParam().make(4);
    Scene scene({.threads = 2});
    std::vector<Vec3d> vertices;
    for (TriangleMesh& mesh : meshes) {
      mesh.triangles.resize(std::min(mesh.triangles.size(), most));
      const ObjectId id = scene.add(mesh, {.octree = {.leaf_size = 3}});
      const double size = std::fabs(mesh.positions.front().x);
      if (is_translated && std::isfinite(size))
        scene.translate(id, {size * id.index, -0.7 * size, 0.3 * size * id.index});
      for (const Triangle& t : mesh.triangles) {
        for (const std::uint32_t v : t) {
          if (is_finite_point(scene.position(id, v))) vertices.push_back(scene.position(id, v));
        }
      }
    }
    expect_all_right(scene, HardQueries(vertices, count, 9));
  }
}

INSTANTIATE_TEST_SUITE_P(Families, VerifiedQueries, testing::ValuesIn(hard_families()),
                         [](const auto& family) { return family.param.name; });

/// Closed surfaces that touch, contain one another and lie on a lattice, also beyond the squares of doubles.
TEST(VerifyQueries, AgreesInsideClosedSurfaces) {
  for (const double scale : {1.0, 0x1p-300, 0x1p300}) {
    SCOPED_TRACE(scale);
    Scene scene;
    std::vector<Vec3d> points;
    for (const double size : {1.0, 2.0, 4.0}) {
      TriangleMesh box = make_box({size, size, size});
      for (Vec3d& p : box.positions) p = scale * (p + Vec3d{size / 2 - 1, 0, 0});
      points.insert(points.end(), box.positions.begin(), box.positions.end());
      scene.add(box);
    }
    RandomNumbers random(2);
    for (int i = 0; i < 60; ++i) {
      points.push_back(scale * Vec3d{0.5 * random.between(-3, 7), 0.5 * random.between(-5, 5),
                                     0.5 * random.between(-5, 5)});
    }
    points.push_back({0, nan, 0});
    std::vector<Containment> places(points.size());
    scene.inside(points, places);
    EXPECT_EQ(first_of(verify_inside(scene, points, places)), "");
    EXPECT_GT(std::ranges::count(places, Containment::inside), 5);
    EXPECT_GT(std::ranges::count(places, Containment::on), 5);
    std::vector<std::optional<ClosestPoint>> closest(points.size());
    scene.closest(points, closest, {.signed_distance = true});
    EXPECT_EQ(first_of(verify_closest(scene, points, closest, {.signed_distance = true})), "");
    EXPECT_NE(first_of(verify_closest(scene, points, closest)), "") << "signs of distances count";
  }
}

TEST(VerifyQueries, AgreesWithoutObjects) {
  Scene scene;
  scene.add(TriangleMesh{});
  scene.add(TriangleMesh{"", {{nan, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}});
  expect_all_right(scene, HardQueries({{0, 0, 0}, {1, 2, 3}}, 4, 1));
  const std::vector<Vec3d> none;
  EXPECT_TRUE(verify_closest(scene, none, {}).empty());
}

/// Two boxes side by side, and a ball beside them.
struct ThreeObjects {
  Scene scene;
  ObjectId box = scene.add(make_box({2, 2, 2})), other = scene.add(make_box({2, 2, 2})),
           ball = scene.add(make_icosphere(2));
  ThreeObjects() {
    scene.translate(other, {3, 0.25, 0.5});
    scene.translate(ball, {0, 0, 3});
  }
};

/// Expects that `change` makes the answer wrong in the sense of `verify`, and that only this one is.
template <class Answers, class Verify, class Change>
void expect_noticed(const Answers& right, std::size_t place, const Verify& verify, const Change& change,
                    const char* what) {
  Answers wrong = right;
  change(wrong[place]);
  const std::vector<WrongAnswer> found = verify(wrong);
  ASSERT_EQ(found.size(), 1u) << what;
  EXPECT_EQ(found[0].query, place) << what;
  EXPECT_NE(found[0].found, found[0].expected) << what;
}

double five_units_more(double x) {
  for (int i = 0; i < 5; ++i) x = std::nextafter(x, infinite);
  return x;
}

TEST(VerifyQueries, NoticesWrongClosestPoints) {
  ThreeObjects objects;
  const std::vector<Vec3d> points{{0.3, 0.1, 1.4}, {1, 1, 1.5}, {9, 9, 9}};
  const ClosestOptions options{.max_distance = 5};
  std::vector<std::optional<ClosestPoint>> right(points.size());
  objects.scene.closest(points, right, options);
  const auto verify = [&](const auto& answers) {
    return verify_closest(objects.scene, points, answers, options);
  };
  EXPECT_EQ(first_of(verify(right)), "");
  ASSERT_TRUE(right[1]);
  ASSERT_FALSE(right[2]);
  using Answer = std::optional<ClosestPoint>;
  const auto noticed = [&](const char* what, const auto& change) {
    expect_noticed(
        right, 1, verify, [&](Answer& answer) { change(*answer); }, what);
  };
  noticed("object", [&](ClosestPoint& p) { p.object = objects.other; });
  noticed("object that does not exist", [&](ClosestPoint& p) { p.object.index = 99; });
  noticed("triangle", [](ClosestPoint& p) { ++p.triangle; });
  noticed("feature", [](ClosestPoint& p) { p.feature = {FeatureKind::face, 0}; });
  noticed("index of the feature", [](ClosestPoint& p) { p.feature.index ^= 1; });
  noticed("distance", [](ClosestPoint& p) { p.distance = five_units_more(p.distance); });
  noticed("sign", [](ClosestPoint& p) { p.distance = -p.distance; });
  noticed("NaN", [](ClosestPoint& p) { p.distance = nan; });
  noticed("infinity", [](ClosestPoint& p) { p.distance = infinite; });
  noticed("barycentric", [](ClosestPoint& p) { p.barycentric[0] += 0x1p-49; });
  noticed("NaN in barycentric", [](ClosestPoint& p) { p.barycentric[2] = nan; });
  expect_noticed(
      right, 0, verify, [](Answer& answer) { answer.reset(); }, "nothing");
  expect_noticed(
      right, 2, verify, [&](Answer& answer) { answer = right[0]; }, "beyond the largest distance");
}

/// A vertex of eight coplanar triangles, and the same object twice: everything ties.
TEST(VerifyQueries, NoticesTheSecondOfTiedTriangles) {
  Scene scene;
  const TriangleMesh cloth = make_cloth(2, 2);
  const ObjectId first = scene.add(cloth), second = scene.add(cloth);
  const std::vector<Vec3d> points{cloth.positions[4] + Vec3d{0, 1, 0}};
  std::vector<std::optional<ClosestPoint>> answers(1);
  scene.closest(points, answers);
  ASSERT_EQ(answers[0]->object, first);
  EXPECT_TRUE(verify_closest(scene, points, answers).empty());
  answers[0]->object = second;
  EXPECT_EQ(verify_closest(scene, points, answers).size(), 1u);
  const std::vector<Ray> rays{{points[0], {0, -1, 0}}};
  std::vector<std::optional<RayHit>> hits(1);
  scene.cast(rays, hits);
  EXPECT_TRUE(verify_cast(scene, rays, hits).empty());
  hits[0]->object = second;
  EXPECT_EQ(verify_cast(scene, rays, hits).size(), 1u);
}

TEST(VerifyQueries, NoticesWrongHits) {
  ThreeObjects objects;
  const std::vector<Ray> rays{
      {{0.3, 0.1, -3}, {0, 0, 0.5}}, {{0.3, 0.1, -3}, {0, 0.03, 0.5}}, {{9, 9, 9}, {1, 0, 0}}};
  for (const bool counts : {false, true}) {
    std::vector<std::optional<RayHit>> right(rays.size());
    const CastOptions options{.count_hits = counts};
    objects.scene.cast(rays, right, options);
    const auto verify = [&](const auto& answers) {
      return verify_cast(objects.scene, rays, answers, options);
    };
    EXPECT_EQ(first_of(verify(right)), "");
    ASSERT_TRUE(right[0] && right[1]);
    ASSERT_FALSE(right[2]);
    using Answer = std::optional<RayHit>;
    const auto noticed = [&](const char* what, const auto& change) {
      expect_noticed(
          right, 1, verify, [&](Answer& answer) { change(*answer); }, what);
    };
    noticed("object", [&](RayHit& hit) { hit.object = objects.other; });
    noticed("triangle", [](RayHit& hit) { ++hit.triangle; });
    noticed("t", [](RayHit& hit) { hit.t = five_units_more(hit.t); });
    noticed("NaN", [](RayHit& hit) { hit.t = nan; });
    noticed("infinity", [](RayHit& hit) { hit.t = infinite; });
    expect_noticed(
        right, 1, verify, [](Answer& answer) { answer.reset(); }, "nothing");
    expect_noticed(
        right, 2, verify, [&](Answer& answer) { answer = right[0]; }, "a hit of another ray");
    // Without counts, the number is 1.
    EXPECT_EQ(verify([&] {
                auto wrong = right;
                ++wrong[0]->hits;
                return wrong;
              }())
                  .size(),
              1u);
  }
  const auto listed = objects.scene.cast_all(rays);
  const std::vector<ListedRayHit> all(listed.begin(), listed.end());
  ASSERT_GT(all.size(), 3u);
  const auto verify_all = [&](const std::vector<ListedRayHit>& answers) {
    return verify_cast_all(objects.scene, rays, answers);
  };
  EXPECT_EQ(first_of(verify_all(all)), "");
  for (std::size_t place = 0; place < all.size(); ++place) {
    std::vector<ListedRayHit> wrong = all;
    wrong.erase(wrong.begin() + static_cast<std::ptrdiff_t>(place));
    ASSERT_EQ(verify_all(wrong).size(), 1u) << "one is missing";
    EXPECT_EQ(verify_all(wrong)[0].query, all[place].query);
    wrong = all;
    wrong[place].hit.t = five_units_more(wrong[place].hit.t);
    EXPECT_EQ(verify_all(wrong).size(), 1u) << "t";
    wrong = all;
    ++wrong[place].hit.hits;
    EXPECT_EQ(verify_all(wrong).size(), 1u) << "count";
    wrong = all;
    wrong.insert(wrong.begin() + static_cast<std::ptrdiff_t>(place), all[place]);
    EXPECT_EQ(verify_all(wrong).size(), 1u) << "one is listed twice";
  }
  std::vector<ListedRayHit> swapped = all;
  std::swap(swapped[0], swapped[1]);
  EXPECT_EQ(verify_all(swapped).size(), 1u) << "another order";
  swapped[0].query = 3;
  EXPECT_THROW(verify_all(swapped), Error);
}

TEST(VerifyQueries, NoticesWrongPlaces) {
  ThreeObjects objects;
  const std::vector<Vec3d> points{{0, 0, 0}, {1, 0, 0}, {1.5, 0, 0}};
  const std::vector<Containment> right{Containment::inside, Containment::on, Containment::outside};
  const auto verify = [&](const auto& answers) { return verify_inside(objects.scene, points, answers); };
  EXPECT_EQ(first_of(verify(right)), "");
  for (std::size_t place = 0; place < 3; ++place) {
    for (const Containment other : right) {
      if (other != right[place])
        expect_noticed(
            right, place, verify, [&](Containment& answer) { answer = other; }, word_of(other));
    }
  }
}

TEST(VerifyQueries, NoticesWrongOverlaps) {
  ThreeObjects objects;
  const std::vector<QueryBox> boxes{
      {{0.5, 0.5, 0.5}, {1, 2, 2}}, {{-9, -9, -9}, {9, 9, 9}}, {{7, 7, 7}, {8, 8, 8}}};
  const std::vector<QuerySphere> spheres{{{0, 0, 1.5}, 0.5}, {{0, 0, 0}, 20}, {{7, 7, 7}, 1}};
  const auto expect_all_noticed = [&](const auto& regions) {
    const auto list = objects.scene.overlaps(regions);
    const std::vector<Overlap> all(list.begin(), list.end());
    ASSERT_GT(all.size(), 2u);
    EXPECT_EQ(first_of(verify_overlaps(objects.scene, regions, all)), "");
    for (std::size_t place = 0; place < all.size(); ++place) {
      std::vector<Overlap> wrong = all;
      wrong.erase(wrong.begin() + static_cast<std::ptrdiff_t>(place));
      ASSERT_EQ(verify_overlaps(objects.scene, regions, wrong).size(), 1u);
      EXPECT_EQ(verify_overlaps(objects.scene, regions, wrong)[0].query, all[place].query);
      wrong = all;
      wrong[place].triangle += 1000;
      EXPECT_EQ(verify_overlaps(objects.scene, regions, wrong).size(), 1u);
    }
    std::vector<Overlap> wrong = all;
    wrong.push_back({2, objects.box, 0});
    ASSERT_EQ(verify_overlaps(objects.scene, regions, wrong).size(), 1u);
    EXPECT_EQ(verify_overlaps(objects.scene, regions, wrong)[0].query, 2u);
  };
  expect_all_noticed(boxes);
  expect_all_noticed(spheres);
}

TEST(VerifyQueries, NoticesWrongDistances) {
  ThreeObjects objects;
  const auto list = objects.scene.distances(2);
  const std::vector<ProximityPair> right(list.begin(), list.end());
  ASSERT_EQ(right.size(), 3u);
  const auto verify = [&](const auto& answers) { return verify_distances(objects.scene, 2, answers); };
  EXPECT_EQ(first_of(verify(right)), "");
  const auto noticed = [&](const char* what, const auto& change) {
    expect_noticed(right, 1, verify, change, what);
  };
  noticed("distance", [](ProximityPair& pair) { pair.distance = five_units_more(pair.distance); });
  noticed("much too near", [](ProximityPair& pair) { pair.distance /= 2; });
  noticed("too far", [](ProximityPair& pair) { pair.distance *= 2; });
  noticed("NaN", [](ProximityPair& pair) { pair.distance = nan; });
  noticed("infinity", [](ProximityPair& pair) { pair.distance = infinite; });
  noticed("kind", [](ProximityPair& pair) { std::swap(pair.kind_a, pair.kind_b); });
  noticed("element of a", [](ProximityPair& pair) { ++pair.element_a[1]; });
  noticed("element of b", [](ProximityPair& pair) { ++pair.element_b[0]; });
  noticed("part of a", [](ProximityPair& pair) { ++pair.on_a.index; });
  noticed("part of b", [](ProximityPair& pair) { ++pair.on_b.index; });
  for (std::size_t place = 0; place < right.size(); ++place) {
    std::vector<ProximityPair> wrong = right;
    wrong.erase(wrong.begin() + static_cast<std::ptrdiff_t>(place));
    ASSERT_EQ(verify(wrong).size(), 1u);
    EXPECT_EQ(verify(wrong)[0].query, place);
    wrong = right;
    wrong.push_back(right[place]);
    EXPECT_EQ(verify(wrong).size(), 1u) << "twice";
  }
  EXPECT_EQ(verify_distances(objects.scene, 0.5, right).size(), 3u) << "beyond the largest distance";
  EXPECT_EQ(verify_distance(objects.scene, objects.box, objects.ball, right[0]).size(), 1u)
      << "other objects";
  EXPECT_EQ(verify_distance(objects.scene, objects.box, objects.ball, {}).size(), 1u);
}

TEST(VerifyQueries, NoticesWrongDistancesOfObjectsThatIntersect) {
  ThreeObjects objects;
  objects.scene.translate(objects.other, {-1.5, 0, 0});
  const auto right = objects.scene.distance(objects.box, objects.other);
  ASSERT_TRUE(right);
  const auto count_of = [&](const std::optional<ProximityPair>& answer) {
    return verify_distance(objects.scene, objects.box, objects.other, answer).size();
  };
  EXPECT_EQ(first_of(verify_distance(objects.scene, objects.box, objects.other, right)), "");
  EXPECT_EQ(count_of({}), 1u);
  ProximityPair wrong = *right;
  wrong.distance = std::numeric_limits<double>::denorm_min();
  EXPECT_EQ(count_of(wrong), 1u);
  wrong = *right;
  wrong.kind_a = FeatureKind::vertex;
  wrong.on_a.kind = FeatureKind::vertex;
  wrong.element_a = {0, 0};  // touches nothing
  EXPECT_EQ(count_of(wrong), 1u);
  wrong = *right;
  wrong.kind_b = FeatureKind::face;
  wrong.element_b = {999, 999};
  EXPECT_EQ(count_of(wrong), 1u);
  EXPECT_TRUE(verify_any_contact(objects.scene, objects.box, objects.other, true).empty());
  EXPECT_EQ(verify_any_contact(objects.scene, objects.box, objects.other, false).size(), 1u);
  EXPECT_EQ(verify_any_contact(objects.scene, objects.box, objects.ball, true).size(), 1u);
}

/// Also where the squares of distances are no doubles.
TEST(VerifyQueries, DoesNotReadTheGroupsOfVertices) {
  Scene scene;
  const TriangleMesh box = make_box({1, 1, 1});
  const ObjectId a = scene.add(box), b = scene.add(box);
  scene.translate(b, {0.5, 0.5, 0.5});
  const std::vector<std::uint32_t> group(box.positions.size(), 1), mask(box.positions.size(), 2);
  scene.set_vertex_groups(a, group, mask);
  scene.set_vertex_groups(b, group, mask);
  ASSERT_EQ(scene.detect().contacts.size(), 0u);
  const auto pair = scene.distance(a, b);
  ASSERT_TRUE(pair);
  EXPECT_EQ(pair->distance, 0);
  EXPECT_EQ(first_of(verify_distance(scene, a, b, pair)), "");
  ASSERT_TRUE(scene.any_contact(a, b));
  EXPECT_EQ(first_of(verify_any_contact(scene, a, b, true)), "");
}

TEST(VerifyQueries, SaysWhatBruteForceFinds) {
  for (const double scale : {1.0, 0x1p300, 0x1p-300, 0x1p-1030}) {
    Scene scene;
    TriangleMesh mesh{"plate", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
    for (Vec3d& p : mesh.positions) p = scale * p;
    scene.add(mesh);
    const std::vector<Vec3d> points{scale * Vec3d{0.25, 0.25, 0.75}};
    const std::vector<std::optional<ClosestPoint>> answers(1);
    const std::vector<WrongAnswer> expected{{0, "nothing",
                                             "triangle 0 of object 0 (plate) at face 0, distance " +
                                                 text_of(0.75 * scale) + ", barycentric 0.5 0.25 0.25"}};
    EXPECT_EQ(verify_closest(scene, points, answers), expected);
    scene.add(std::vector<Vec3d>{points[0], points[0], points[0]}, std::vector<Triangle>{{0, 1, 2}});
    const std::vector<WrongAnswer> of_pair{{0, "object 0 (plate) and object 1 (object 1): nothing",
                                            "face 0 and vertex 0, distance " + text_of(0.75 * scale)}};
    EXPECT_EQ(verify_distances(scene, infinite, {}), of_pair);
  }
}

TEST(VerifyQueries, SeesTheObjectsOfTheFilter) {
  ThreeObjects objects;
  const std::vector<Vec3d> points{{0, 0, 0}};
  const ClosestOptions options{.filter = {.object = objects.other}};
  std::vector<std::optional<ClosestPoint>> answers(1);
  objects.scene.closest(points, answers, options);
  EXPECT_TRUE(verify_closest(objects.scene, points, answers, options).empty());
  EXPECT_EQ(verify_closest(objects.scene, points, answers).size(), 1u);
  objects.scene.remove(objects.other);
  EXPECT_THROW(verify_closest(objects.scene, points, answers, options), Error);
  EXPECT_EQ(verify_closest(objects.scene, points, answers).size(), 1u) << "of an object that was removed";
}

TEST(VerifyQueries, RefusesWhatQueriesRefuse) {
  ThreeObjects objects;
  const std::vector<Vec3d> points{{0, 0, 0}};
  EXPECT_THROW(verify_closest(objects.scene, points, {}), Error);
  EXPECT_THROW(verify_inside(objects.scene, points, {}), Error);
  const std::vector<Ray> rays(1);
  EXPECT_THROW(verify_cast(objects.scene, rays, {}), Error);
  const std::vector<std::optional<ClosestPoint>> none(1);
  EXPECT_THROW(verify_closest(objects.scene, points, none, {.max_distance = -1}), Error);
  EXPECT_THROW(verify_distances(objects.scene, nan, {}), Error);
  EXPECT_THROW(verify_distance(objects.scene, objects.box, objects.box, {}), Error);
  EXPECT_THROW(verify_any_contact(objects.scene, objects.box, objects.box, false), Error);
  objects.scene.add(make_cloth(2, 2));
  EXPECT_THROW(verify_inside(objects.scene, points, std::vector{Containment::inside}), Error);
  EXPECT_THROW(verify_closest(objects.scene, points, none, {.signed_distance = true}), Error);
}

/// A scan of 70,000 triangles, and another one beside it.
TEST(VerifyQueries, AgreesOnARealMesh) {
  const auto path = shared_meshes() / "models/stanford-bunny.obj";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "no " << path << "; set SUPPLE_DATA";
#ifdef NDEBUG
  constexpr std::size_t count = 200;
#else
  constexpr std::size_t count = 5;
#endif
  const TriangleMesh mesh = load_mesh(path);
  Scene scene;
  const ObjectId a = scene.add(mesh), b = scene.add(mesh);
  Vec3d low = mesh.positions[0], high = low;
  for (const Vec3d& p : mesh.positions) {
    for (int axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], p[axis]);
      high[axis] = std::max(high[axis], p[axis]);
    }
  }
  const Vec3d size = high - low;
  scene.translate(b, {1.1 * size.x, 0, 0});
  RandomNumbers random(3);
  std::vector<Vec3d> points;
  std::vector<Ray> rays;
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3d share = random.vector(0.6);
    const Vec3d p = 0.5 * (low + high) + Vec3d{share.x * size.x, share.y * size.y, share.z * size.z};
    points.push_back(
        i % 2 == 0 ? p : mesh.positions[random.below(static_cast<std::uint32_t>(mesh.positions.size()))]);
    rays.push_back({p, random.vector(1)});
  }
  std::vector<std::optional<ClosestPoint>> closest(count);
  scene.closest(points, closest);
  EXPECT_EQ(first_of(verify_closest(scene, points, closest)), "");
  std::vector<std::optional<RayHit>> hits(count);
  scene.cast(rays, hits, {.count_hits = true});
  EXPECT_EQ(first_of(verify_cast(scene, rays, hits, {.count_hits = true})), "");
  EXPECT_EQ(first_of(verify_distance(scene, a, b, scene.distance(a, b))), "");
}

/// Products of coordinates that are a few units in the last place above 0 underflow.
TEST(VerifyQueries, FindNothingWrongAmongTheSmallestNumbers) {
  RandomNumbers random(5);
  for (int scene_number = 0; scene_number < 200; ++scene_number) {
    const double unit = std::ldexp(1, -1074 + scene_number % 4);
    const auto point = [&] {
      const auto number = [&] { return unit * random.below(4); };
      return Vec3d{number(), number(), number()};
    };
    TriangleMesh mesh{"small", {}, {{0, 1, 2}, {3, 4, 5}, {6, 7, 8}}};
    for (int i = 0; i < 9; ++i) mesh.positions.push_back(point());
    Scene scene;
    scene.add(mesh);
    scene.add(mesh);
    std::vector<Vec3d> points;
    for (int i = 0; i < 20; ++i) points.push_back(point());
    std::vector<std::optional<ClosestPoint>> found(points.size());
    scene.closest(points, found);
    EXPECT_EQ(first_of(verify_closest(scene, points, found)), "") << "scene " << scene_number;
  }
}

}  // namespace supple::verify_queries_test
