// Edges that cross faces are near, at distance 0: meshes that cut through each other away from all edges,
// rods through surfaces, and an object through itself.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <tuple>
#include <vector>

#include "supple/inspection.hpp"
#include "supple/models.hpp"
#include "supple/scene.hpp"
#include "supple/verify.hpp"
#include "support/random.hpp"

namespace supple::crossing_pairs_test {

constexpr ContactKinds proximity = ContactKinds::proximity;
using enum FeatureKind;

const TriangleMesh plate{"plate", {{-4, -4, 0}, {8, -4, 0}, {-4, 8, 0}}, {{0, 1, 2}}};
const TriangleMesh needle{"needle", {{0, 0, -2}, {0.25, 0, -2}, {0, 0.25, 3}}, {{0, 1, 2}}};

std::size_t crossings(const DetectResult& result) {
  std::size_t count = 0;
  for (const ProximityPair& pair : result.proximity_pairs)
    count += (pair.kind_a == edge && pair.kind_b == face) || (pair.kind_a == face && pair.kind_b == edge);
  return count;
}

TEST(CrossingPairs, OfANeedleThroughAPlate) {
  for (const ProximityListing listing : {ProximityListing::features, ProximityListing::elements}) {
    for (const double margin : {0.0, 0.01}) {
      for (const bool needle_first : {true, false}) {
        Scene scene({.contacts = proximity, .proximity_listing = listing});
        scene.add(needle_first ? needle : plate, {.margin = margin});
        scene.add(needle_first ? plate : needle, {.margin = margin});
        const DetectResult& result = scene.detect();
        ASSERT_EQ(result.proximity_pairs.size(), 2u) << "two edges of the needle cross the plate";
        EXPECT_EQ(result.proximity_events.begin.size(), 1u);
        for (const ProximityPair& pair : result.proximity_pairs) {
          EXPECT_EQ(pair.kind_a, needle_first ? edge : face);
          EXPECT_EQ(pair.kind_b, needle_first ? face : edge);
          EXPECT_EQ(pair.on_a, (Feature{pair.kind_a, 0}));
          EXPECT_EQ(pair.on_b, (Feature{pair.kind_b, 0}));
          EXPECT_EQ(pair.distance, 0);
          EXPECT_EQ(pair.point_a, pair.point_b);
          EXPECT_EQ(pair.point_a.z, 0);
          EXPECT_EQ(pair.normal, (Vec3d{0, 0, needle_first ? 1.0 : -1.0})) << "that of the face, from b to a";
          EXPECT_DOUBLE_EQ((needle_first ? pair.barycentric_a : pair.barycentric_b)[0], 0.6);
          EXPECT_EQ(scene.vertices_of(pair, ContactSide::a).size(), needle_first ? 2u : 3u);
        }
        EXPECT_TRUE(verify(scene).agrees());
        EXPECT_EQ(scene.distance({0, 0}, {1, 0})->distance, 0);
        EXPECT_EQ(SceneInspector(scene).explain({0, 0}, 0, {1, 0}, 0).stage, PairStage::contact);
      }
    }
  }
}

TEST(CrossingPairs, NeedAllKindsOfElements) {
  for (const ElementKinds kinds : {ElementKinds::all, ElementKinds::vertex_face, ElementKinds::edge_edge}) {
    Scene scene({.contacts = proximity, .element_kinds = kinds});
    scene.add(plate);
    scene.add(needle);
    EXPECT_EQ(scene.detect().proximity_pairs.size(), kinds == ElementKinds::all ? 2u : 0u);
    EXPECT_TRUE(verify(scene).agrees());
  }
}

TEST(CrossingPairs, OfARodThroughABall) {
  const TriangleMesh ball = make_icosphere(6);
  const std::vector<Vec3d> rod{{-3, 0.01, 0.02}, {3, 0.03, -0.01}};
  for (const bool rod_first : {true, false}) {
    Scene scene({.contacts = proximity});
    const auto add_rod = [&] { return scene.add(rod, std::vector<Triangle>{}, {.edges = {{0, 1}}}); };
    if (rod_first) add_rod();
    const ObjectId of_ball = scene.add(ball);
    if (!rod_first) add_rod();
    EXPECT_EQ(crossings(scene.detect()), 2u);
    EXPECT_EQ(scene.result().proximity_pairs.size(), 2u);
    EXPECT_TRUE(verify(scene).agrees());
    const auto distance = scene.distance({0, 0}, {1, 0});
    ASSERT_TRUE(distance);
    EXPECT_EQ(distance->distance, 0);
    EXPECT_TRUE(verify_distance(scene, {0, 0}, {1, 0}, distance).empty());
    scene.translate(of_ball, {0, 0, 4});
    EXPECT_TRUE(scene.detect().proximity_pairs.empty());
    EXPECT_EQ(scene.result().proximity_events.end.size(), 1u);
    const auto apart = scene.distance({0, 0}, {1, 0});
    ASSERT_TRUE(apart);
    EXPECT_NEAR(apart->distance, 3, 0.05);
    EXPECT_TRUE(verify_distance(scene, {0, 0}, {1, 0}, apart).empty());
  }
}

/// Rods, particles and triangles in one object, some with vertices that are not finite, on a lattice and not.
TEST(CrossingPairs, AndDistancesOfMixedObjectsAgreeWithBruteForce) {
#ifdef NDEBUG
  constexpr int rounds = 40;
#else
  constexpr int rounds = 8;
#endif
  RandomNumbers random(21);
  std::size_t found = 0;
  for (int round = 0; round < rounds; ++round) {
    const bool is_lattice = round % 2 == 0;
    const double size = std::ldexp(1, round % 5 == 0 ? 400 : round % 5 == 1 ? -400 : 0);
    Scene scene({.contacts = proximity,
                 .proximity_listing = round % 4 < 2 ? ProximityListing::features : ProximityListing::elements,
                 .threads = 1 + static_cast<std::uint32_t>(round % 2)});
    for (int object = 0; object < 2; ++object) {
      TriangleMesh mesh;
      ObjectOptions options{.self_collision = round % 3 != 0,
                            .margin = size * (round % 3) / 8.0,
                            .octree = {.leaf_size = 1u + random.below(4)}};
      for (int v = 0; v < 24; ++v) {
        Vec3d p;
        for (int axis = 0; axis < 3; ++axis)
          p[axis] = is_lattice ? random.between(-2, 2) : random.uniform(-1, 1);
        if (random.below(30) == 0) p.y = std::numeric_limits<double>::quiet_NaN();
        mesh.positions.push_back(size * p);
      }
      const auto corner = [&] { return random.below(24); };
      for (int t = 0; t < round % 12; ++t) mesh.triangles.push_back({corner(), corner(), corner()});
      for (int i = 0; i < round % 4; ++i) {
        if (const std::array ends{corner(), corner()}; ends[0] != ends[1]) options.edges.push_back(ends);
        options.points.push_back(corner());
      }
      const ObjectId id = scene.add(mesh, options);
      if (round % 7 == 0) scene.translate(id, size * random.vector(1e3));
    }
    found += crossings(scene.detect());
    ASSERT_TRUE(verify(scene).agrees()) << round << ": " << verify(scene).proximity_differences.size();
    const auto distance = scene.distance({0, 0}, {1, 0});
    const auto wrong = verify_distance(scene, {0, 0}, {1, 0}, distance);
    EXPECT_TRUE(wrong.empty()) << round << ": " << wrong[0].found << " instead of " << wrong[0].expected;
    EXPECT_EQ(SceneInspector(scene).validate(), "");
  }
  EXPECT_GT(found, 20u);
}

/// The far edge of a triangle crosses another triangle with the same corner: they share a vertex, but the
/// edge and the face do not.
TEST(CrossingPairs, OfAnObjectThroughItself) {
  TriangleMesh mesh{
      "folded", {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {1, 1, -1}, {1, 1, 2}}, {{0, 1, 2}, {0, 3, 4}}};
  Scene scene({.contacts = proximity});
  const ObjectId object = scene.add(mesh, {.self_collision = true});
  ASSERT_EQ(scene.detect().proximity_pairs.size(), 1u);
  const ProximityPair& pair = scene.result().proximity_pairs[0];
  EXPECT_EQ(pair.kind_a, edge);
  EXPECT_EQ(pair.kind_b, face);
  EXPECT_EQ(pair.element_a, (std::array{3u, 4u}));
  EXPECT_EQ(pair.element_b, (std::array{0u, 0u}));
  EXPECT_TRUE(verify(scene).agrees());
  mesh.positions[3].z = 1;
  scene.set_positions(object, mesh.positions);
  EXPECT_TRUE(scene.detect().proximity_pairs.empty());
}

/// Two spheres that overlap: the crossings are the points of their intersections.
TEST(CrossingPairs, AreThePointsOfIntersections) {
  const TriangleMesh ball = make_icosphere(10);
  Scene scene({.contacts = ContactKinds::intersection | proximity});
  scene.add(ball, {.margin = 1e-3});
  const ObjectId other = scene.add(ball, {.margin = 1e-3});
  scene.translate(other, {0.7, 0.4, 0.3});
  const DetectResult& result = scene.detect();
  std::vector<Vec3d> of_contacts, of_crossings;
  for (const ContactPoint& point : result.contact_points) of_contacts.push_back(point.position);
  for (const ProximityPair& pair : result.proximity_pairs) {
    if (pair.kind_a == vertex || pair.kind_b == vertex || pair.kind_a == pair.kind_b) continue;
    of_crossings.push_back(pair.point_a);
  }
  const auto less = [](const Vec3d& p, const Vec3d& q) {
    return std::tie(p.x, p.y, p.z) < std::tie(q.x, q.y, q.z);
  };
  for (auto* points : {&of_contacts, &of_crossings}) std::sort(points->begin(), points->end(), less);
  of_contacts.erase(std::unique(of_contacts.begin(), of_contacts.end()), of_contacts.end());
  EXPECT_GT(of_crossings.size(), 50u);
  EXPECT_EQ(of_crossings, of_contacts);
}

}  // namespace supple::crossing_pairs_test
