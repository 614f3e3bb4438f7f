#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <vector>

#include "geometry/aabb.hpp"
#include "geometry/sphere.hpp"
#include "supple/error.hpp"
#include "supple/inspection.hpp"
#include "supple/models.hpp"
#include "supple/scene.hpp"
#include "support/configurations.hpp"
#include "support/soups.hpp"

namespace supple::node_pairs_test {

/// (level of the list, k and h of a, k and h of b).
using NamedPair = std::array<std::uint64_t, 5>;

std::set<NamedPair> names_of(const NodePairList& list) {
  std::set<NamedPair> names;
  for (std::uint32_t level = 0; level < list.level_count(); ++level) {
    for (const NodePairList::Pair& pair : list.pairs_of(level)) {
      const OctreeCell &a = list.nodes_a[pair.a], &b = list.nodes_b[pair.b];
      names.insert({level, a.level, a.number.value(), b.level, b.number.value()});
    }
  }
  return names;
}

/// All cells of an octree by number, read level by level.
std::map<std::uint64_t, OctreeCell> cells_by_number(const Scene& scene, ObjectId object) {
  const SceneInspector inspector(scene);
  std::map<std::uint64_t, OctreeCell> cells;
  for (std::uint32_t level = 0; level <= inspector.octree_depth(object); ++level) {
    for (const OctreeCell& cell : inspector.cells(object, level)) cells.emplace(cell.number.value(), cell);
  }
  return cells;
}

bool collide(const OctreeCell& a, const OctreeCell& b) {
  return a.sphere.empty() ? overlap(a.box, b.box) : overlap(a.sphere, b.sphere);
}

/// The cells of an octree and their children, by number.
struct Cells {
  std::map<std::uint64_t, OctreeCell> cells;
  std::map<std::uint64_t, std::vector<std::uint64_t>> children;

  /// The children of h are mh + 1 … mh + m. A node that shrank to one of its octants is below a number that
  /// no cell has.
  Cells(const Scene& scene, ObjectId object, std::uint64_t arity) : cells(cells_by_number(scene, object)) {
    for (const auto& [number, cell] : cells) {
      if (number == 0) continue;
      std::uint64_t parent = (number - 1) / arity;
      while (!cells.contains(parent)) parent = (parent - 1) / arity;
      children[parent].push_back(number);
      EXPECT_EQ(cells.at(parent).level + 1, cell.level);
    }
  }
  std::vector<std::uint64_t> next(std::uint64_t number) const {
    if (cells.at(number).is_leaf) return {number};
    EXPECT_GE(children.at(number).size(), 2u);
    return children.at(number);
  }
};

/// Figure 4 by recursion over the numbers.
void descend(const Cells& a, const Cells& b, std::uint64_t number_a, std::uint64_t number_b,
             std::uint64_t level, std::set<NamedPair>& found) {
  const OctreeCell &cell_a = a.cells.at(number_a), &cell_b = b.cells.at(number_b);
  if (!collide(cell_a, cell_b)) return;
  found.insert({level, cell_a.level, number_a, cell_b.level, number_b});
  if (cell_a.is_leaf && cell_b.is_leaf) return;
  for (const std::uint64_t child_a : a.next(number_a)) {
    for (const std::uint64_t child_b : b.next(number_b)) descend(a, b, child_a, child_b, level + 1, found);
  }
}

std::set<NamedPair> descent_of(const Scene& scene, ObjectId a, ObjectId b, std::uint64_t arity) {
  std::set<NamedPair> found;
  descend(Cells(scene, a, arity), Cells(scene, b, arity), 0, 0, 0, found);
  return found;
}

void check_order(const NodePairList& list) {
  for (const std::vector<OctreeCell>* const cells : {&list.nodes_a, &list.nodes_b}) {
    EXPECT_TRUE(std::ranges::is_sorted(*cells, {}, &OctreeCell::level));
    std::set<std::uint64_t> numbers;
    for (const OctreeCell& cell : *cells) numbers.insert(cell.number.value());
    EXPECT_EQ(numbers.size(), cells->size()) << "each cell once";
  }
  EXPECT_EQ(list.level_begin.front(), 0u);
  EXPECT_EQ(list.level_begin.back(), list.pairs.size());
  for (std::uint32_t level = 0; level < list.level_count(); ++level) {
    const auto pairs = list.pairs_of(level);
    EXPECT_TRUE(std::is_sorted(pairs.begin(), pairs.end()));
    EXPECT_FALSE(pairs.empty());
  }
}

TEST(NodePairs, AreThoseOfARecursiveDescent) {
  for (const BoundingVolume volume : {BoundingVolume::aabb, BoundingVolume::sphere}) {
    for (const ObjectOctreeOptions& octree : all_octrees()) {
      for (const std::uint32_t leaf_size : {1u, 5u}) {
        Scene scene({.bounding_volume = volume, .threads = 1});
        ObjectOptions options;
        options.octree = octree;
        options.octree.leaf_size = leaf_size;
        const ObjectId a = scene.add(random_soup(120, 1, 0.3, 1), options);
        const ObjectId b = scene.add(random_soup(9, 1, 0.3, 2), options);
        scene.detect();
        const NodePairList list = SceneInspector(scene).node_pairs(a, b);
        check_order(list);
        EXPECT_GT(list.level_count(), 2u);
        const std::set<NamedPair> names = names_of(list);
        EXPECT_EQ(names.size(), list.pairs.size());
        EXPECT_EQ(names, descent_of(scene, a, b, octree.arity));
      }
    }
  }
}

/// The levels of h begin at 0, 1, m + 1, m² + m + 1 and so on.
std::uint32_t level_of(std::uint64_t number, std::uint64_t arity) {
  std::uint32_t level = 0;
  for (std::uint64_t first = 0, count = 1; number >= first + count; ++level) {
    first += count;
    count *= arity;
  }
  return level;
}

TEST(NodePairs, NamesHaveTheLevelOfTheNumber) {
  for (const ObjectOctreeOptions& octree : all_octrees()) {
    Scene scene;
    ObjectOptions options{.octree = octree};
    options.octree.leaf_size = 1;
    // Most triangles are near one corner, so nodes of a regular octree shrink to octants.
    TriangleMesh mesh = random_soup(40, 1e-3, 1e-4, 8);
    for (Vec3d& p : mesh.positions) p += Vec3d{1, 1, 1};
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const Vec3d& p : {Vec3d{0, 0, 0}, Vec3d{0.01, 0, 0}, Vec3d{0, 0.01, 0}}) mesh.positions.push_back(p);
    mesh.triangles.push_back({first, first + 1, first + 2});
    const ObjectId a = scene.add(mesh, options), b = scene.add(mesh, options);
    scene.detect();
    std::size_t deeper = 0;
    for (const OctreeCell& cell : SceneInspector(scene).node_pairs(a, b).nodes_a) {
      EXPECT_EQ(cell.number_level, level_of(cell.number.value(), octree.arity));
      deeper += cell.number_level > cell.level ? 1 : 0;
    }
    EXPECT_EQ(deeper > 0, octree.build == ObjectOctreeBuild::regular);
  }
}

TEST(NodePairs, OfTheObjectsInTheOtherOrder) {
  Scene scene;
  const ObjectOptions options{.octree = {.leaf_size = 2}};
  const ObjectId a = scene.add(random_soup(50, 1, 0.4, 3), options);
  const ObjectId b = scene.add(random_soup(20, 1, 0.4, 4), options);
  scene.detect();
  const NodePairList list = SceneInspector(scene).node_pairs(b, a);
  check_order(list);
  std::set<NamedPair> turned;
  for (const auto& [level, level_b, number_b, level_a, number_a] : names_of(list))
    turned.insert({level, level_a, number_a, level_b, number_b});
  EXPECT_EQ(turned, names_of(SceneInspector(scene).node_pairs(a, b)));
}

/// The vertices of the triangles of all leaf pairs are the paper's output.
TEST(NodePairs, LeafPairsHoldTheCollidingVertices) {
  SceneOptions scene_options;
  scene_options.comparison.colliding_vertices = true;
  Scene scene(scene_options);
  const ObjectOptions options{.self_collision = true, .octree = {.leaf_size = 3}};
  const std::vector<TriangleMesh> meshes{random_soup(60, 1, 0.2, 5), random_soup(40, 1, 0.2, 6)};
  const std::vector<ObjectId> ids{scene.add(meshes[0], options), scene.add(meshes[1], options)};
  const DetectResult& result = scene.detect();
  ASSERT_EQ(result.colliding_vertex_groups.size(), 3u);
  const SceneInspector inspector(scene);
  for (const CollidingVertices& group : result.colliding_vertex_groups) {
    const NodePairList list = inspector.node_pairs(group.a, group.b);
    std::set<std::uint64_t> leaves_a, leaves_b;
    for (const NodePairList::Pair& pair : list.pairs) {
      if (!list.is_leaf_pair(pair)) continue;
      leaves_a.insert(*list.nodes_a[pair.a].number);
      leaves_b.insert(*list.nodes_b[pair.b].number);
    }
    const auto vertices_in = [&](ObjectId object, const std::set<std::uint64_t>& leaves) {
      const TriangleMesh& mesh = meshes[object == ids[0] ? 0 : 1];
      std::set<std::uint32_t> vertices;
      for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        if (leaves.contains(*inspector.leaf(object, t).number))
          vertices.insert(mesh.triangles[t].begin(), mesh.triangles[t].end());
      }
      return std::vector<std::uint32_t>(vertices.begin(), vertices.end());
    };
    const auto part = [&](std::uint32_t first, std::uint32_t count) {
      const auto all = result.colliding_vertices.subspan(first, count);
      return std::vector<std::uint32_t>(all.begin(), all.end());
    };
    EXPECT_EQ(vertices_in(group.a, leaves_a), part(group.first_vertex, group.count_a));
    EXPECT_EQ(vertices_in(group.b, leaves_b), part(group.first_vertex + group.count_a, group.count_b));
  }
}

TEST(NodePairs, OfSingleLeavesAreTheRoots) {
  Scene scene;
  const ObjectId a = scene.add(make_box({1, 1, 1})), b = scene.add(make_box({1, 1, 1}));
  scene.detect();
  const NodePairList list = SceneInspector(scene).node_pairs(a, b);
  ASSERT_EQ(list.pairs.size(), 1u);
  EXPECT_EQ(names_of(list), (std::set<NamedPair>{{0, 0, 0, 0, 0}}));
  EXPECT_TRUE(list.is_leaf_pair(list.pairs[0]));
  EXPECT_EQ(list.nodes_a[0].triangle_count, 12u);
}

TEST(NodePairs, AreNoneWhenTheBroadPhaseOrAFilterExcludesThePair) {
  Scene scene;
  const ObjectId a = scene.add(make_icosphere(4)), b = scene.add(make_icosphere(4));
  const SceneInspector inspector(scene);
  EXPECT_THROW(inspector.node_pairs(a, b), Error);
  scene.detect();
  EXPECT_FALSE(inspector.node_pairs(a, b).pairs.empty());
  EXPECT_EQ(inspector.node_pairs(a, a).level_count(), 0u) << "self-collision is off";
  scene.set_options(a, {.self_collision = true});
  scene.detect();
  EXPECT_GT(inspector.node_pairs(a, a).pairs.size(), inspector.node_pairs(a, b).level_count());
  scene.translate(b, {0, 5, 0});
  EXPECT_THROW(inspector.node_pairs(a, b), Error);
  scene.detect();
  EXPECT_EQ(inspector.node_pairs(a, b).level_count(), 0u);
  scene.translate(b, {0, -4, 0});
  scene.set_pair_filter([](ObjectId, ObjectId) { return false; });
  scene.detect();
  EXPECT_EQ(inspector.node_pairs(a, b).level_count(), 0u);
}

/// A translated object has the descent of an object with these positions.
TEST(NodePairs, OfTranslatedObjects) {
  const TriangleMesh ball = make_icosphere(8);
  const ObjectOptions options{.octree = {.leaf_size = 4}};
  Scene moved, placed;
  const ObjectId a = moved.add(ball, options), b = moved.add(ball, options);
  moved.translate(b, {1.5, 0.25, 0.125});
  TriangleMesh other = ball;
  for (Vec3d& p : other.positions) p += Vec3d{1.5, 0.25, 0.125};
  const ObjectId c = placed.add(ball, options), d = placed.add(ball, options);
  placed.set_positions(d, other.positions);
  moved.detect();
  placed.detect();
  const std::set<NamedPair> names = names_of(SceneInspector(moved).node_pairs(a, b));
  const std::set<NamedPair> expected = names_of(SceneInspector(placed).node_pairs(c, d));
  EXPECT_GT(expected.size(), 10u);
  EXPECT_TRUE(std::includes(names.begin(), names.end(), expected.begin(), expected.end()));
  EXPECT_LE(names.size(), expected.size() + 4) << "rounding adds few pairs";
}

/// The octants of the cube around the centres of the boxes of all triangles, by coordinates.
TEST(NodePairs, NumbersInARegularOctreeAreThoseOfTheOctants) {
  for (const std::uint32_t arity : {2u, 4u, 8u}) {
    const TriangleMesh mesh = random_soup(300, 1, 0.1, 7);
    Scene scene({.threads = 1});
    const ObjectId object =
        scene.add(mesh, {.octree = {.leaf_size = 1, .arity = arity, .build = ObjectOctreeBuild::regular}});
    scene.detect();
    std::vector<Vec3d> centres;
    Vec3d low{9, 9, 9}, high{-9, -9, -9};
    for (const Triangle& triangle : mesh.triangles) {
      Vec3d& centre = centres.emplace_back();
      for (int axis = 0; axis < 3; ++axis) {
        const auto [least, most] =
            std::minmax({mesh.positions[triangle[0]][axis], mesh.positions[triangle[1]][axis],
                         mesh.positions[triangle[2]][axis]});
        centre[axis] = 0.5 * (least + most);
        low[axis] = std::min(low[axis], centre[axis]);
        high[axis] = std::max(high[axis], centre[axis]);
      }
    }
    const double edge = std::max({high.x - low.x, high.y - low.y, high.z - low.z});
    const SceneInspector inspector(scene);
    std::uint64_t checked = 0;
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      const std::uint64_t number = inspector.leaf(object, t).number.value();
      std::vector<std::uint64_t> path;  // children, the last one first
      for (std::uint64_t h = number; h != 0; h = (h - 1) / arity) path.push_back((h - 1) % arity);
      Vec3d corner = low;
      std::array<double, 3> sides{edge, edge, edge};
      int halvings = 0;
      for (auto child = path.rbegin(); child != path.rend(); ++child) {
        // Bits from the highest to the lowest halve z, y, x in turn; an octant has one of each.
        for (std::uint32_t bit = arity / 2; bit != 0; bit /= 2, ++halvings) {
          const int axis = 2 - halvings % 3;
          double& side = sides[static_cast<std::size_t>(axis)];
          side /= 2;
          if ((*child & bit) != 0) corner[axis] += side;
        }
      }
      for (int axis = 0; axis < 3; ++axis) {
        EXPECT_GE(centres[t][axis], corner[axis] - 1e-5 * edge);
        EXPECT_LE(centres[t][axis], corner[axis] + sides[static_cast<std::size_t>(axis)] + 1e-5 * edge);
      }
      checked += path.size();
    }
    EXPECT_GT(checked, 3 * mesh.triangles.size());
  }
}

TEST(NodePairs, NumbersThatDoNotFitAreLeftOut) {
  // Each split takes off the triangle at the lower end, so the others are always in the second child.
  TriangleMesh mesh;
  double size = -1;
  for (std::uint32_t i = 0; i < 60; ++i, size *= 0.1) {
    mesh.positions.insert(mesh.positions.end(), {{size, 0, 0}, {size * 1.01, 0, 0}, {size, size * 0.01, 0}});
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  Scene scene;
  ObjectOptions options;
  options.octree = {.max_level = 32, .leaf_size = 1, .build = ObjectOctreeBuild::regular};
  const ObjectId object = scene.add(mesh, options);
  scene.detect();
  bool has_deep = false;
  for (const OctreeCell& cell : SceneInspector(scene).cells(object)) {
    // A factor of ten is more than three levels.
    EXPECT_TRUE(cell.number.has_value() || cell.level > 5) << cell.level;
    has_deep = has_deep || !cell.number.has_value();
  }
  EXPECT_TRUE(has_deep);
}

TEST(SceneRegions, OfAnObjectAreTheLeavesThatItsBoxTouches) {
  Scene scene({.broad_phase = BroadPhaseMethod::octree});
  std::vector<ObjectId> ids;
  for (std::uint64_t i = 0; i < 30; ++i) {
    const Vec3d at{std::fmod(0.37 * static_cast<double>(i), 1.0),
                   std::fmod(0.71 * static_cast<double>(i), 1.0),
                   std::fmod(0.13 * static_cast<double>(i), 1.0)};
    ids.push_back(scene.add(random_soup(3, 0.02, 0.01, i, at)));
  }
  scene.detect();
  const SceneInspector inspector(scene);
  std::map<std::uint64_t, std::uint32_t> counts;
  for (const ObjectId id : ids) {
    const Aabb box = inspector.bounds(id);
    std::set<std::uint64_t> expected, found;
    for (const SceneRegion& region : inspector.regions()) {
      if (region.is_leaf && overlap(region.box, box)) expected.insert(region.number);
    }
    for (const SceneRegion& region : inspector.regions(id)) found.insert(region.number);
    EXPECT_EQ(found, expected) << id.index;
    for (const std::uint64_t number : found) ++counts[number];
  }
  std::size_t levels = 0;
  for (const SceneRegion& region : inspector.regions()) {
    levels = std::max<std::size_t>(levels, region.level);
    EXPECT_EQ(counts[region.number], region.object_count) << "inner regions have no objects";
  }
  EXPECT_GT(levels, 1u);
  scene.remove(ids[0]);
  EXPECT_THROW(inspector.regions(ids[0]), Error);
}

}  // namespace supple::node_pairs_test
