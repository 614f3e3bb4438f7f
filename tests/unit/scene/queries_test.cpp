#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <tuple>
#include <vector>

#include "supple/error.hpp"
#include "supple/inspection.hpp"
#include "supple/models.hpp"
#include "supple/scene.hpp"
#include "supple/verify.hpp"
#include "support/golden_scenes.hpp"
#include "support/hard_scenes.hpp"
#include "support/random.hpp"
#include "support/scenes.hpp"
#include "verify/algebra/distance_algebra.hpp"

namespace supple::queries_test {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
using RationalVector = std::array<Rational, 3>;

std::vector<std::optional<ClosestPoint>> closest_of(Scene& scene, const std::vector<Vec3d>& points,
                                                    const ClosestOptions& options = {}) {
  std::vector<std::optional<ClosestPoint>> results(points.size());
  scene.closest(points, results, options);
  return results;
}
std::vector<std::optional<RayHit>> hits_of(Scene& scene, const std::vector<Ray>& rays,
                                           const CastOptions& options = {}) {
  std::vector<std::optional<RayHit>> results(rays.size());
  scene.cast(rays, results, options);
  return results;
}
std::vector<Containment> inside_of(Scene& scene, const std::vector<Vec3d>& points,
                                   const QueryFilter& filter = {}) {
  std::vector<Containment> results(points.size());
  scene.inside(points, results, filter);
  return results;
}

/// The finite triangles of a scene in canonical order.
struct PlacedTriangle {
  ObjectId object;
  std::uint32_t id;
  std::array<Vec3d, 3> corners;
};
std::vector<PlacedTriangle> triangles_of(const Scene& scene, const std::vector<TriangleMesh>& meshes) {
  std::vector<PlacedTriangle> triangles;
  for (const ObjectId object : scene.objects()) {
    const TriangleMesh& mesh = meshes[object.index];
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      PlacedTriangle triangle{object, t, {}};
      bool is_all_finite = true;
      for (std::size_t i = 0; i < 3; ++i) {
        triangle.corners[i] = scene.position(object, mesh.triangles[t][i]);
        for (int axis = 0; axis < 3; ++axis)
          is_all_finite = is_all_finite && std::isfinite(triangle.corners[i][axis]);
      }
      if (is_all_finite) triangles.push_back(triangle);
    }
  }
  return triangles;
}

/// Compares with rationals over all triangles.
void expect_closest(const std::vector<PlacedTriangle>& triangles, const Vec3d& point,
                    const std::optional<ClosestPoint>& found) {
  const PlacedTriangle* best = nullptr;
  Rational least;
  Feature feature;
  for (const PlacedTriangle& triangle : triangles) {
    const ExactDistance exact = distance_by_algebra({&point, 1}, triangle.corners);
    if (best != nullptr && exact.squared >= least) continue;
    best = &triangle;
    least = exact.squared;
    feature = exact.on_b;
  }
  ASSERT_EQ(found.has_value(), best != nullptr);
  if (!found) return;
  EXPECT_EQ(found->object, best->object);
  EXPECT_EQ(found->triangle, best->id);
  EXPECT_EQ(found->feature, feature);
  EXPECT_TRUE(is_accurate(found->distance, least)) << found->distance;
}

// The first parameter of a ray in a triangle, by solving for the points where its line meets the inside, an
// edge or a corner.

RationalVector minus(const Vec3d& a, const Vec3d& b) {
  return {Rational(a.x) - Rational(b.x), Rational(a.y) - Rational(b.y), Rational(a.z) - Rational(b.z)};
}
Rational determinant(const RationalVector& a, const RationalVector& b, const RationalVector& c) {
  return a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) +
         a[2] * (b[0] * c[1] - b[1] * c[0]);
}

std::optional<Rational> first_parameter(const Ray& ray, const std::array<Vec3d, 3>& corners) {
  std::optional<Rational> first;
  const auto consider = [&](const Rational& t) {
    if (t >= 0 && (!first || t < *first)) first = t;
  };
  if (distance_by_algebra({&ray.origin, 1}, corners).squared == 0) consider(0);
  const RationalVector d = minus(ray.direction, {});
  const RationalVector a = minus(corners[0], ray.origin), u = minus(corners[1], corners[0]),
                       v = minus(corners[2], corners[0]);
  const auto negative = [](RationalVector x) {
    for (Rational& number : x) number = -number;
    return x;
  };
  // t d - p u - q v = a
  if (const Rational whole = determinant(d, negative(u), negative(v)); whole != 0) {
    const Rational t = determinant(a, negative(u), negative(v)) / whole,
                   p = determinant(d, a, negative(v)) / whole, q = determinant(d, negative(u), a) / whole;
    if (p >= 0 && q >= 0 && p + q <= 1) consider(t);
  }
  for (std::size_t i = 0; i < 3; ++i) {
    const RationalVector to = minus(corners[i], ray.origin), e = minus(corners[(i + 1) % 3], corners[i]);
    for (std::size_t x = 0; x < 3; ++x) {
      const std::size_t y = (x + 1) % 3, z = (x + 2) % 3;
      if (d[x] != 0) {  // the corner on the line
        const Rational t = to[x] / d[x];
        if (t * d[y] == to[y] && t * d[z] == to[z]) consider(t);
      }
      const Rational whole = e[x] * d[y] - e[y] * d[x];  // t d - p e = to
      if (whole == 0) continue;
      const Rational t = (e[x] * to[y] - e[y] * to[x]) / whole, p = (d[x] * to[y] - d[y] * to[x]) / whole;
      if (p >= 0 && p <= 1 && t * d[z] - p * e[z] == to[z]) consider(t);
    }
  }
  return first;
}

void expect_hit(const std::vector<PlacedTriangle>& triangles, const Ray& ray,
                const std::optional<RayHit>& found, bool counts) {
  const PlacedTriangle* best = nullptr;
  Rational least;
  std::uint64_t hits = 0;
  for (const PlacedTriangle& triangle : triangles) {
    const auto t = first_parameter(ray, triangle.corners);
    if (!t) continue;
    ++hits;
    if (best != nullptr && *t >= least) continue;
    best = &triangle;
    least = *t;
  }
  ASSERT_EQ(found.has_value(), best != nullptr);
  if (!found) return;
  EXPECT_EQ(found->object, best->object);
  EXPECT_EQ(found->triangle, best->id);
  EXPECT_TRUE(is_accurate(found->t, least * least)) << found->t;
  EXPECT_EQ(found->hits, counts ? hits : 1);
}

void expect_all_hits(const std::vector<PlacedTriangle>& triangles, const std::vector<Ray>& rays,
                     std::span<const ListedRayHit> found) {
  using Hit = std::tuple<std::uint32_t, Rational, ObjectId, std::uint32_t>;
  std::vector<Hit> truth;
  for (std::uint32_t i = 0; i < rays.size(); ++i) {
    for (const PlacedTriangle& triangle : triangles) {
      if (rays[i].direction == Vec3d{}) continue;
      if (const auto t = first_parameter(rays[i], triangle.corners))
        truth.emplace_back(i, *t, triangle.object, triangle.id);
    }
  }
  std::sort(truth.begin(), truth.end());
  ASSERT_EQ(found.size(), truth.size());
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const auto& [query, t, object, id] = truth[i];
    EXPECT_EQ(std::tie(found[i].query, found[i].hit.object, found[i].hit.triangle),
              std::tie(query, object, id));
    EXPECT_TRUE(is_accurate(found[i].hit.t, t * t)) << found[i].hit.t;
    EXPECT_EQ(found[i].hit.hits, std::count_if(truth.begin(), truth.end(), [&](const Hit& other) {
                return std::get<0>(other) == query;
              }));
  }
}

class Queries : public testing::TestWithParam<Family> {};

/// Points and rays from and through corners, centres of edges and places nearby: many distances tie, many
/// rays lie in a plane.
TEST_P(Queries, EqualBruteForceByRationals) {
#ifdef NDEBUG
  constexpr std::size_t most = 12, count = 12;
#else
  constexpr std::size_t most = 6, count = 6;
#endif
  std::vector<TriangleMesh> meshes = GetParam().make(5);
  for (TriangleMesh& mesh : meshes) mesh.triangles.resize(std::min(mesh.triangles.size(), most));
  Scene scene;
  const double size = size_of(meshes);
  for (const TriangleMesh& mesh : meshes) {
    const ObjectId id = scene.add(mesh, {.octree = {.leaf_size = 2}});
    if (id.index == 1) scene.translate(id, {size / 3, -size / 7, size / 9});
  }
  const std::vector<PlacedTriangle> triangles = triangles_of(scene, meshes);
  ASSERT_FALSE(triangles.empty());
  RandomNumbers random(7);
  const auto any_point = [&] {
    const auto& c = triangles[random.below(static_cast<std::uint32_t>(triangles.size()))].corners;
    const Vec3d& p = c[random.below(3)];
    const Vec3d& q = c[random.below(3)];
    const double share = random.below(3) / 2.0;
    return (1 - share) * p + share * q;
  };
  std::vector<Vec3d> points;
  std::vector<Ray> rays;
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3d a = any_point(), b = any_point();
    points.push_back(random.below(2) == 0 ? a : 0.5 * a + 0.5 * b);
    Vec3d direction = any_point() - b;
    if (random.below(3) == 0) direction = {0, 0, random.below(2) == 0 ? 1.0 : -1.0};
    rays.push_back({random.below(2) == 0 ? b : b - direction, direction});
  }
  const auto closest = closest_of(scene, points);
  for (std::size_t i = 0; i < count; ++i) expect_closest(triangles, points[i], closest[i]);
  for (const bool counts : {false, true}) {
    const auto hits = hits_of(scene, rays, {.count_hits = counts});
    for (std::size_t i = 0; i < count; ++i) {
      if (rays[i].direction == Vec3d{}) {
        EXPECT_FALSE(hits[i]);
      } else {
        expect_hit(triangles, rays[i], hits[i], counts);
      }
    }
  }
  expect_all_hits(triangles, rays, scene.cast_all(rays));
}

INSTANTIATE_TEST_SUITE_P(Families, Queries, testing::ValuesIn(hard_families()),
                         [](const auto& family) { return family.param.name; });

TriangleMesh tetrahedron(const std::array<Vec3d, 4>& corners) {
  return {"tetrahedron", {corners.begin(), corners.end()}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};
}

/// Where a point is, by its barycentric coordinates in rationals.
Containment in_tetrahedron(const std::array<Vec3d, 4>& c, const Vec3d& p) {
  const Rational whole = determinant(minus(c[1], c[0]), minus(c[2], c[0]), minus(c[3], c[0]));
  if (whole != 0) {
    std::array<Rational, 4> weights;
    weights[1] = determinant(minus(p, c[0]), minus(c[2], c[0]), minus(c[3], c[0])) / whole;
    weights[2] = determinant(minus(c[1], c[0]), minus(p, c[0]), minus(c[3], c[0])) / whole;
    weights[3] = determinant(minus(c[1], c[0]), minus(c[2], c[0]), minus(p, c[0])) / whole;
    weights[0] = 1 - weights[1] - weights[2] - weights[3];
    const Rational least = *std::min_element(weights.begin(), weights.end());
    return least > 0 ? Containment::inside : least == 0 ? Containment::on : Containment::outside;
  }
  for (const Triangle& t : tetrahedron(c).triangles) {
    const std::array<Vec3d, 3> corners{c[t[0]], c[t[1]], c[t[2]]};
    if (distance_by_algebra({&p, 1}, corners).squared == 0) return Containment::on;
  }
  return Containment::outside;
}

TEST(QueriesOfRays, ListTheHitsOfManyRaysForAnyNumberOfThreads) {
  RandomNumbers random(6);
  std::vector<Ray> rays;
  for (int i = 0; i < 500; ++i) rays.push_back({random.vector(1), random.vector(1)});
  std::vector<ListedRayHit> expected;
  for (const std::uint32_t threads : {1u, 4u}) {
    Scene scene({.threads = threads});
    for (const std::uint64_t seed : {1u, 2u}) scene.add(random_soup(200, 1, 0.4, seed));
    const auto first = hits_of(scene, rays, {.count_hits = true});
    const std::vector<ListedRayHit> hits = scene.cast_all(rays);
    std::size_t next = 0;
    for (std::uint32_t i = 0; i < rays.size(); ++i) {
      if (!first[i]) continue;
      ASSERT_LT(next, hits.size());
      EXPECT_EQ(hits[next].query, i);
      EXPECT_EQ(hits[next].hit, *first[i]);
      next += first[i]->hits;
    }
    EXPECT_EQ(next, hits.size());
    if (threads == 1) expected = hits;
    EXPECT_EQ(hits, expected);
    EXPECT_TRUE(scene.cast_all({}).empty());
  }
}

TEST(QueriesInside, EqualBarycentricCoordinatesOnALattice) {
  RandomNumbers random(3);
  int on = 0, inside = 0;
  for (int round = 0; round < 300; ++round) {
    const double scale = std::ldexp(1.0, 10 * static_cast<int>(random.below(7)) - 30);
    const auto lattice_point = [&](std::uint32_t size) {
      Vec3d p;
      for (int axis = 0; axis < 3; ++axis) p[axis] = scale * random.below(size);
      return p;
    };
    // One object with two tetrahedra, which may cross, touch or lie in one another.
    std::array<std::array<Vec3d, 4>, 2> corners;
    TriangleMesh mesh;
    for (auto& four : corners) {
      for (Vec3d& corner : four) corner = lattice_point(6);
      const TriangleMesh part = tetrahedron(four);
      const auto first = static_cast<std::uint32_t>(mesh.positions.size());
      mesh.positions.insert(mesh.positions.end(), part.positions.begin(), part.positions.end());
      for (const Triangle& t : part.triangles)
        mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
    }
    Scene scene;
    scene.add(mesh, {.octree = {.leaf_size = 1}});
    std::vector<Vec3d> points;
    for (int i = 0; i < 20; ++i) points.push_back(lattice_point(6));
    const std::vector<Containment> found = inside_of(scene, points);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Containment a = in_tetrahedron(corners[0], points[i]), b = in_tetrahedron(corners[1], points[i]);
      const bool is_on = a == Containment::on || b == Containment::on;
      const Containment expected = is_on    ? Containment::on
                                   : a != b ? Containment::inside
                                            : Containment::outside;
      EXPECT_EQ(found[i], expected) << round << ' ' << i;
      on += expected == Containment::on ? 1 : 0;
      inside += expected == Containment::inside ? 1 : 0;
    }
  }
  EXPECT_GT(on, 100);
  EXPECT_GT(inside, 20);
}

const TriangleMesh corner_mesh = tetrahedron({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}});

/// Points around a mesh: anywhere, at its corners, edges and faces and beside them, and on lattices in its
/// box.
std::vector<Vec3d> points_around(const TriangleMesh& mesh, RandomNumbers& random) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Vec3d low{infinity, infinity, infinity}, high = Vec3d{} - low;
  for (const Vec3d& p : mesh.positions) {
    for (int axis = 0; axis < 3; ++axis) {
      low[axis] = std::fmin(low[axis], p[axis]);
      high[axis] = std::fmax(high[axis], p[axis]);
    }
  }
  std::vector<Vec3d> points;
  for (std::uint32_t i = 0; i < 4000; ++i) {
    const Triangle& t = mesh.triangles[random.below(static_cast<std::uint32_t>(mesh.triangles.size()))];
    const Vec3d corner = mesh.positions[t[0]];
    Vec3d point;
    for (int axis = 0; axis < 3; ++axis) {
      const std::uint32_t parts = 1 + random.below(24);
      const double beside = std::nextafter(corner[axis], random.below(2) == 0 ? infinity : -infinity);
      const double choices[] = {
          low[axis] + (high[axis] - low[axis]) * random.uniform(-0.05, 1.05),
          corner[axis],
          beside,
          corner[axis] / 2 + mesh.positions[t[1]][axis] / 2,
          corner[axis] / 4 + mesh.positions[t[1]][axis] / 4 + mesh.positions[t[2]][axis] / 2,
          low[axis] + (high[axis] - low[axis]) * random.below(parts + 1) / parts};
      // Mostly the same choice for all axes.
      point[axis] = choices[random.below(10) > 0 ? i % 6 : random.below(6)];
    }
    points.push_back(point);
  }
  return points;
}

/// Few points are compared with the surface one by one, many by cells.
TEST(QueriesInside, AnswerManyPointsAsTheyAnswerFew) {
  RandomNumbers random(8);
  TriangleMesh pile;  // of crossing tetrahedra
  for (int i = 0; i < 60; ++i) {
    std::array<Vec3d, 4> corners;
    const Vec3d place = random.vector(1);
    for (Vec3d& corner : corners) corner = place + random.vector(0.3);
    const TriangleMesh part = tetrahedron(corners);
    const auto first = static_cast<std::uint32_t>(pile.positions.size());
    pile.positions.insert(pile.positions.end(), part.positions.begin(), part.positions.end());
    for (const Triangle& t : part.triangles)
      pile.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  }
  const auto scaled = [](TriangleMesh mesh, const Vec3d& factors) {
    for (Vec3d& p : mesh.positions) p = {p.x * factors.x, p.y * factors.y, p.z * factors.z};
    return mesh;
  };
  TriangleMesh inert = pile;
  inert.positions[5].y = nan;
  const std::vector<TriangleMesh> meshes{pile,
                                         inert,
                                         make_box({1, 2, 3}),
                                         make_box({1, 1, 1}, 9),
                                         make_torus(20, 12),
                                         make_icosphere(6),
                                         scaled(pile, {0x1p300, 0x1p300, 0x1p300}),
                                         scaled(pile, {0x1p120, 0x1p120, 0x1p120}),
                                         scaled(pile, {0x1p-300, 0x1p-300, 0x1p-300}),
                                         scaled(pile, {0x1p-140, 0x1p-140, 0x1p-140}),
                                         scaled(make_torus(20, 12), {1, 0x1p-60, 0x1p60}),
                                         scaled(make_torus(20, 12), {1, 0, 1})};
  std::array<int, 3> counts{};
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    for (const Vec3d& offset : {Vec3d{}, Vec3d{1.0 / 3, 1e6, -0.1}}) {
      Scene scene({.threads = 2});
      scene.translate(scene.add(meshes[i]), offset);
      if (i < 2) scene.add(make_box({0.5, 0.5, 0.5}));
      std::vector<Vec3d> points = points_around(meshes[i], random);
      for (Vec3d& p : points) p = p + offset;
      points[7].x = nan;
      const std::vector<Containment> together = inside_of(scene, points);
      for (std::size_t first = 0; first < points.size(); first += 200) {
        const auto begin = points.begin() + static_cast<std::ptrdiff_t>(first);
        const std::vector<Containment> few = inside_of(scene, {begin, begin + 200});
        for (std::size_t k = 0; k < few.size(); ++k) {
          ASSERT_EQ(together[first + k], few[k]) << i << ' ' << first + k;
          ++counts[static_cast<std::size_t>(few[k])];
        }
      }
    }
  }
  for (const int count : counts) EXPECT_GT(count, 10'000);
}

TEST(QueriesInside, NamesAnOpenEdge) {
  Scene scene;
  TriangleMesh mesh = corner_mesh;
  mesh.name = "bag";
  mesh.triangles.pop_back();
  const ObjectId open = scene.add(mesh);
  const ObjectId closed = scene.add(corner_mesh);
  try {
    inside_of(scene, {Vec3d{0.1, 0.1, 0.1}});
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(std::string(error.what()),
              "inside: the surface of bag is open, 3 boundary edges: the edge of vertices 0 and 2 has an odd "
              "number "
              "of triangles; close the holes, or leave this object out");
  }
  EXPECT_THROW(inside_of(scene, {}, {.object = open}), Error);
  EXPECT_EQ(inside_of(scene, {Vec3d{0.1, 0.1, 0.1}}, {.object = closed}).front(), Containment::inside);
}

TEST(QueriesInside, PrefersAnObjectThatContainsThePoint) {
  Scene scene;
  scene.add(corner_mesh);
  const ObjectId moved = scene.add(corner_mesh, {.group = 2});
  scene.translate(moved, {-0.25, -0.125, 0});
  const std::vector<Vec3d> points{{0, 0.25, 0.25}, {2, 0, 0}};
  EXPECT_EQ(inside_of(scene, points, {.mask = 1}), (std::vector{Containment::on, Containment::outside}));
  EXPECT_EQ(inside_of(scene, points), (std::vector{Containment::inside, Containment::outside}));
}

TEST(QueriesOfAScene, SeeObjectsWhereTheyAre) {
  Scene scene;
  const ObjectId object = scene.add(corner_mesh);
  const auto distance = [&] { return closest_of(scene, {Vec3d{3, 0, 0}}).front()->distance; };
  EXPECT_EQ(distance(), 2);
  scene.translate(object, {1, 0, 0});
  EXPECT_EQ(distance(), 1);
  scene.set_positions(object, corner_mesh.positions);
  EXPECT_EQ(distance(), 2);
  std::vector<Vec3d> end = corner_mesh.positions;
  end[1].x = 2.5;
  scene.set_motion(object, corner_mesh.positions, end);
  EXPECT_EQ(distance(), 0.5);
  scene.remove(object);
  EXPECT_FALSE(closest_of(scene, {Vec3d{3, 0, 0}}).front());
  EXPECT_FALSE(hits_of(scene, {{{3, 0, 0}, {-1, 0, 0}}}).front());
}

TEST(QueriesOfAScene, DoNotDisturbDetection) {
  RandomNumbers random(11);
  Scene asked, plain;
  std::vector<ObjectId> ids;
  for (int i = 0; i < 6; ++i) {
    ids.push_back(asked.add(corner_mesh));
    plain.add(corner_mesh);
  }
  for (int step = 0; step < 200; ++step) {
    for (const ObjectId id : ids) {
      if (random.below(2) == 0) continue;
      const Vec3d offset = random.vector(0.5);
      asked.translate(id, offset);
      plain.translate(id, offset);
      if (random.below(3) == 0) closest_of(asked, {random.vector(1)});
    }
    const DetectRequest request{.contacts = random.below(2) == 0 ? ContactKinds::intersection
                                                                 : ContactKinds::continuous};
    const DetectResult& expected = plain.detect(request);
    const DetectResult& found = asked.detect(request);
    ASSERT_EQ(hash_of(found), hash_of(expected)) << step;
    ASSERT_TRUE(std::ranges::equal(found.contact_events.begin, expected.contact_events.begin));
    const auto contacts = found.contacts.size();
    inside_of(asked, {random.vector(1)});
    ASSERT_EQ(asked.result().contacts.size(), contacts);
    ASSERT_TRUE(verify(asked).agrees());
    ASSERT_EQ(SceneInspector(asked).validate(), "");
  }
}

TEST(QueriesOfAScene, DoNotSearchForPairsOfObjects) {
  Scene scene;
  int filtered = 0;
  scene.set_pair_filter([&](ObjectId, ObjectId) {
    ++filtered;
    return true;
  });
  const ObjectId a = scene.add(corner_mesh), b = scene.add(corner_mesh);
  scene.detect();
  ASSERT_GT(filtered, 0);
  filtered = 0;
  scene.translate(a, {0.25, 0, 0});
  closest_of(scene, {Vec3d{3, 0, 0}});
  inside_of(scene, {Vec3d{3, 0, 0}});
  hits_of(scene, {{{3, 0, 0}, {-1, 0, 0}}});
  scene.distance(a, b);
  scene.any_contact(a, b);
  EXPECT_EQ(filtered, 0);
  scene.detect();
  EXPECT_GT(filtered, 0);
}

TEST(QueriesOfAScene, LeaveOutWhatIsNotFinite) {
  Scene scene;
  TriangleMesh mesh = corner_mesh;
  mesh.positions[3].z = nan;
  scene.add(mesh);
  const auto closest = closest_of(scene, {{0.25, 0.25, 2}, {nan, 0, 0}});
  EXPECT_EQ(closest[0]->triangle, 0u);
  EXPECT_EQ(closest[0]->distance, 2);
  EXPECT_FALSE(closest[1]);
  const auto hits = hits_of(scene, {{{0.25, 0.25, 2}, {0, 0, -1}},
                                    {{0.25, 0.25, 2}, {0, 0, 0}},
                                    {{nan, 0, 0}, {0, 0, 1}},
                                    {{0, 0, 0}, {0, 0, std::numeric_limits<double>::infinity()}}});
  EXPECT_EQ(hits[0]->t, 2);
  EXPECT_FALSE(hits[1] || hits[2] || hits[3]);
  EXPECT_EQ(inside_of(scene, {{0.1, 0.1, -0.1}, {0.1, 0.1, 0}, {nan, 0, 0}}),
            (std::vector{Containment::outside, Containment::on, Containment::outside}));
}

/// What has no area and triangles that are not finite have no closest point, near or far, and hide none of
/// others.
TEST(QueriesOfAScene, LeaveOutLinesAndPoints) {
  TriangleMesh particle, rod, broken, both;
  particle.positions = rod.positions = {{0.5, 1, 3}, {0.5, 1, 3.001}};
  particle.points = {0};
  rod.edges = {{0, 1}};
  broken.positions = {{0, 0, 0}, {1, 0, 0}, {nan, 0, 0}};
  broken.triangles = {{0, 1, 2}};
  broken.points = both.points = {3};
  broken.positions.push_back({2, 2, 2});
  both.positions = {{40, 0, 0}, {41, 0, 0}, {40, 1, 0}, {0, 0, 0}};
  both.triangles = {{0, 1, 2}};
  for (const double scale : {1.0, 0x1p-1000, 0x1p100, 0x1p900}) {
    std::vector<Vec3d> points;
    for (const double far : {0.0, 1.0, 100.0, 1e6, 1e12}) {
      points.push_back(scale * Vec3d{0.5 + far, 1, 3});
      points.push_back(scale * Vec3d{0.1, -far, 0.3});
    }
    Scene alone, beside;
    for (TriangleMesh mesh : {particle, rod, broken, both}) {
      for (Vec3d& p : mesh.positions) p = scale * p;
      alone.add(mesh);
      beside.add(mesh);
    }
    alone.remove(alone.objects().back());
    const auto found = closest_of(beside, points);
    EXPECT_EQ(verify_closest(beside, points, found).size(), 0u) << scale;
    for (const auto& each : found) {
      ASSERT_TRUE(each) << scale;
      EXPECT_EQ(each->object, beside.objects().back()) << scale;
    }
    for (const auto& each : closest_of(alone, points)) EXPECT_FALSE(each) << scale;
  }
}

TEST(QueriesOfAScene, HaveClosedBounds) {
  Scene scene;
  scene.add(corner_mesh);
  const std::vector<Vec3d> point{{0.25, 0.25, -1}};
  EXPECT_TRUE(closest_of(scene, point, {.max_distance = 1}).front());
  EXPECT_FALSE(closest_of(scene, point, {.max_distance = std::nextafter(1.0, 0.0)}).front());
  EXPECT_THROW(closest_of(scene, point, {.max_distance = -1}), Error);
  EXPECT_THROW(closest_of(scene, point, {.max_distance = nan}), Error);
  std::vector<std::optional<ClosestPoint>> results(2);
  EXPECT_THROW(scene.closest(point, results), Error);
  EXPECT_THROW(closest_of(scene, point, {.filter = {.object = ObjectId{7, 0}}}), Error);
}

/// All magnitudes that doubles have.
TEST(QueriesOfAScene, ScaleWithTheCoordinates) {
  for (const int exponent : {-1000, -300, -60, 60, 300, 1000}) {
    const double scale = std::ldexp(1.0, exponent);
    TriangleMesh mesh = corner_mesh;
    for (Vec3d& p : mesh.positions) p = scale * p;
    Scene scene;
    scene.add(mesh);
    const Vec3d inside{scale / 8, scale / 8, scale / 4};
    const auto closest = closest_of(scene, {inside, {scale * 3, 0, 0}});
    EXPECT_EQ(closest[0]->distance, scale / 8) << exponent;
    EXPECT_EQ(closest[1]->distance, scale * 2) << exponent;
    const auto hits = hits_of(scene, {{{scale / 8, scale / 8, -scale}, {0, 0, scale}}}, {.count_hits = true});
    EXPECT_EQ(hits[0]->t, 1) << exponent;
    EXPECT_EQ(hits[0]->hits, 2u) << exponent;
    EXPECT_EQ(inside_of(scene, {inside}).front(), Containment::inside) << exponent;
  }
}

/// The ray's numbers and those of the triangles may differ in size as much as doubles can.
TEST(QueriesOfAScene, RoundTheParametersOfLongRaysAtSmallTriangles) {
  RandomNumbers random(9);
  for (const int exponent : {-500, -250, -100, 100, 250}) {
    for (int round = 0; round < 20; ++round) {
      std::array<Vec3d, 4> corners;
      for (Vec3d& corner : corners) corner = std::ldexp(1.0, exponent) * random.vector(1);
      const std::vector<TriangleMesh> meshes{tetrahedron(corners)};
      Scene scene;
      scene.add(meshes.front());
      const Vec3d origin = std::ldexp(1.0, exponent) * random.vector(3);
      const Vec3d middle = 0.25 * (corners[0] + corners[1] + corners[2] + corners[3]);
      const Ray ray{origin, std::ldexp(1.0, std::min(1000, -2 * exponent)) * (middle - origin)};
      const auto hits = hits_of(scene, {ray});
      EXPECT_TRUE(hits.front()) << exponent;
      expect_hit(triangles_of(scene, meshes), ray, hits.front(), false);
    }
  }
}

TEST(QueriesOfAScene, AreTheSameForAnyNumberOfThreads) {
  RandomNumbers random(1);
  std::vector<Vec3d> points;
  std::vector<Ray> rays;
  for (int i = 0; i < 500; ++i) {
    points.push_back(random.vector(2));
    rays.push_back({random.vector(2), random.vector(1)});
  }
  std::vector<std::optional<ClosestPoint>> closest;
  std::vector<std::optional<RayHit>> hits;
  for (const std::uint32_t threads : {1u, 2u, 3u, 8u}) {
    for (const std::uint32_t leaf_size : {1u, 64u}) {
      Scene scene({.threads = threads});
      for (const std::uint64_t seed : {1u, 2u})
        scene.add(crumpled_sheet(20, 20, 0.2, seed), {.octree = {.leaf_size = leaf_size}});
      if (closest.empty()) {
        closest = closest_of(scene, points);
        hits = hits_of(scene, rays);
      }
      EXPECT_EQ(closest_of(scene, points), closest) << threads;
      EXPECT_EQ(hits_of(scene, rays), hits) << threads;
    }
  }
}

/// The parameters of such rays overflow on the way, but their boxes must not be excluded.
/// Points descend together into one object, and alone into several.
TEST(QueriesOfAScene, AnswerPointsOfOneObjectAsThoseOfTwo) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  RandomNumbers random(9);
  // Many triangles are at the same distance, and some have no area.
  const auto on_lattice = [](Vec3d p) {
    return Vec3d{std::round(8 * p.x), std::round(8 * p.y), std::round(8 * p.z)} / 8.0;
  };
  for (const double scale : {1.0, 0x1p-300, 0x1p40}) {
    for (const double offset : {0.0, 3.0, 0x1p22}) {
      TriangleMesh ball = make_icosphere(16);
      for (Vec3d& p : ball.positions) p = scale * on_lattice(p);
      ball.positions[7].x = std::numeric_limits<double>::quiet_NaN();
      const Vec3d translation = scale * offset * Vec3d{1, 0.5, -1};
      std::vector<Vec3d> points{{infinity, 0, 0}};
      for (int i = 0; i < 500; ++i) {
        const Vec3d p = random.vector(1.5);
        points.push_back(translation + scale * p);
        points.push_back(translation + scale * on_lattice(p));
      }
      Scene one, two;
      for (Scene* const scene : {&one, &two})
        scene->set_transform(scene->add(ball), {.translation = translation});
      const Vec3d far = translation + scale * Vec3d{1000, 0, 0};
      two.add({.name = {},
               .positions = {far, far + scale * Vec3d{1, 0, 0}, far + scale * Vec3d{0, 1, 0}},
               .triangles = {{0, 1, 2}}});
      for (const double most : {infinity, 0.125 * scale}) {
        std::vector<std::optional<ClosestPoint>> of_one(points.size()), of_two(points.size());
        one.closest(points, of_one, {.max_distance = most});
        two.closest(points, of_two, {.max_distance = most});
        EXPECT_TRUE(of_one == of_two) << scale << " " << offset << " " << most;
      }
    }
  }
}

TEST(Cast, WithDirectionsOfExtremeSizes) {
  Scene scene;
  scene.add(TriangleMesh{"far", {{1, -1, -1}, {1, 3, -1}, {1, -1, 3}}, {{0, 1, 2}}});
  std::vector<Ray> rays;
  for (const double size : {1e-308, 1e-300, 1e-297, 1e-200, 1e200, 1e300}) {
    for (const double start : {-1e12, 0.0}) rays.push_back({{start, 0, 0}, {size, size * 1e-13, 0}});
  }
  std::vector<std::optional<RayHit>> hits(rays.size());
  scene.cast(rays, hits);
  for (std::size_t i = 0; i < rays.size(); ++i) EXPECT_TRUE(hits[i]) << i;
}

}  // namespace supple::queries_test
