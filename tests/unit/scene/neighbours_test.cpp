// Triangles of one object that share a vertex and meet elsewhere (`Neighbours::exact`).

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "supple/error.hpp"
#include "supple/inspection.hpp"
#include "supple/models.hpp"
#include "supple/scene.hpp"
#include "supple/verify.hpp"
#include "support/random.hpp"
#include "support/soups.hpp"

namespace supple::neighbours_test {

const ObjectOptions exact_neighbours{.self_collision = true, .neighbours = Neighbours::exact};

std::vector<TrianglePair> pairs_of(const DetectResult& result) {
  std::vector<TrianglePair> pairs;
  for (const Contact& contact : result.contacts) pairs.push_back({contact.triangle_a, contact.triangle_b});
  return pairs;
}

bool meet(const std::vector<Vec3d>& positions, const Triangle& a, const Triangle& b) {
  Scene scene;
  scene.add(positions, std::vector<Triangle>{a, b}, exact_neighbours);
  const bool found = !scene.detect().contacts.empty();
  EXPECT_TRUE(verify(scene).agrees());
  return found;
}

TEST(Neighbours, OfAFlatFanMeetWhereTheyFold) {
  const std::vector<Vec3d> p{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0.4, 0.2, 0}, {0.5, 0.25, 1}};
  EXPECT_FALSE(meet(p, {0, 1, 3}, {0, 3, 2})) << "neighbours in a plane";
  EXPECT_TRUE(meet(p, {0, 1, 2}, {0, 1, 3})) << "folded along the edge";
  EXPECT_TRUE(meet(p, {0, 1, 2}, {0, 4, 3})) << "a corner inside";
  EXPECT_FALSE(meet(p, {0, 1, 2}, {0, 1, 5})) << "an angle at the edge";
  EXPECT_TRUE(meet(p, {0, 1, 2}, {0, 4, 5})) << "an edge from the shared vertex in the other triangle";
  EXPECT_TRUE(meet(p, {0, 1, 2}, {2, 1, 0})) << "the same triangle twice";
}

TEST(Neighbours, ThatCrossMeet) {
  const std::vector<Vec3d> p{{0, 0, 0},     {1, 0, 0},   {0, 1, 0},   {0.3, 0.3, -1},
                             {0.3, 0.3, 1}, {-1, -1, 1}, {-1, -1, -1}};
  EXPECT_TRUE(meet(p, {0, 1, 2}, {0, 3, 4}));
  EXPECT_FALSE(meet(p, {0, 1, 2}, {0, 5, 6}));
  EXPECT_FALSE(meet(p, {0, 1, 1}, {0, 5, 6})) << "an edge as a triangle";
  EXPECT_TRUE(meet({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0.5, 0, 0}}, {0, 1, 2}, {0, 3, 3})) << "on one line";
  EXPECT_FALSE(meet({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {-1, 0, 0}}, {0, 1, 2}, {0, 3, 3}))
      << "away from each other";
}

/// Soups of few vertices, on a lattice and elsewhere, with flat and repeated triangles.
TEST(Neighbours, AgreeWithRationals) {
  RandomNumbers random(11);
  std::size_t found = 0;
#ifdef NDEBUG
  constexpr int rounds = 200;
#else
  constexpr int rounds = 48;
#endif
  for (int round = 0; round < rounds; ++round) {
    TriangleMesh mesh;
    const bool is_lattice = round % 2 == 0;
    for (int v = 0; v < 9; ++v) {
      Vec3d p = random.vector(1.5);
      if (is_lattice)
        p = {std::nearbyint(p.x), std::nearbyint(p.y), round % 4 == 0 ? 0 : std::nearbyint(p.z)};
      mesh.positions.push_back(std::ldexp(1.0, round % 3 == 0 ? 300 : 0) * p);
    }
    for (int t = 0; t < 14; ++t)
      mesh.triangles.push_back({random.below(9), random.below(9), random.below(9)});
    for (const std::uint32_t threads : {1u, 3u}) {
      Scene scene({.threads = threads});
      ObjectOptions options = exact_neighbours;
      options.octree.leaf_size = 2;
      scene.add(mesh, options);
      found += scene.detect().contacts.size();
      const VerifyReport report = verify(scene);
      EXPECT_TRUE(report.agrees()) << "round " << round << ": " << report.differences.size()
                                   << " differences";
    }
  }
  EXPECT_GT(found, static_cast<std::size_t>(5 * rounds));
}

TEST(Neighbours, OfASmoothSurfaceDoNotMeet) {
  for (const TriangleMesh& mesh : {make_icosphere(10), crumpled_sheet(20, 20, 0, 1)}) {
    Scene scene;
    scene.add(mesh, exact_neighbours);
    EXPECT_TRUE(scene.detect().contacts.empty());
  }
}

TEST(Neighbours, AreTheOnlyAdditions) {
  const TriangleMesh mesh = crumpled_sheet(12, 12, 0.3, 4);
  Scene plain, with;
  plain.add(mesh, {.self_collision = true});
  const ObjectId id = with.add(mesh, exact_neighbours);
  const std::vector<TrianglePair> all = pairs_of(with.detect()), apart = pairs_of(plain.detect());
  EXPECT_GT(all.size(), apart.size());
  EXPECT_TRUE(std::is_sorted(all.begin(), all.end()));
  EXPECT_TRUE(std::includes(all.begin(), all.end(), apart.begin(), apart.end()));
  EXPECT_TRUE(verify(with).agrees());
  DetectRequest request;
  request.max_contacts = all.size() / 2;
  const auto first = pairs_of(with.detect(request));
  EXPECT_EQ(first, std::vector(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(all.size() / 2)));
  std::vector<Vec3d> moved = mesh.positions;
  moved[5].x = std::numeric_limits<double>::quiet_NaN();
  with.set_positions(id, moved);
  with.detect();
  EXPECT_TRUE(verify(with).agrees());
  with.set_positions(id, mesh.positions);
  EXPECT_EQ(pairs_of(with.detect()), all);
}

}  // namespace supple::neighbours_test
