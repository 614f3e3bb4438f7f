// Edges and points of no triangle: rods and particles.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "supple/error.hpp"
#include "supple/inspection.hpp"
#include "supple/scene.hpp"
#include "supple/verify.hpp"
#include "support/hard_scenes.hpp"
#include "support/random.hpp"

namespace supple::extra_elements_test {

using Edges = std::vector<std::array<std::uint32_t, 2>>;
constexpr ContactKinds both = ContactKinds::continuous | ContactKinds::proximity;

/// A triangle soup with rods and particles that share some of its vertices.
TriangleMesh mixed(RandomNumbers& random, std::size_t triangles, ObjectOptions& options, double lattice) {
  constexpr std::uint32_t vertices = 30;
  TriangleMesh mesh;
  for (std::uint32_t v = 0; v < vertices; ++v) {
    Vec3d p = random.vector(1);
    if (lattice > 0)
      p = {std::nearbyint(p.x * lattice), std::nearbyint(p.y * lattice), std::nearbyint(p.z * lattice)};
    mesh.positions.push_back(p);
  }
  const auto corner = [&] { return random.below(vertices); };
  for (std::size_t t = 0; t < triangles; ++t) mesh.triangles.push_back({corner(), corner(), corner()});
  for (int i = 0; i < 8; ++i) {
    const std::uint32_t v = corner(), w = corner();
    if (v != w) options.edges.push_back({v, w});
    options.points.push_back(corner());
  }
  return mesh;
}

TEST(ExtraElements, AgreeWithBruteForce) {
#ifdef NDEBUG
  constexpr int rounds = 60;
#else
  constexpr int rounds = 12;
#endif
  RandomNumbers random(7);
  for (int round = 0; round < rounds; ++round) {
    const double lattice = round % 3 == 0 ? 2 : 0;
    const double margin = lattice > 0 ? 0.5 : 0.1;
    SceneOptions options{.contacts = both};
    options.impact.min_separation = round % 2 == 0 ? 0.1 : 0;
    options.proximity_listing = round % 4 < 2 ? ProximityListing::features : ProximityListing::elements;
    Scene scene(options);
    for (int object = 0; object < 2; ++object) {
      ObjectOptions of_object{.self_collision = true, .margin = margin, .octree = {.leaf_size = 2}};
      const TriangleMesh mesh = mixed(random, static_cast<std::size_t>(round % 5), of_object, lattice);
      const ObjectId id = scene.add(mesh, of_object);
      std::vector<Vec3d> to = mesh.positions;
      for (Vec3d& p : to)
        p = p + (lattice > 0 ? Vec3d{1.0 * random.between(-1, 1), 0, 0} : random.vector(0.3));
      if (object == 0 || round % 5 != 0) scene.set_motion(id, mesh.positions, to);
    }
    const DetectResult& result = scene.detect();
    EXPECT_GT(result.proximity_pairs.size(), 0u);
    const VerifyReport report = verify(scene);
    EXPECT_TRUE(report.agrees()) << "round " << round << ": " << report.continuous_differences.size() << ", "
                                 << report.proximity_differences.size() << " differences";
    EXPECT_EQ(SceneInspector(scene).validate(), "");
  }
}

/// The same rods and particles, and faces, in the results of other kinds and queries.
TEST(ExtraElements, AreNoTriangles) {
  TriangleMesh plate;
  plate.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.2, 0.2, -1}, {0.2, 0.2, 1}, {0.3, 0.3, 0}};
  plate.triangles = {{0, 1, 2}};
  SceneOptions options{.contacts = ContactKinds::intersection};
  Scene scene(options);
  const ObjectId with = scene.add(plate, {.self_collision = true, .edges = {{3, 4}}, .points = {5}});
  TriangleMesh other = plate;
  for (Vec3d& p : other.positions) p.z += 0.5;
  const ObjectId rod_only = scene.add(other.positions, std::vector<Triangle>{}, {.edges = {{3, 4}}});
  EXPECT_EQ(scene.triangle_count(with), 1u);
  EXPECT_EQ(scene.triangle_count(rod_only), 0u);
  EXPECT_TRUE(scene.detect().contacts.empty());
  EXPECT_TRUE(verify(scene).agrees());
  std::array<std::optional<ClosestPoint>, 1> closest;
  scene.closest(std::array{Vec3d{0.2, 0.2, 0.9}}, closest);
  ASSERT_TRUE(closest[0]);
  EXPECT_EQ(closest[0]->triangle, 0u);
  EXPECT_DOUBLE_EQ(closest[0]->distance, 0.9);
  std::array<std::optional<RayHit>, 1> hits;
  scene.cast(std::array{Ray{{0.2, 0.2, 5}, {0, 0, -1}}}, hits);
  ASSERT_TRUE(hits[0]);
  EXPECT_EQ(hits[0]->t, 5);
  EXPECT_EQ(scene.distance(with, rod_only)->distance, 0) << "distances see rods";
}

TEST(ExtraElements, OfAParticleThatFallsOnAPlateAndARod) {
  SceneOptions options{.contacts = ContactKinds::continuous};
  options.impact.min_separation = 0.1;
  Scene scene(options);
  const std::vector<Vec3d> start{{0, 0, 1}}, end{{0, 0, -1}};
  const ObjectId particle = scene.add(start, std::vector<Triangle>{}, {.points = {0}});
  const std::vector<Vec3d> rod_ends{{-1, 0, 0}, {1, 0, 0}};
  const ObjectId rod = scene.add(rod_ends, std::vector<Triangle>{}, {.edges = {{1, 0}}});
  scene.set_motion(particle, start, end);
  const auto contacts = scene.detect().continuous_contacts;
  ASSERT_EQ(contacts.size(), 1u);
  const ContinuousContact& contact = contacts[0];
  EXPECT_EQ(contact.kind, ElementPairKind::vertex_edge);
  EXPECT_EQ(contact.element_b, (std::array{0u, 1u}));
  EXPECT_NEAR(contact.toi, 0.45, 1e-6);
  EXPECT_NEAR(contact.normal.z, 1, 1e-12);
  EXPECT_NEAR(contact.barycentric_b[0], 0.5, 1e-12);
  EXPECT_NEAR(contact.barycentric_b[1], 0.5, 1e-12);
  EXPECT_EQ(scene.vertices_of(contact, ContactSide::b).size(), 2u);
  EXPECT_EQ(scene.vertices_of(contact, ContactSide::a).size(), 1u);
  scene.remove(rod);
  const ObjectId other =
      scene.add(std::vector<Vec3d>{{0, 0.05, 0}}, std::vector<Triangle>{}, {.points = {0}});
  const auto of_points = scene.detect().continuous_contacts;
  ASSERT_EQ(of_points.size(), 1u);
  EXPECT_EQ(of_points[0].kind, ElementPairKind::vertex_vertex);
  EXPECT_EQ(of_points[0].object_b, other);
  EXPECT_GT(of_points[0].normal.z, 0.8);
}

TEST(ExtraElements, FollowTheirWeldedVerticesAndVerticesThatAreNotFinite) {
  SceneOptions options{.contacts = ContactKinds::proximity};
  Scene scene(options);
  std::vector<Vec3d> rod{{0, 0, 0}, {1, 0, 0}, {1, 0, 0}, {1, 1, 0}};
  const ObjectId id =
      scene.add(rod, std::vector<Triangle>{},
                {.self_collision = true, .weld = true, .edges = {{0, 1}, {2, 3}}, .margin = 0.1});
  EXPECT_TRUE(scene.detect().proximity_pairs.empty()) << "the rods share a vertex";
  const ObjectId particle =
      scene.add(std::vector<Vec3d>{{0.5, 0.1, 0}}, std::vector<Triangle>{}, {.points = {0}, .margin = 0});
  EXPECT_EQ(scene.detect().proximity_pairs.size(), 1u);
  rod[0].y = std::numeric_limits<double>::infinity();
  scene.set_positions(id, rod);
  EXPECT_TRUE(scene.detect().proximity_pairs.empty());
  ASSERT_EQ(scene.result().non_finite_vertices.size(), 1u);
  EXPECT_EQ(scene.result().non_finite_vertices[0].object, id);
  scene.translate(particle, {0, 10, 0});
  EXPECT_NO_THROW(scene.detect());
}

/// Those of the mesh and those of the options.
TEST(ExtraElements, OfAMesh) {
  TriangleMesh mesh;
  mesh.name = "rods";
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}};
  mesh.edges = {{0, 1}};
  mesh.points = {2};
  Scene scene({.contacts = ContactKinds::proximity});
  scene.add(mesh, {.edges = {{2, 3}}, .points = {1}, .margin = 0.125});
  const std::vector<Vec3d> particles{{0.5, 0.25, 0}, {2.5, 0.25, 0}, {1.5, 0.25, 0}};
  scene.add(particles, std::vector<Triangle>{}, {.points = {0, 1, 2}, .margin = 0.125});
  const auto pairs = scene.detect().proximity_pairs;
  ASSERT_EQ(pairs.size(), 2u);
  EXPECT_EQ(pairs[0].element_a, (std::array{0u, 1u}));
  EXPECT_EQ(pairs[1].element_a, (std::array{2u, 3u}));
  EXPECT_TRUE(verify(scene).agrees());
  mesh.edges = {{0, 9}};
  EXPECT_THROW(scene.add(mesh), Error);
}

TEST(ExtraElements, RefuseIdsThatAreNoVertices) {
  Scene scene;
  const std::vector<Vec3d> points{{0, 0, 0}, {1, 0, 0}};
  const auto add = [&](const ObjectOptions& options) { scene.add(points, std::vector<Triangle>{}, options); };
  EXPECT_THROW(add({.edges = {{0, 2}}}), Error);
  EXPECT_THROW(add({.edges = {{1, 1}}}), Error);
  EXPECT_THROW(add({.points = {2}}), Error);
  EXPECT_THROW(add({.weld = true, .same_vertex = {0, 0}}), Error);
  EXPECT_THROW(add({.same_vertex = {0}}), Error);
  EXPECT_THROW(add({.same_vertex = {1, 0}}), Error);
  EXPECT_THROW(add({.same_vertex = {0, 5}}), Error);
  EXPECT_NO_THROW(add({.same_vertex = {0, 0}, .edges = {{0, 1}}}));
}

}  // namespace supple::extra_elements_test
