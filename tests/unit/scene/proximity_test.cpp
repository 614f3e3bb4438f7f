#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "supple/error.hpp"
#include "supple/inspection.hpp"
#include "supple/scene.hpp"
#include "supple/verify.hpp"
#include "support/golden_scenes.hpp"
#include "support/random.hpp"

namespace supple::proximity_test {

constexpr ContactKinds proximity = ContactKinds::proximity;

std::vector<ProximityPair> copy_of(const DetectResult& result) {
  return {result.proximity_pairs.begin(), result.proximity_pairs.end()};
}

class Proximity : public testing::TestWithParam<Family> {};

TEST_P(Proximity, EqualsExactBruteForce) {
#ifdef NDEBUG
  constexpr std::size_t triangles = 24;
#else
  constexpr std::size_t triangles = 10;  // rationals are slow in builds with sanitizers
#endif
  for (const ProximityListing listing : {ProximityListing::features, ProximityListing::elements}) {
    Scene scene =
        near_scene_of(GetParam().make(1), {.contacts = proximity, .proximity_listing = listing}, triangles);
    scene.detect();
    const VerifyReport report = verify(scene);
    EXPECT_TRUE(report.agrees()) << report.proximity_differences.size() << " differences";
    EXPECT_EQ(report.near_pairs, scene.result().proximity_pairs.size());
    EXPECT_GT(report.near_pairs, 0u);
  }
}

/// Several pairs of elements can have the same closest features, and threads decide which is found first. The
/// sign of a zero would tell them apart.
TEST_P(Proximity, HasNoNegativeZeros) {
  Scene scene = near_scene_of(GetParam().make(1), {.contacts = proximity});
  for (const ProximityPair& pair : scene.detect().proximity_pairs) {
    for (int axis = 0; axis < 3; ++axis)
      ASSERT_FALSE(pair.normal[axis] == 0 && std::signbit(pair.normal[axis]));
  }
}

INSTANTIATE_TEST_SUITE_P(Families, Proximity, testing::ValuesIn(hard_families()),
                         [](const auto& family) { return family.param.name; });

/// Points of a lattice of small integers: most distances tie, and the reach is attained exactly.
TriangleMesh lattice_mesh(RandomNumbers& random, std::uint32_t size, std::size_t triangles) {
  TriangleMesh mesh;
  for (std::size_t v = 0; v < 3 * triangles; ++v) {
    Vec3d p;
    for (int axis = 0; axis < 3; ++axis) p[axis] = random.below(size);
    mesh.positions.push_back(p);
  }
  for (std::size_t t = 0; t < triangles; ++t) {
    const auto corner = [&] { return random.below(static_cast<std::uint32_t>(3 * triangles)); };
    mesh.triangles.push_back({corner(), corner(), corner()});
  }
  return mesh;
}

TEST(ProximityPairs, OfALatticeWithMarginsThatAreAttained) {
  RandomNumbers random(5);
  for (const double scale : {1.0, 1e-30, 1e30}) {
    for (const double reach : {0.0, 1.0, std::sqrt(2.0), 2.0}) {
      for (const ProximityListing listing : {ProximityListing::features, ProximityListing::elements}) {
        Scene scene({.contacts = proximity, .proximity_listing = listing});
        for (int object = 0; object < 2; ++object) {
          TriangleMesh mesh = lattice_mesh(random, 5, 8);
          for (Vec3d& p : mesh.positions) p = scale * p;
          scene.add(mesh, {.self_collision = true, .margin = scale * reach / 2, .octree = {.leaf_size = 2}});
        }
        scene.detect();
        EXPECT_TRUE(verify(scene).agrees()) << scale << ' ' << reach;
        EXPECT_GT(scene.result().proximity_pairs.size(), 0u);
      }
    }
  }
}

const TriangleMesh triangle{"triangle", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};

TEST(ProximityPairs, CountTheSumOfTheMarginsClosed) {
  Scene scene({.contacts = proximity});
  const ObjectId a = scene.add(triangle, {.margin = 0.25});
  const ObjectId b = scene.add(triangle, {.margin = 0.125});
  scene.translate(b, {0.25, 0.25, 0.375});
  ASSERT_EQ(scene.detect().proximity_groups.size(), 1u);
  for (const ProximityPair& pair : scene.result().proximity_pairs) {
    EXPECT_EQ(pair.distance, 0.375);
    EXPECT_EQ(pair.normal, (Vec3d{0, 0, -1})) << "from b to a";
  }
  scene.set_options(a, {.margin = 0.25 - 0x1p-53});
  EXPECT_TRUE(scene.detect().proximity_pairs.empty());
  scene.set_options(b, {.margin = 0.2});
  EXPECT_FALSE(scene.detect().proximity_pairs.empty());
}

TEST(ProximityPairs, ListAVertexOverAFaceOnce) {
  Scene scene({.contacts = proximity});
  scene.add(triangle, {.margin = 0.1});
  const TriangleMesh needle{"needle", {{.2, .2, .125}, {.2, .2, 2}, {.2, .4, 2}}, {{0, 1, 2}}};
  scene.add(needle, {.margin = 0.1});
  const DetectResult& result = scene.detect();
  ASSERT_EQ(result.proximity_pairs.size(), 1u);
  const ProximityPair& pair = result.proximity_pairs[0];
  EXPECT_EQ(pair.kind_a, FeatureKind::face);
  EXPECT_EQ(pair.kind_b, FeatureKind::vertex);
  EXPECT_EQ(pair.distance, 0.125);
  EXPECT_EQ(pair.point_b, (Vec3d{.2, .2, .125}));
  EXPECT_EQ(pair.normal, (Vec3d{0, 0, -1}));
  EXPECT_NEAR(pair.barycentric_a[0], 0.6, 1e-15);
  EXPECT_EQ(scene.vertices_of(pair, ContactSide::a).size(), 3u);
  EXPECT_EQ(scene.vertices_of(pair, ContactSide::b).size(), 1u);
}

TEST(ProximityPairs, OfPairsThatTouchHaveANormal) {
  Scene scene({.contacts = proximity});
  scene.add(triangle);
  const ObjectId other = scene.add(triangle);
  for (const Vec3d offset : {Vec3d{0, 0, 0}, Vec3d{1, 0, 0}, Vec3d{.25, .25, 0}, Vec3d{.5, .5, 0}}) {
    scene.set_transform(other, {.rotation = {1, 0, 0, 0, 0, -1, 0, 1, 0}, .translation = offset});
    ASSERT_FALSE(scene.detect().proximity_pairs.empty());
    for (const ProximityPair& pair : scene.result().proximity_pairs) {
      EXPECT_EQ(pair.distance, 0);
      EXPECT_NEAR(std::hypot(pair.normal.x, pair.normal.y, pair.normal.z), 1, 1e-15);
    }
  }
}

TEST(ProximityPairs, BeginStayAndEnd) {
  Scene scene({.contacts = proximity});
  scene.add(triangle, {.margin = 0.1});
  const ObjectId b = scene.add(triangle, {.margin = 0.1});
  const auto counts_at = [&](double z) {
    scene.set_transform(b, {.translation = {0, 0, z}});
    const PairEvents& events = scene.detect().proximity_events;
    EXPECT_TRUE(scene.result().contact_events.begin.empty()) << "near is not in contact";
    return std::array{events.begin.size(), events.stay.size(), events.end.size()};
  };
  EXPECT_EQ(counts_at(1), (std::array<std::size_t, 3>{0, 0, 0}));
  EXPECT_EQ(counts_at(0.15), (std::array<std::size_t, 3>{1, 0, 0}));
  EXPECT_EQ(counts_at(0.1), (std::array<std::size_t, 3>{0, 1, 0}));
  EXPECT_EQ(counts_at(0.3), (std::array<std::size_t, 3>{0, 0, 1}));
}

/// All kinds of contacts in one call; proximity is that of the end of the step.
TEST(ProximityPairs, ComeWithOtherKindsInOneCall) {
  const std::vector<TriangleMesh> from = hard_families().front().make(6),
                                  to = hard_families().front().make(7);
  const double margin = 1e-3 * size_of(to);
  for (const ContactKinds others : {ContactKinds::intersection, ContactKinds::continuous,
                                    ContactKinds::intersection | ContactKinds::continuous}) {
    Scene all({.contacts = others | proximity}), alone({.contacts = proximity}),
        without({.contacts = others});
    for (Scene* scene : {&all, &alone, &without}) {
      for (std::size_t i = 0; i < from.size(); ++i) {
        const ObjectId object = scene->add(from[i], {.self_collision = true, .margin = margin});
        if (scene == &alone)
          scene->set_positions(object, to[i].positions);
        else
          scene->set_motion(object, from[i].positions, to[i].positions);
      }
      scene->detect();
      EXPECT_EQ(SceneInspector(*scene).validate(), "");
    }
    EXPECT_GT(alone.result().proximity_pairs.size(), 0u);
    EXPECT_EQ(copy_of(all.result()), copy_of(alone.result()));
    EXPECT_TRUE(std::ranges::equal(all.result().contacts, without.result().contacts));
    EXPECT_TRUE(std::ranges::equal(all.result().continuous_contacts, without.result().continuous_contacts));
  }
}

TEST(ProximityPairs, OfObjectsThatDidNotMoveAreKept) {
  std::vector<TriangleMesh> meshes = hard_families().front().make(3);
  Scene scene = near_scene_of(meshes, {.contacts = proximity});
  const std::vector<ProximityPair> first = copy_of(scene.detect());
  EXPECT_EQ(copy_of(scene.detect()), first);
  EXPECT_EQ(scene.result().stats.vertex_face_candidates, 0u);
  const ObjectId moved = scene.objects().back();
  scene.translate(moved, {1e-3, 0, 0});
  scene.detect();
  EXPECT_TRUE(verify(scene).agrees());
  scene.detect({.proximity_listing = ProximityListing::elements});
  EXPECT_TRUE(verify(scene).agrees());
}

TEST(ProximityPairs, AreTheFirstOfALimit) {
  Scene scene = near_scene_of(hard_families().front().make(3), {.contacts = proximity});
  const std::vector<ProximityPair> all = copy_of(scene.detect());
  ASSERT_GT(all.size(), 5u);
  for (const std::size_t most : {std::size_t{0}, std::size_t{5}, all.size() - 1, all.size()}) {
    const DetectResult& result = scene.detect({.max_contacts = most});
    EXPECT_EQ(result.truncated, most < all.size());
    EXPECT_TRUE(std::equal(result.proximity_pairs.begin(), result.proximity_pairs.end(), all.begin(),
                           all.begin() + static_cast<std::ptrdiff_t>(most)));
  }
}

TEST(ProximityPairs, LeaveOutElementsThatAreNotFinite) {
  Scene scene({.contacts = proximity});
  TriangleMesh sheet = crumpled_sheet(4, 4, 0.1, 1);
  scene.add(sheet, {.margin = 0.5});
  sheet.positions[7].y = std::numeric_limits<double>::quiet_NaN();
  scene.add(sheet, {.margin = 0.5});
  EXPECT_EQ(scene.detect().non_finite_vertices.size(), 1u);
  EXPECT_FALSE(scene.result().proximity_pairs.empty());
  EXPECT_TRUE(verify(scene).agrees());
}

TEST(ProximityPairs, RefuseMarginsOutOfRange) {
  Scene scene({.contacts = proximity});
  for (const double margin :
       {-1.0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()})
    EXPECT_THROW(scene.add(triangle, {.margin = margin}), Error) << margin;
  const ObjectId object = scene.add(triangle);
  EXPECT_THROW(scene.set_options(object, {.margin = -1}), Error);
  EXPECT_THROW(scene.set_options({7, 0}, {.margin = 1}), Error);
  scene.add(TriangleMesh{}, {.margin = 1e308});
  scene.add(triangle, {.margin = 1e308});
  EXPECT_FALSE(scene.detect().proximity_pairs.empty());
}

}  // namespace supple::proximity_test
