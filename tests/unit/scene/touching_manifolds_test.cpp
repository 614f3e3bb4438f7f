// Manifolds of proximity where objects touch or overlap: the surfaces around the points give the normal.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "supple/models.hpp"
#include "supple/scene.hpp"
#include "support/random.hpp"

namespace supple::touching_manifolds_test {

constexpr Vec3d up{0, 1, 0};

using Map = std::function<Vec3d(const Vec3d&)>;

TriangleMesh mapped(TriangleMesh mesh, const Map& map) {
  for (Vec3d& p : mesh.positions) p = map(p);
  return mesh;
}
TriangleMesh moved(const TriangleMesh& mesh, const Vec3d& offset) {
  return mapped(mesh, [&](const Vec3d& p) { return p + offset; });
}
/// Turned by half a right angle about z, or about x, and larger by the square root of 2.
TriangleMesh about_z(const TriangleMesh& mesh) {
  return mapped(mesh, [](const Vec3d& p) { return Vec3d{p.x - p.y, p.x + p.y, p.z}; });
}
TriangleMesh about_x(const TriangleMesh& mesh) {
  return mapped(mesh, [](const Vec3d& p) { return Vec3d{p.x, p.y - p.z, p.y + p.z}; });
}
TriangleMesh inside_out(TriangleMesh mesh) {
  for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

/// A square of 2 n² triangles at y = 0, which look up.
TriangleMesh sheet(std::uint32_t n, double size) {
  TriangleMesh mesh;
  for (std::uint32_t i = 0; i <= n; ++i) {
    for (std::uint32_t k = 0; k <= n; ++k)
      mesh.positions.push_back({size * i / n - size / 2, 0, size * k / n - size / 2});
  }
  const auto at = [&](std::uint32_t i, std::uint32_t k) { return i * (n + 1) + k; };
  for (std::uint32_t i = 0; i < n; ++i) {
    for (std::uint32_t k = 0; k < n; ++k) {
      mesh.triangles.push_back({at(i, k), at(i, k + 1), at(i + 1, k + 1)});
      mesh.triangles.push_back({at(i, k), at(i + 1, k + 1), at(i + 1, k)});
    }
  }
  return mesh;
}

TriangleMesh octahedron() {
  return {"octahedron",
          {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}},
          {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}}};
}

/// Two faces from the z axis on, which look to each other: one along the given direction, and its mirror
/// image.
TriangleMesh groove(double x, double y) {
  return {"groove",
          {{0, 0, -8}, {0, 0, 8}, {x, y, -8}, {x, y, 8}, {-x, y, -8}, {-x, y, 8}},
          {{0, 1, 3}, {0, 3, 2}, {1, 0, 4}, {1, 4, 5}}};
}

/// The six directions of up, without rounding.
const std::array<Map, 6> directions{
    [](const Vec3d& p) { return p; },
    [](const Vec3d& p) {
      return Vec3d{p.x, -p.y, -p.z};
    },
    [](const Vec3d& p) {
      return Vec3d{p.y, p.z, p.x};
    },
    [](const Vec3d& p) {
      return Vec3d{-p.y, -p.z, p.x};
    },
    [](const Vec3d& p) {
      return Vec3d{p.z, p.x, p.y};
    },
    [](const Vec3d& p) {
      return Vec3d{-p.z, p.x, -p.y};
    },
};

struct Found {
  std::vector<Manifold> manifolds;
  std::vector<std::vector<Vec3d>> points;
};

/// The manifolds of two objects; with `is_swapped`, the second one is a, and the normals are turned back.
Found manifolds_of(const TriangleMesh& first, const TriangleMesh& second, bool is_swapped,
                   bool is_solid = false) {
  Scene scene({.contacts = ContactKinds::proximity, .manifolds = true});
  scene.add(is_swapped ? second : first, {.margin = 0.01, .solid = is_solid});
  scene.add(is_swapped ? first : second, {.margin = 0.01, .solid = is_solid});
  const DetectResult& result = scene.detect();
  Found found;
  for (const Manifold& manifold : result.manifolds) {
    found.manifolds.push_back(manifold);
    if (is_swapped) found.manifolds.back().normal = -manifold.normal;
    std::vector<Vec3d>& points = found.points.emplace_back();
    for (const ManifoldPoint& point : result.points_of(manifold)) points.push_back(point.position);
  }
  return found;
}

struct Case {
  const char* name;
  TriangleMesh upper, lower;
  std::size_t points;
};

TEST(TouchingManifolds, HaveTheNormalOfTheSurfaces) {
  const TriangleMesh box = make_box({2, 2, 2}), fine_box = make_box({2, 2, 2}, 4);
  const TriangleMesh floor = moved(make_box({10, 1, 10}), {0, -0.5, 0});
  const TriangleMesh fine_floor = moved(make_box({10, 1, 10}, 10), {0, -0.5, 0});
  TriangleMesh ball = make_icosphere(4);
  const auto lowest = std::ranges::min_element(ball.positions, {}, &Vec3d::y);
  const Vec3d foot{lowest->x, lowest->y - 0.0625, lowest->z};
  *lowest = foot;
  const std::vector<Case> cases{
      {"a box on a floor", moved(box, {0.125, 1, 0.25}), floor, 4},
      {"a floor on a box", moved(floor, {0, 1, 0}), moved(box, {0.125, -1, 0.25}), 4},
      {"equal boxes", moved(box, {0, 1, 0}), moved(box, {0, -1, 0}), 4},
      {"equal fine boxes", moved(fine_box, {0, 1, 0}), moved(fine_box, {0, -1, 0}), 4},
      {"a box on a box, along one edge", moved(box, {0.5, 1, 0}), moved(box, {0, -1, 0}), 4},
      {"equal vertices", moved(fine_box, {1, 1, 1}), fine_floor, 4},
      {"on a sheet", moved(fine_box, {0, 1, 0}), sheet(20, 10), 4},
      {"on a sheet that looks down", moved(fine_box, {0, 1, 0}), inside_out(sheet(20, 10)), 4},
      {"a cloth on a table", sheet(8, 2), fine_floor, 4},
      {"a cloth that looks down", inside_out(sheet(8, 2)), fine_floor, 4},
      {"edge on edge", moved(about_z(box), {0, 2, 0}), moved(about_x(box), {0, -2, 0}), 1},
      {"along an edge", moved(about_z(box), {0, 2, 0}), moved(about_z(box), {0, -2, 0}), 2},
      {"an edge on a floor", moved(about_z(box), {0, 2, 0}), floor, 2},
      {"a vertex on a vertex", moved(ball, -foot), sheet(4, 8), 1},
      {"a vertex on a face", moved(ball, Vec3d{0.3, 0, 0.2} - foot), sheet(3, 8), 1},
      {"tip on tip", moved(octahedron(), {0, 1, 0}), moved(octahedron(), {0, -1, 0}), 1},
      {"tip on edge", moved(octahedron(), {0, 1, 0}), moved(about_z(box), {0, -2, 0}), 1},
  };
  for (const Case& one : cases) {
    for (std::size_t d = 0; d < directions.size(); ++d) {
      const Map& turn = directions[d];
      for (const bool is_swapped : {false, true}) {
        SCOPED_TRACE(std::string(one.name) + ", direction " + std::to_string(d) +
                     (is_swapped ? ", swapped" : ""));
        const Found found = manifolds_of(mapped(one.upper, turn), mapped(one.lower, turn), is_swapped);
        ASSERT_EQ(found.manifolds.size(), 1u);
        EXPECT_LE(norm(found.manifolds[0].normal - turn(up)), 1e-9);
        EXPECT_EQ(found.manifolds[0].depth, 0);
        EXPECT_EQ(found.points[0].size(), one.points);
        for (const Vec3d& point : found.points[0])
          EXPECT_NEAR(dot(point, turn(up)), dot(found.points[0][0], turn(up)), 1e-12);
      }
    }
  }
}

// The corners of turned boxes are apart or inside each other by rounding.
TEST(TouchingManifolds, TakeRoundingForTouching) {
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    SCOPED_TRACE(seed);
    RandomNumbers random(seed);
    const auto number = [&] { return random.uniform(-1, 1); };
    const double x = number(), y = number(), z = number(), w = number();
    const RigidTransform turn = RigidTransform::from_quaternion(x, y, z, w, {number(), number(), number()});
    const auto placed = [&](const Vec3d& p) {
      const auto& r = turn.rotation;
      return Vec3d{r[0] * p.x + r[1] * p.y + r[2] * p.z, r[3] * p.x + r[4] * p.y + r[5] * p.z,
                   r[6] * p.x + r[7] * p.y + r[8] * p.z};
    };
    const auto at = [&](const Vec3d& p) { return placed(p) + turn.translation; };
    const TriangleMesh box = make_box({2, 2, 2}, 1 + static_cast<std::uint32_t>(seed % 3));
    const double shift = seed % 2 == 0 ? 0 : 0.25;
    const Found found =
        manifolds_of(mapped(moved(box, {shift, 1, 0}), at), mapped(moved(box, {0, -1, 0}), at), seed % 4 > 1);
    ASSERT_EQ(found.manifolds.size(), 1u);
    EXPECT_LE(norm(found.manifolds[0].normal - placed(up)), 1e-12);
    EXPECT_EQ(found.points[0].size(), 4u);
  }
}

TEST(TouchingManifolds, HaveOneForEachWallOfACorner) {
  struct Corner {
    TriangleMesh body;
    std::size_t points;
  };
  // A box whose faces lie on both faces, and a sharper edge that touches only where they meet.
  TriangleMesh blade = moved(about_z(make_box({2, 2, 2}, 2)), {0, 2, 0});
  const TriangleMesh box = blade;
  for (Vec3d& p : blade.positions) p.x *= 0.25;
  const double half = std::sqrt(0.5);
  for (const auto& [body, points] : {Corner{box, 4}, Corner{blade, 2}}) {
    for (const Map& turn : directions) {
      for (const bool is_swapped : {false, true}) {
        const Found found = manifolds_of(mapped(body, turn), mapped(groove(8, 8), turn), is_swapped);
        ASSERT_EQ(found.manifolds.size(), 2u) << points;
        Vec3d sum;
        for (std::size_t i = 0; i < 2; ++i) {
          const Vec3d& normal = found.manifolds[i].normal;
          sum += normal;
          EXPECT_NEAR(dot(normal, turn(up)), half, 1e-12);
          EXPECT_EQ(found.points[i].size(), points);
        }
        EXPECT_LE(norm(sum - 2 * half * turn(up)), 1e-12) << "one for each side";
      }
    }
  }
}

// A program asks for penetration to be told how deep they are.
TEST(TouchingManifolds, NeverMoveABodyDeeper) {
  const TriangleMesh box = make_box({2, 2, 2}), fine_box = make_box({2, 2, 2}, 4);
  const TriangleMesh floor = moved(make_box({10, 1, 10}), {0, -0.5, 0});
  const std::vector<Case> cases{
      {"a tip in a floor", moved(octahedron(), {0.25, 1, 0.125}), floor, 0},
      {"a box in a floor", moved(box, {0.125, 1, 0.25}), floor, 0},
      {"a fine box in a floor", moved(fine_box, {0.125, 1, 0.25}), floor, 0},
      {"equal boxes", moved(box, {0, 1, 0}), moved(box, {0, -1, 0}), 0},
      {"equal fine boxes", moved(fine_box, {0, 1, 0}), moved(fine_box, {0, -1, 0}), 0},
      {"an edge in a floor", moved(about_z(box), {0, 2, 0}), floor, 0},
      {"edge in edge", moved(about_z(box), {0, 2, 0}), moved(about_x(box), {0, -2, 0}), 0},
      {"a corner in a box", moved(octahedron(), {0.75, 1, 0.875}), moved(box, {0, -1, 0}), 0},
      {"a box inside", moved(box, {0.125, -2, 0.25}), moved(make_box({10, 4, 10}), {0, -2, 0}), 0},
  };
  for (const Case& one : cases) {
    for (const double inside : {0x1p-8, 0x1p-10, 0x1p-14, 0x1p-20}) {
      for (const Map& turn : directions) {
        for (const bool is_swapped : {false, true}) {
          SCOPED_TRACE(std::string(one.name) + ", " + std::to_string(inside) +
                       (is_swapped ? ", swapped" : ""));
          const TriangleMesh upper = mapped(moved(one.upper, {0, -inside, 0}), turn);
          const Found found = manifolds_of(upper, mapped(one.lower, turn), is_swapped, true);
          for (const Manifold& manifold : found.manifolds) EXPECT_GE(dot(manifold.normal, turn(up)), 0);
        }
      }
    }
  }
}

TEST(TouchingManifolds, OfACurveHaveItsDeepestVertex) {
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    SCOPED_TRACE(seed);
    RandomNumbers random(seed);
    Scene scene({.contacts = ContactKinds::penetration, .manifolds = true});
    const ObjectId ball = scene.add(make_icosphere(5), {.solid = true});
    scene.add(moved(make_box({10, 1, 10}, 3), {0, -0.5, 0}), {.solid = true});
    scene.set_transform(ball, RigidTransform::from_quaternion(
                                  random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1), 1,
                                  {random.uniform(-1, 1), random.uniform(0.6, 0.95), random.uniform(-1, 1)}));
    const DetectResult& result = scene.detect();
    ASSERT_EQ(result.manifolds.size(), 1u);
    const IntersectionCurve& curve = result.curves[result.manifolds[0].record];
    double deepest = 0;
    for (const std::uint32_t v : result.enclosed_vertices_of(curve, ContactSide::a))
      deepest = std::max(deepest, dot(curve.centroid - scene.position(ball, v), curve.normal));
    const ManifoldPoint most = std::ranges::max(result.manifold_points, {}, &ManifoldPoint::depth);
    EXPECT_NEAR(most.depth, std::min(deepest, curve.depth), 1e-11);
  }
}

}  // namespace supple::touching_manifolds_test
