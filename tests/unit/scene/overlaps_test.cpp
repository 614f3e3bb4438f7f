// Triangles in boxes and spheres, compared with rationals over all triangles; signed distances.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "supple/error.hpp"
#include "supple/models.hpp"
#include "supple/scene.hpp"
#include "support/hard_scenes.hpp"
#include "support/random.hpp"
#include "verify/algebra/distance_algebra.hpp"

namespace supple::overlaps_test {

using Point = std::array<Rational, 3>;

/// The part of a convex polygon on one side of a plane across an axis.
std::vector<Point> clipped(const std::vector<Point>& polygon, std::size_t axis, const Rational& limit,
                           bool keeps_less) {
  const auto is_kept = [&](const Point& p) { return keeps_less ? p[axis] <= limit : p[axis] >= limit; };
  std::vector<Point> result;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Point &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
    if (is_kept(p)) result.push_back(p);
    if (is_kept(p) == is_kept(q)) continue;
    const Rational part = (limit - p[axis]) / (q[axis] - p[axis]);
    Point cut;
    for (std::size_t k = 0; k < 3; ++k) cut[k] = k == axis ? limit : p[k] + part * (q[k] - p[k]);
    result.push_back(cut);
  }
  return result;
}

bool overlap(const QueryBox& box, const std::array<Vec3d, 3>& triangle) {
  std::vector<Point> polygon;
  for (const Vec3d& p : triangle) polygon.push_back({Rational(p.x), Rational(p.y), Rational(p.z)});
  for (int axis = 0; axis < 3; ++axis) {
    polygon = clipped(polygon, static_cast<std::size_t>(axis), Rational(box.min[axis]), false);
    polygon = clipped(polygon, static_cast<std::size_t>(axis), Rational(box.max[axis]), true);
  }
  return !polygon.empty();
}

bool overlap(const QuerySphere& sphere, const std::array<Vec3d, 3>& triangle) {
  return distance_by_algebra({&sphere.center, 1}, triangle).squared <=
         Rational(sphere.radius) * Rational(sphere.radius);
}

template <class Region>
std::vector<Overlap> overlaps_by_brute_force(const Scene& scene, const std::vector<TriangleMesh>& meshes,
                                             const std::vector<Region>& regions) {
  std::vector<Overlap> result;
  for (std::uint32_t query = 0; query < regions.size(); ++query) {
    for (const ObjectId id : scene.objects()) {
      const TriangleMesh& mesh = meshes[id.index];
      for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        std::array<Vec3d, 3> corners;
        bool is_all_finite = true;
        for (std::size_t i = 0; i < 3; ++i) {
          corners[i] = scene.position(id, mesh.triangles[t][i]);
          for (int axis = 0; axis < 3; ++axis)
            is_all_finite = is_all_finite && std::isfinite(corners[i][axis]);
        }
        if (is_all_finite && overlap(regions[query], corners)) result.push_back({query, id, t});
      }
    }
  }
  return result;
}

std::vector<Overlap> list_of(std::span<const Overlap> overlaps) {
  return {overlaps.begin(), overlaps.end()};
}

class Overlaps : public testing::TestWithParam<Family> {};

TEST_P(Overlaps, EqualExactBruteForce) {
#ifdef NDEBUG
  constexpr std::size_t most = 30, count = 12;
#else
  constexpr std::size_t most = 12, count = 6;
#endif
  std::vector<TriangleMesh> meshes = GetParam().make(2);
  Scene scene({.threads = 2});
  std::vector<Vec3d> finite;
  for (TriangleMesh& mesh : meshes) {
    mesh.triangles.resize(std::min(mesh.triangles.size(), most));
    const ObjectId id = scene.add(mesh, {.octree = {.leaf_size = 3}});
    const double x = mesh.positions.front().x;
    if (id.index % 2 == 1 && std::isfinite(x)) scene.translate(id, {0.25 * x, 0, -0.5 * x});
    for (std::uint32_t v = 0; v < mesh.positions.size(); ++v) {
      const Vec3d p = scene.position(id, v);
      if (std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z)) finite.push_back(p);
    }
  }
  RandomNumbers random(11);
  std::vector<QueryBox> boxes;
  std::vector<QuerySphere> spheres;
  for (std::size_t i = 0; i < count; ++i) {
    // Regions that touch vertices exactly.
    const Vec3d p = finite[random.below(static_cast<std::uint32_t>(finite.size()))],
                q = finite[random.below(static_cast<std::uint32_t>(finite.size()))];
    boxes.push_back({{std::min(p.x, q.x), std::min(p.y, q.y), std::min(p.z, q.z)},
                     {std::max(p.x, q.x), std::max(p.y, q.y), std::max(p.z, q.z)}});
    const Vec3d gap = p - q;
    spheres.push_back({p, i % 3 == 0 ? 0 : std::fabs(gap.x)});
  }
  EXPECT_EQ(list_of(scene.overlaps(boxes)), overlaps_by_brute_force(scene, meshes, boxes));
  EXPECT_EQ(list_of(scene.overlaps(spheres)), overlaps_by_brute_force(scene, meshes, spheres));
}

INSTANTIATE_TEST_SUITE_P(Families, Overlaps, testing::ValuesIn(hard_families()),
                         [](const auto& family) { return family.param.name; });

TEST(Overlap, OfRegionsThatAreNone) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN(),
                   infinite = std::numeric_limits<double>::infinity();
  Scene scene;
  const ObjectId ball = scene.add(make_icosphere(3));
  const std::vector<QueryBox> boxes{
      {{1, 0, 0}, {0, 1, 1}}, {{nan, 0, 0}, {1, 1, 1}}, {{-9, -9, -9}, {9, 9, infinite}}};
  EXPECT_TRUE(scene.overlaps(boxes).empty());
  const std::vector<QuerySphere> spheres{{{1, 0, 0}, -1}, {{nan, 0, 0}, 5}, {{0, 0, 0}, infinite}};
  EXPECT_TRUE(scene.overlaps(spheres).empty());
  EXPECT_TRUE(scene.overlaps(std::span<const QueryBox>()).empty());
  const std::vector<QuerySphere> around{{{0, 0, 0}, 2}};
  EXPECT_EQ(scene.overlaps(around).size(), scene.triangle_count(ball));
  EXPECT_TRUE(scene.overlaps(around, {.mask = 2}).empty());
  scene.remove(ball);
  EXPECT_THROW(scene.overlaps(around, {.object = ball}), Error);
}

TEST(SignedDistance, IsNegativeInside) {
  Scene scene;
  scene.add(make_box({2, 2, 2}));
  const std::vector<Vec3d> points{{0, 0, 0.75}, {0, 0, 1.25}, {0, 0, 1}};
  std::vector<std::optional<ClosestPoint>> found(points.size());
  scene.closest(points, found, {.signed_distance = true});
  EXPECT_EQ(found[0]->distance, -0.25);
  EXPECT_EQ(found[1]->distance, 0.25);
  EXPECT_EQ(found[2]->distance, 0);
  scene.closest(points, found);
  EXPECT_EQ(found[0]->distance, 0.25);
  scene.add(make_cloth(2, 2));
  EXPECT_THROW(scene.closest(points, found, {.signed_distance = true}), Error);
}

}  // namespace supple::overlaps_test
