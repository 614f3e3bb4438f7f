#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <vector>

#include "supple/error.hpp"
#include "supple/models.hpp"
#include "supple/scene.hpp"
#include "supple/topology.hpp"
#include "support/random.hpp"

namespace supple::parts_test {

using Ids = std::vector<std::uint32_t>;

TEST(Parts, AreOrderedByTheirSmallestVertices) {
  const TriangleMesh mesh{"mesh",
                          {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {4, 0, 0}, {5, 0, 0}, {6, 0, 0}},
                          {{6, 5, 1}, {2, 0, 4}, {1, 5, 6}}};
  const std::vector<MeshPart> parts = split_into_parts(mesh);
  ASSERT_EQ(parts.size(), 2u);
  EXPECT_EQ(parts[0].vertices, (Ids{0, 2, 4}));
  EXPECT_EQ(parts[0].triangles, (Ids{1}));
  EXPECT_EQ(parts[0].mesh.triangles, (std::vector<Triangle>{{1, 0, 2}}));
  EXPECT_EQ(parts[0].mesh.positions, (std::vector<Vec3d>{{0, 0, 0}, {2, 0, 0}, {4, 0, 0}}));
  EXPECT_EQ(parts[0].mesh.name, "mesh");
  EXPECT_EQ(parts[1].vertices, (Ids{1, 5, 6})) << "vertex 3 is in no part";
  EXPECT_EQ(parts[1].triangles, (Ids{0, 2}));
  EXPECT_EQ(parts[1].mesh.triangles, (std::vector<Triangle>{{2, 1, 0}, {0, 1, 2}}));
}

TEST(Parts, AreConnectedByEdgesAndPointsAloneAreParts) {
  TriangleMesh mesh;
  mesh.positions.resize(9);
  mesh.triangles = {{0, 1, 2}, {3, 4, 5}, {6, 6, 6}};
  mesh.edges = {{2, 3}};
  mesh.points = {8, 1};
  const std::vector<MeshPart> parts = split_into_parts(mesh);
  ASSERT_EQ(parts.size(), 3u);
  EXPECT_EQ(parts[0].vertices, (Ids{0, 1, 2, 3, 4, 5}));
  EXPECT_EQ(parts[0].mesh.edges, (std::vector<std::array<std::uint32_t, 2>>{{2, 3}}));
  EXPECT_EQ(parts[0].mesh.points, (Ids{1}));
  EXPECT_EQ(parts[1].vertices, (Ids{6})) << "a triangle with one vertex";
  EXPECT_EQ(parts[2].vertices, (Ids{8}));
  EXPECT_EQ(parts[2].mesh.points, (Ids{0}));
  EXPECT_TRUE(split_into_parts({}).empty());
  TriangleMesh wrong;
  wrong.points = {0};
  EXPECT_THROW(split_into_parts(wrong), Error);
}

TEST(Parts, WeldJoinsSeams) {
  const TriangleMesh quads{
      "", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}, {{0, 1, 2}, {3, 5, 4}}};
  EXPECT_EQ(split_into_parts(quads).size(), 2u);
  const std::vector<MeshPart> parts = split_into_parts(quads, true);
  ASSERT_EQ(parts.size(), 1u);
  EXPECT_EQ(parts[0].mesh.triangles, quads.triangles);
  EXPECT_EQ(parts[0].mesh.positions, quads.positions);
}

/// The parts of random meshes have the elements of the mesh, each once, and no two are connected.
TEST(Parts, AreThoseOfAFlood) {
  RandomNumbers random(5);
  for (int round = 0; round < 200; ++round) {
    TriangleMesh mesh;
    mesh.positions.resize(1 + random.below(60));
    const auto count = static_cast<std::uint32_t>(mesh.positions.size());
    for (std::uint32_t v = 0; v < count; ++v) mesh.positions[v].x = v;
    const auto vertex = [&] { return random.below(count); };
    for (std::uint32_t t = random.below(30); t > 0; --t)
      mesh.triangles.push_back({vertex(), vertex(), vertex()});
    std::vector<std::set<std::uint32_t>> near(count);
    for (const Triangle& t : mesh.triangles) {
      for (const std::uint32_t v : t) near[v].insert(t.begin(), t.end());
    }
    std::vector<Ids> expected;
    std::vector<bool> seen(count);
    for (std::uint32_t v = 0; v < count; ++v) {
      if (seen[v] || near[v].empty()) continue;
      Ids part{v};
      seen[v] = true;
      for (std::size_t i = 0; i < part.size(); ++i) {
        for (const std::uint32_t w : near[part[i]]) {
          if (!seen[w]) part.push_back(w);
          seen[w] = true;
        }
      }
      std::sort(part.begin(), part.end());
      expected.push_back(part);
    }
    const std::vector<MeshPart> parts = split_into_parts(mesh);
    ASSERT_EQ(parts.size(), expected.size());
    std::set<std::uint32_t> triangles;
    for (std::size_t p = 0; p < parts.size(); ++p) {
      EXPECT_EQ(parts[p].vertices, expected[p]);
      EXPECT_TRUE(std::is_sorted(parts[p].triangles.begin(), parts[p].triangles.end()));
      for (std::size_t t = 0; t < parts[p].triangles.size(); ++t) {
        const std::uint32_t whole = parts[p].triangles[t];
        EXPECT_TRUE(triangles.insert(whole).second);
        for (std::size_t i = 0; i < 3; ++i)
          EXPECT_EQ(parts[p].vertices[parts[p].mesh.triangles[t][i]], mesh.triangles[whole][i]);
      }
      for (std::size_t v = 0; v < parts[p].vertices.size(); ++v)
        EXPECT_EQ(parts[p].mesh.positions[v], mesh.positions[parts[p].vertices[v]]);
    }
    EXPECT_EQ(triangles.size(), mesh.triangles.size());
  }
}

TEST(FaultOfSolid, NamesWhatSceneAddRefuses) {
  TriangleMesh box = make_box({1, 1, 1});
  EXPECT_EQ(fault_of_solid(box), "");
  box.triangles.pop_back();
  EXPECT_NE(fault_of_solid(box).find("open"), std::string::npos);
  Scene scene;
  EXPECT_THROW(scene.add(box, {.solid = true}), Error);
  TriangleMesh soup;  // each triangle has vertices of its own
  const TriangleMesh closed = make_box({1, 1, 1});
  for (const Triangle& t : closed.triangles) {
    const auto first = static_cast<std::uint32_t>(soup.positions.size());
    for (const std::uint32_t v : t) soup.positions.push_back(closed.positions[v]);
    soup.triangles.push_back({first, first + 1, first + 2});
  }
  EXPECT_NE(fault_of_solid(soup), "");
  EXPECT_EQ(fault_of_solid(welded(soup)), "");
}

}  // namespace supple::parts_test
