#include "narrow_phase/traversal.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <tuple>

#include "supple/triangle_intersection.hpp"
#include "support/option_word.hpp"
#include "support/scenes.hpp"
#include "support/soups.hpp"

namespace supple::traversal_test {

using PairSet = std::set<std::pair<std::uint32_t, std::uint32_t>>;

struct Object {
  Object(const TriangleMesh& mesh_in, const ObjectOctreeOptions& options, BoundingVolume volume)
      : mesh(mesh_in), octree(mesh.positions, mesh.triangles, options, volume, SphereFit::vertices) {
    const Parallel parallel(1);
    vertices.assign(mesh.positions, parallel);
    octree.refit(vertices, {}, parallel);
  }
  OctreeView view() const { return view_of(octree, vertices, {}, translation); }

  TriangleMesh mesh;
  ObjectOctree octree;
  VertexBuffer vertices;
  Vec3d translation;
};

/// Candidates in the user's numbering. Fails if a pair is found twice.
PairSet candidates(const Object& a, const Object& b, const ObjectPairView& pair, bool refined) {
  Traversal traversal;
  TraversalStats stats;
  std::vector<NodePair> roots{{}};
  for (int round = 0; round < (refined ? 3 : 0); ++round) {
    std::vector<NodePair> finer;
    for (const NodePair& root : roots) traversal.refine(pair, root, finer);
    roots = finer;
  }
  PairSet found;
  for (const NodePair& root : roots) {
    traversal.find_triangle_pairs(
        pair, root, stats, [](std::span<const LeafPair>) {},
        [&](std::span<const TrianglePair> batch) {
          for (const TrianglePair& p : batch) {
            std::uint32_t i = a.octree.triangle_ids()[p.a], j = b.octree.triangle_ids()[p.b];
            if (pair.same_object && i > j) std::swap(i, j);
            EXPECT_TRUE(found.insert({i, j}).second) << i << ' ' << j;
          }
        });
  }
  return found;
}

struct ExactBox {
  Vec3d min, max;
};

ExactBox box_of(const Object& object, std::uint32_t triangle) {
  ExactBox box{{1e308, 1e308, 1e308}, {-1e308, -1e308, -1e308}};
  for (const std::uint32_t vertex : object.mesh.triangles[triangle]) {
    const Vec3d p = object.mesh.positions[vertex] + object.translation;
    for (int axis = 0; axis < 3; ++axis) {
      box.min[axis] = std::min(box.min[axis], p[axis]);
      box.max[axis] = std::max(box.max[axis], p[axis]);
    }
  }
  return box;
}

/// All pairs whose exact boxes are within `slack` of each other.
PairSet overlapping_boxes(const Object& a, const Object& b, bool same_object, double slack) {
  PairSet pairs;
  std::vector<ExactBox> boxes_b;
  for (std::uint32_t j = 0; j < b.mesh.triangles.size(); ++j) boxes_b.push_back(box_of(b, j));
  for (std::uint32_t i = 0; i < a.mesh.triangles.size(); ++i) {
    const ExactBox p = box_of(a, i);
    for (std::uint32_t j = same_object ? i + 1 : 0; j < b.mesh.triangles.size(); ++j) {
      const ExactBox& q = boxes_b[j];
      bool overlap = true;
      for (int axis = 0; axis < 3 && overlap; ++axis) {
        overlap = p.min[axis] <= q.max[axis] + slack && q.min[axis] <= p.max[axis] + slack;
      }
      const auto& s = a.mesh.triangles[i];
      const auto& t = b.mesh.triangles[j];
      overlap =
          overlap && !(same_object && std::find_first_of(s.begin(), s.end(), t.begin(), t.end()) != s.end());
      if (overlap) pairs.insert({i, j});
    }
  }
  return pairs;
}

TrianglePoints points_of(const Object& object, std::uint32_t triangle) {
  const Triangle& corners = object.mesh.triangles[triangle];
  const auto at = [&](std::size_t i) { return object.mesh.positions[corners[i]] + object.translation; };
  return {at(0), at(1), at(2)};
}

/// Expects that no pair is missing and that every additional one is explained by rounding. All volumes but
/// boxes enclose the triangles but not the corners of their boxes, so with them only intersecting triangles
/// must be found.
void expect_candidates(const Object& a, const Object& b, bool same_object, double slack) {
  const OctreeView view = a.view();
  const ObjectPairView pair = same_object ? pair_of(view, view) : pair_of(view, b.view());
  PairSet must = overlapping_boxes(a, b, same_object, 0);
  if (a.octree.volumes() != nullptr)
    std::erase_if(must, [&](const auto& found) {
      return !triangles_intersect_by_axes(points_of(a, found.first), points_of(b, found.second));
    });
  const PairSet may = overlapping_boxes(a, b, same_object, slack);
  ASSERT_FALSE(must.empty());
  for (const bool refined : {false, true}) {
    const PairSet found = candidates(a, b, pair, refined);
    EXPECT_TRUE(std::includes(found.begin(), found.end(), must.begin(), must.end()));
    EXPECT_TRUE(std::includes(may.begin(), may.end(), found.begin(), found.end()));
  }
}

struct TraversalTest
    : testing::TestWithParam<std::tuple<OptionWord<BoundingVolume>, std::uint32_t, std::uint32_t>> {
  BoundingVolume volume() const { return std::get<0>(GetParam()); }
  ObjectOctreeOptions options() const {
    return {.max_level = std::get<1>(GetParam()), .leaf_size = std::get<2>(GetParam())};
  }
};

TEST_P(TraversalTest, TwoObjects) {
  const Object a(random_soup(400, 1, 0.1, 1), options(), volume());
  const Object b(random_soup(300, 1, 0.15, 2, {0.3, 0, 0}), options(), volume());
  expect_candidates(a, b, false, 1e-6);
}

TEST_P(TraversalTest, ObjectsOfVeryDifferentDepth) {
  const Object a(random_soup(3, 1, 1, 3), options(), volume());
  const Object b(random_soup(700, 0.7, 0.1, 4), options(), volume());
  expect_candidates(a, b, false, 1e-6);
  expect_candidates(b, a, false, 1e-6);
}

TEST_P(TraversalTest, ObjectWithItself) {
  const Object sheet(crumpled_sheet(15, 14, 0.05, 5), options(), volume());
  expect_candidates(sheet, sheet, true, 1e-6);
}

TEST_P(TraversalTest, TranslatedObjects) {
  Object a(random_soup(300, 1, 0.1, 6), options(), volume());
  Object b(random_soup(300, 1, 0.1, 7), options(), volume());
  for (const Vec3d far : {Vec3d{0, 0, 0}, Vec3d{1e3, -20, 5}, Vec3d{1e8, 1e8, -1e8}, Vec3d{3e15, 0, 0}}) {
    a.translation = far;
    b.translation = far + Vec3d{0.4, -0.3, 0.01};
    expect_candidates(a, b, false, 1e-5 + 4 * std::abs(far.x) * 0x1p-50);
    expect_candidates(a, a, true, 1e-6 + 4 * std::abs(far.x) * 0x1p-50);
  }
}

INSTANTIATE_TEST_SUITE_P(VolumesAndShapes, TraversalTest,
                         testing::Combine(testing::ValuesIn(option_words(all_bounding_volumes)),
                                          testing::Values(0u, 2u, 16u), testing::Values(1u, 4u, 9u)));

}  // namespace supple::traversal_test
