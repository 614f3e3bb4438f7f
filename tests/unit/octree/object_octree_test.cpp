#include "octree/object_octree.hpp"
#include "inspect/octree_statistics.hpp"
#include "inspect/validation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "support/random.hpp"
#include "support/scenes.hpp"

namespace supple::object_octree_test {

struct Soup {
  std::vector<Vec3d> positions;
  std::vector<Triangle> triangles;
};

/// Small triangles at random places on a sphere with the given radius around `center`.
Soup scattered_soup(std::uint32_t count, double radius, Vec3d center, std::uint32_t seed) {
  RandomNumbers random(seed);
  Soup soup;
  for (std::uint32_t t = 0; t < count; ++t) {
    Vec3d p = random.vector(1);
    p = p * (radius / std::sqrt(p.x * p.x + p.y * p.y + p.z * p.z + 1e-30)) + center;
    for (int corner = 0; corner < 3; ++corner) {
      soup.positions.push_back(p + random.vector(0.03 * radius));
    }
    soup.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
  }
  return soup;
}

struct Built {
  explicit Built(const Soup& soup, const ObjectOctreeOptions& options = {},
                 BoundingVolume volume = BoundingVolume::aabb)
      : octree(soup.positions, soup.triangles, options, volume, SphereFit::vertices) {}

  std::string refit(const Soup& soup, std::uint32_t threads = 1) {
    const Parallel parallel(threads);
    vertices.assign(soup.positions, parallel);
    octree.refit(vertices, {}, parallel);
    return fault_of(octree, vertices, {});
  }

  ObjectOctree octree;
  VertexBuffer vertices;
};

TEST(ObjectOctree, EmptyObject) {
  Built built(Soup{});
  EXPECT_EQ(built.refit(Soup{}), "");
  EXPECT_TRUE(built.octree.nodes().empty());
  EXPECT_TRUE(built.octree.box().empty());
}

TEST(ObjectOctree, StaysValidOverSizesAndOptions) {
  for (const std::uint32_t count : {1u, 2u, 8u, 9u, 100u, 5000u}) {
    for (const std::uint32_t leaf_size : {1u, 4u, 8u}) {
      for (const std::uint32_t max_level : {0u, 1u, 3u, 16u}) {
        for (const auto& [arity, build] : {std::pair{2u, ObjectOctreeBuild::regular},
                                           {4u, ObjectOctreeBuild::regular},
                                           {8u, ObjectOctreeBuild::regular},
                                           {8u, ObjectOctreeBuild::balanced},
                                           {2u, ObjectOctreeBuild::bottom_up},
                                           {4u, ObjectOctreeBuild::bottom_up},
                                           {8u, ObjectOctreeBuild::bottom_up}}) {
          const BoundingVolume volume =
              all_bounding_volumes[(count + leaf_size + max_level) % all_bounding_volumes.size()];
          const Soup soup = scattered_soup(count, 2, {1, 2, 3}, count);
          Built built(soup, {.max_level = max_level, .leaf_size = leaf_size, .arity = arity, .build = build},
                      volume);
          EXPECT_EQ(built.refit(soup), "") << count << ' ' << leaf_size << ' ' << max_level << ' ' << arity;
          const OctreeStatistics statistics = octree_statistics(built.octree);
          EXPECT_LE(statistics.depth, max_level * 3 / (arity == 8 ? 3 : arity == 4 ? 2 : 1));
          EXPECT_LE(statistics.mean_node_width, arity);
          if (max_level == 16) {
            EXPECT_LE(statistics.largest_leaf, leaf_size);
          }
        }
      }
    }
  }
}

TEST(ObjectOctree, TreesOfAnyArityEndInTheSameCells) {
  // With one triangle per leaf, every arity gives the same leaves in the same order; only the depth differs.
  const Soup soup = scattered_soup(3000, 1, {}, 12);
  Built eight(soup, {.leaf_size = 1, .build = ObjectOctreeBuild::regular});
  EXPECT_EQ(eight.refit(soup), "");
  std::uint32_t last_depth = octree_statistics(eight.octree).depth;
  std::uint64_t last_nodes = octree_statistics(eight.octree).nodes;
  for (const std::uint32_t arity : {4u, 2u}) {
    Built other(soup, {.leaf_size = 1, .arity = arity, .build = ObjectOctreeBuild::regular});
    EXPECT_EQ(other.refit(soup), "");
    const auto ids = other.octree.triangle_ids(), expected = eight.octree.triangle_ids();
    EXPECT_TRUE(std::equal(ids.begin(), ids.end(), expected.begin(), expected.end()));
    EXPECT_EQ(other.octree.box(), eight.octree.box());
    const OctreeStatistics statistics = octree_statistics(other.octree);
    EXPECT_EQ(statistics.leaves, 3000u);
    EXPECT_GT(statistics.depth, last_depth);
    EXPECT_GT(statistics.nodes, last_nodes);
    last_depth = statistics.depth;
    last_nodes = statistics.nodes;
  }
  EXPECT_EQ(last_nodes, 2999u) << "a binary tree has one node less than leaves";
}

TEST(ObjectOctree, LevelsOfAnyArityAreCountedInEights) {
  // A grid of 16³ cells with one triangle per cell: two levels of arity eight give 64 leaves of 4³ cells.
  Soup soup;
  std::uint32_t next = 0;
  for (int x = 0; x < 16; ++x)
    for (int y = 0; y < 16; ++y)
      for (int z = 0; z < 16; ++z) {
        soup.positions.insert(
            soup.positions.end(),
            {{x + 0.25, y + 0.25, z + 0.25}, {x + 0.5, y + 0.25, z + 0.25}, {x + 0.25, y + 0.5, z + 0.5}});
        soup.triangles.push_back({next, next + 1, next + 2});
        next += 3;
      }
  for (const std::uint32_t arity : {2u, 4u, 8u}) {
    Built built(soup, {.max_level = 2, .leaf_size = 1, .arity = arity, .build = ObjectOctreeBuild::regular});
    EXPECT_EQ(built.refit(soup), "");
    EXPECT_EQ(octree_statistics(built.octree).leaves, 64u) << arity;
    EXPECT_EQ(octree_statistics(built.octree).depth, arity == 8 ? 2u : arity == 4 ? 3u : 6u);
  }
}

TEST(ObjectOctree, RefitFollowsDeformation) {
  Soup soup = scattered_soup(3000, 1, {}, 7);
  Built built(soup);
  RandomNumbers random(3);
  for (int step = 0; step < 5; ++step) {
    for (Vec3d& p : soup.positions) p = p + random.vector(0.2);
    EXPECT_EQ(built.refit(soup, step % 2 == 0 ? 1 : 4), "");
  }
}

TEST(ObjectOctree, FloatAndDoublePositionsGiveTheSameBoxesForFloatValues) {
  Soup soup = scattered_soup(500, 1, {}, 8);
  std::vector<Vec3f> singles;
  for (Vec3d& p : soup.positions) {
    singles.push_back({static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)});
    p = {singles.back().x, singles.back().y, singles.back().z};
  }
  Built built(soup);
  EXPECT_EQ(built.refit(soup), "");
  const Aabb box = built.octree.box();
  const Parallel parallel(1);
  VertexBuffer vertices;
  vertices.assign(singles, parallel);
  EXPECT_FALSE(vertices.is_double());
  EXPECT_TRUE(built.octree.refit(vertices, {}, parallel));
  EXPECT_EQ(fault_of(built.octree, vertices, {}), "");
  EXPECT_EQ(built.octree.box(), box);
}

TEST(ObjectOctree, EqualCentresEndInOneLeafOfARegularTree) {
  Soup soup;
  for (std::uint32_t t = 0; t < 100; ++t) {
    soup.positions.insert(soup.positions.end(), {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
    soup.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
  }
  Built built(soup, {.build = ObjectOctreeBuild::regular});
  EXPECT_EQ(built.refit(soup), "");
  EXPECT_EQ(octree_statistics(built.octree).largest_leaf, 100u);
  EXPECT_EQ(octree_statistics(built.octree).depth, 0u);
  Built balanced(soup);
  EXPECT_EQ(balanced.refit(soup), "");
  EXPECT_EQ(octree_statistics(balanced.octree).leaves, 3u);
}

TEST(ObjectOctree, AFarVertexDoesNotFlattenTheRest) {
  for (const auto build :
       {ObjectOctreeBuild::balanced, ObjectOctreeBuild::regular, ObjectOctreeBuild::bottom_up}) {
    for (const double far : {1e6, 1e15, 1e30, 1e300}) {
      for (const std::size_t vertex : {0u, 3000u, 5999u}) {
        Soup soup = scattered_soup(2000, 1, {}, 5);
        soup.positions[vertex] = {far, -far, far};
        Built built(soup, {.build = build});
        EXPECT_EQ(built.refit(soup), "") << far;
        EXPECT_LE(octree_statistics(built.octree).largest_leaf, ObjectOctreeOptions{}.leaf_size) << far;
        EXPECT_LT(octree_statistics(built.octree).depth, build == ObjectOctreeBuild::regular ? 12u : 4u)
            << far;
      }
    }
  }
}

TEST(ObjectOctree, ExtremeScales) {
  for (const double scale : {1e-310, 1e-300, 1e-40, 1e-30, 1e30, 1e38, 1e39, 1e300}) {
    Soup soup = scattered_soup(300, 1, {}, 6);
    for (Vec3d& p : soup.positions) p = p * scale;
    for (const BoundingVolume volume : all_bounding_volumes) {
      Built built(soup, {}, volume);
      EXPECT_EQ(built.refit(soup), "") << scale;
    }
  }
}

TEST(ObjectOctree, InertTrianglesAreInNoBox) {
  Soup soup = scattered_soup(200, 1, {}, 9);
  soup.positions[30] = {std::numeric_limits<double>::quiet_NaN(), 1e9, 0};
  soup.positions[61] = {0, std::numeric_limits<double>::infinity(), 0};
  Built built(soup);
  const Parallel parallel(1);
  built.vertices.assign(soup.positions, parallel);
  EXPECT_FALSE(built.octree.refit(built.vertices, {}, parallel));
  std::vector<std::uint8_t> inert(200, 0);
  for (std::uint32_t t = 0; t < 200; ++t) {
    const std::uint32_t user = built.octree.triangle_ids()[t];
    inert[t] = user == 10 || user == 20;
  }
  EXPECT_TRUE(built.octree.refit(built.vertices, inert, parallel));
  EXPECT_EQ(fault_of(built.octree, built.vertices, inert), "");
  EXPECT_LT(built.octree.box().max.y, 2);
}

TEST(ObjectOctree, BorrowedPositionsGiveTheSameVolumes) {
  for (const std::uint32_t count : {1u, 9u, 200u, 5000u}) {
    Soup soup = scattered_soup(count, 2, {1, 2, 3}, count);
    soup.positions.push_back({100, 100, 100});  // not used by any triangle
    Built built(soup);
    ASSERT_EQ(built.refit(soup), "");
    const Aabb box = built.octree.box();
    VertexBuffer borrowed;
    borrowed.borrow(soup.positions);
    EXPECT_EQ(borrowed.bytes(), 0u);
    EXPECT_TRUE(built.octree.refit(borrowed, {}, Parallel(2)));
    EXPECT_EQ(fault_of(built.octree, borrowed, {}), "");
    EXPECT_EQ(built.octree.box(), box);
  }
}

TEST(ObjectOctree, TellsOfANonFiniteVertexOfAnyTriangle) {
  constexpr double inf = std::numeric_limits<double>::infinity();
  const Soup soup = [] {
    Soup result = scattered_soup(150, 1, {}, 21);
    result.positions.push_back({0, 0, 0});  // not used by any triangle
    return result;
  }();
  for (std::size_t vertex = 0; vertex < soup.positions.size(); vertex += 50) {
    for (const double wrong : {inf, -inf, std::numeric_limits<double>::quiet_NaN()}) {
      for (int axis = 0; axis < 3; ++axis) {
        for (const bool single : {false, true}) {
          Soup broken = soup;
          broken.positions[vertex][axis] = wrong;
          std::vector<Vec3f> singles;
          for (const Vec3d& p : broken.positions)
            singles.push_back({static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)});
          Built built(soup);
          if (single) {
            built.vertices.assign(singles, Parallel(1));
          } else {
            built.vertices.assign(broken.positions, Parallel(1));
          }
          const bool is_used = vertex + 1 < soup.positions.size();
          EXPECT_EQ(built.octree.refit(built.vertices, {}, Parallel(1)), !is_used) << vertex << ' ' << axis;
        }
      }
    }
  }
}

TEST(ObjectOctree, ValidateFindsAStaleBox) {
  Soup soup = scattered_soup(100, 1, {}, 10);
  Built built(soup);
  EXPECT_EQ(built.refit(soup), "");
  soup.positions[17].x += 5;  // outside every leaf
  built.vertices.assign(soup.positions, Parallel(1));
  EXPECT_NE(fault_of(built.octree, built.vertices, {}), "");
}

TEST(ObjectOctree, StridedPositions) {
  struct Particle {
    float mass;
    float position[3];
    int id;
  };
  const Soup soup = scattered_soup(50, 1, {}, 11);
  std::vector<Particle> particles;
  for (const Vec3d& p : soup.positions) {
    particles.push_back({1, {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)}, 0});
  }
  Built built(soup);
  built.vertices.assign(PositionsView(particles[0].position, particles.size(), sizeof(Particle)),
                        Parallel(1));
  for (std::uint32_t user = 0; user < particles.size(); ++user) {
    EXPECT_EQ(built.vertices[user].y, particles[user].position[1]);
  }
}

}  // namespace supple::object_octree_test
