// Meshes whose seams have several vertices at each place.

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "supple/error.hpp"
#include "supple/models.hpp"
#include "supple/option_descriptions.hpp"
#include "supple/scene.hpp"
#include "supple/verify.hpp"

namespace supple::weld_test {

/// Each triangle has its own vertices.
TriangleMesh split(const TriangleMesh& mesh) {
  TriangleMesh result{mesh.name, {}, {}};
  for (const Triangle& triangle : mesh.triangles) {
    const auto first = static_cast<std::uint32_t>(result.positions.size());
    for (const std::uint32_t vertex : triangle) result.positions.push_back(mesh.positions[vertex]);
    result.triangles.push_back({first, first + 1, first + 2});
  }
  return result;
}

TEST(Weld, MakesTheSidesOfASeamNeighbours) {
  const TriangleMesh ball = make_icosphere(3), pieces = split(ball);
  Scene scene({.contacts = ContactKinds::intersection | ContactKinds::proximity});
  scene.add(pieces, {.self_collision = true, .margin = 1e-3});
  EXPECT_GT(scene.detect().contacts.size(), pieces.triangles.size());
  EXPECT_FALSE(scene.result().proximity_pairs.empty());
  Scene welded({.contacts = ContactKinds::intersection | ContactKinds::proximity});
  const ObjectId id = welded.add(pieces, {.self_collision = true, .weld = true, .margin = 1e-3});
  EXPECT_TRUE(welded.detect().contacts.empty());
  EXPECT_TRUE(welded.result().proximity_pairs.empty());
  EXPECT_TRUE(verify(welded).agrees());
  // The first vertex of each place stands for all.
  welded.set_positions(id, pieces.positions);
  EXPECT_TRUE(welded.detect().contacts.empty());
}

TEST(Weld, ClosesASolid) {
  const TriangleMesh ball = make_icosphere(3), pieces = split(ball);
  Scene scene({.contacts = ContactKinds::penetration});
  EXPECT_THROW(scene.add(pieces, {.solid = true}), Error);
  const ObjectId outer = scene.add(pieces, {.weld = true, .solid = true});
  const ObjectId inner = scene.add(ball);
  std::vector<Vec3d> positions = ball.positions;
  for (Vec3d& p : positions) p = p * 0.5;
  scene.set_positions(inner, positions);
  EXPECT_EQ(scene.detect().penetrations.size(), ball.positions.size());
  ASSERT_EQ(scene.result().contained_parts.size(), 1u);
  EXPECT_EQ(scene.result().contained_parts[0].outer, outer);
  // The broad phase sees both objects.
  EXPECT_EQ(scene.detect({.contacts = ContactKinds::none}).object_pairs.size(), 1u);
}

TEST(Weld, KeepsVerticesThatAreNotFiniteApart) {
  TriangleMesh pieces = split(make_icosphere(1));
  for (std::size_t v : {3u, 7u}) pieces.positions[v].x = std::numeric_limits<double>::quiet_NaN();
  Scene scene;
  scene.add(pieces, {.self_collision = true, .weld = true});
  EXPECT_EQ(scene.detect().non_finite_vertices.size(), 2u);
}

TEST(Weld, NothingReadsTheVerticesThatWereReplaced) {
  const TriangleMesh pieces = split(make_icosphere(2));
  for (const auto kinds : {ContactKinds::intersection, ContactKinds::continuous, ContactKinds::proximity,
                           ContactKinds::penetration}) {
    Scene scene({.contacts = kinds});
    const ObjectId id = scene.add(pieces, {.weld = true, .margin = 0.1});
    scene.add(TriangleMesh{"triangle", {{0.9, 0, 0}, {3, 0, 0}, {3, 1, 0}}, {{0, 1, 2}}}, {.margin = 0.1});
    // The last vertex stands at the place of others, and the first one stands for itself.
    std::vector<Vec3d> positions = pieces.positions;
    positions.back().y = std::numeric_limits<double>::quiet_NaN();
    scene.set_positions(id, positions);
    EXPECT_TRUE(scene.detect().non_finite_vertices.empty()) << word_of(kinds);
    scene.set_motion(id, positions, positions);
    EXPECT_TRUE(scene.detect().non_finite_vertices.empty()) << word_of(kinds);
    positions.front().x = std::numeric_limits<double>::infinity();
    scene.set_positions(id, positions);
    ASSERT_EQ(scene.detect().non_finite_vertices.size(), 1u) << word_of(kinds);
    EXPECT_EQ(scene.result().non_finite_vertices[0].vertex, 0u);
  }
}

TEST(Weld, ByAMapIsThatOfEqualPositions) {
  const TriangleMesh ball = make_icosphere(3), pieces = split(ball);
  std::vector<std::uint32_t> same(pieces.positions.size());
  for (std::uint32_t v = 0; v < same.size(); ++v) {
    same[v] = static_cast<std::uint32_t>(
        std::find(pieces.positions.begin(), pieces.positions.end(), pieces.positions[v]) -
        pieces.positions.begin());
  }
  const ContactKinds kinds = ContactKinds::intersection | ContactKinds::proximity;
  Scene scene({.contacts = kinds}), welded({.contacts = kinds});
  const ObjectOptions options{.self_collision = true, .margin = 0.3};
  ObjectOptions by_map = options, by_position = options;
  by_map.same_vertex = same;
  by_position.weld = true;
  scene.add(pieces, by_map);
  welded.add(pieces, by_position);
  const auto pairs = scene.detect().proximity_pairs, expected = welded.detect().proximity_pairs;
  EXPECT_GT(pairs.size(), 0u);
  EXPECT_EQ(std::vector(pairs.begin(), pairs.end()), std::vector(expected.begin(), expected.end()));
}

}  // namespace supple::weld_test
