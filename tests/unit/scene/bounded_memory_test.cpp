// The memory of contacts is proportional to what is listed: not to those that a limit leaves out, nor to the
// pairs of elements that have the same nearest features.

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "answers/impact/impact_pass.hpp"
#include "answers/intersection/intersection_pass.hpp"
#include "answers/proximity/proximity_pass.hpp"
#include "core/parallel.hpp"
#include "supple/scene.hpp"
#include "supple/trigonometry.hpp"
#include "world/object/world_object.hpp"

namespace supple::bounded_memory_test {

constexpr std::uint32_t spokes = 300;
constexpr std::uint64_t any_number = std::numeric_limits<std::uint64_t>::max();

/// Triangles around the first vertex. The edges of two fans are nearest at these vertices.
TriangleMesh make_fan(const Vec3d& apex, double height) {
  TriangleMesh fan{"", {apex}, {}};
  for (std::uint32_t i = 0; i < spokes; ++i) {
    const double turns = static_cast<double>(i) / spokes;
    fan.positions.push_back(apex + Vec3d{cos_turns(turns), sin_turns(turns), height});
    fan.triangles.push_back({0, 1 + i, 1 + (i + 1) % spokes});
  }
  return fan;
}

class Fans {
 public:
  Fans() : low_(add(make_fan({0, 0, 0}, -2))), high_(add(make_fan({0, 0, 1}, 2))) {
    for (WorldObject* const object : {&low_, &high_}) {
      const MovingShape& shape = object->moving();
      MovingObject& listed = listed_.emplace_back();
      listed.id = {static_cast<std::uint32_t>(listed_.size() - 1), 0};
      listed.view = object->moving_view();
      listed.start = &shape.start();
      listed.end = &shape.end();
      listed.triangle_ids = object->octree().triangle_ids();
      listed.vertex_ids = shape.elements().vertex_ids();
      listed.face_count = object->face_count();
      listed.margin = 0.51;
    }
  }
  std::span<const ProximityPair> near(ProximityPass& pass, ProximityListing listing,
                                      std::uint64_t max_pairs) const {
    StepStats stats;
    pass.run({jobs_, versions_, max_pairs, {}, Parallel(1)}, listed_, {listing}, stats);
    return pass.pairs();
  }
  std::span<const ContinuousContact> touching(ImpactPass& pass, ContinuousListing listing) const {
    StepStats stats;
    ImpactSearchOptions options;
    options.impact.min_separation = 1.02;
    options.listing = listing;
    pass.run({jobs_, versions_, any_number, {}, Parallel(1)}, listed_, options, stats);
    return pass.contacts();
  }

 private:
  static WorldObject add(const TriangleMesh& mesh) {
    WorldObject object(mesh.positions, mesh.triangles, {}, {}, {}, Parallel(1));
    object.move().set_positions(mesh.positions, Parallel(1));
    object.update({.moving = true}, Parallel(1));
    return object;
  }

  WorldObject low_, high_;
  std::vector<MovingObject> listed_;
  std::array<ContactJob, 1> jobs_{{{0, 1}}};
  std::array<std::uint64_t, 2> versions_{1, 2};
};

TEST(BoundedMemory, OfFeaturesIsThatOfTheList) {
  const Fans fans;
  ProximityPass pass;
  EXPECT_EQ(fans.near(pass, ProximityListing::features, any_number).size(), 1u);
  EXPECT_LT(pass.largest_buffer(), 100u);
}

TEST(BoundedMemory, OfTheFirstPairsIsLimited) {
  const Fans fans;
  ProximityPass all, some;
  const auto expected = fans.near(all, ProximityListing::elements, any_number);
  ASSERT_GT(expected.size(), std::size_t{spokes} * spokes);
  EXPECT_GE(all.largest_buffer(), expected.size());
  for (const std::uint64_t most : {0u, 1u, 1000u}) {
    const auto found = fans.near(some, ProximityListing::elements, most);
    EXPECT_TRUE(some.is_truncated());
    ASSERT_EQ(found.size(), most);
    EXPECT_TRUE(std::equal(found.begin(), found.end(), expected.begin()));
  }
  EXPECT_LE(some.largest_buffer(), 65536u);
  EXPECT_EQ(fans.near(some, ProximityListing::elements, any_number).size(), expected.size())
      << "the next search finds all";
}

TEST(BoundedMemory, OfFirstContactsIsThatOfTheElements) {
  const Fans fans;
  ImpactPass all, first;
  EXPECT_GT(fans.touching(all, ContinuousListing::all).size(), std::size_t{spokes} * spokes);
  const auto found = fans.touching(first, ContinuousListing::first);
  EXPECT_LT(found.size(), std::size_t{8 * spokes});
  EXPECT_LT(first.largest_buffer(), all.largest_buffer() / 3);
  EXPECT_GT(fans.touching(first, ContinuousListing::all).size(), std::size_t{spokes} * spokes)
      << "a list of all contacts does not reuse one of first contacts";
}

/// Triangles that all meet: around the z axis, with that axis inside or with one vertex in common.
TriangleMesh make_star(std::uint32_t count, bool has_common_vertex) {
  TriangleMesh star;
  for (std::uint32_t i = 0; i < count; ++i) {
    const double turns = 0.5 * i / count;
    const Vec3d way{cos_turns(turns), sin_turns(turns), 0};
    const auto size = static_cast<std::uint32_t>(star.positions.size());
    const std::uint32_t top = has_common_vertex ? 0 : size, below = top == size ? size + 1 : size;
    if (top == size) star.positions.push_back({0, 0, 2});
    star.positions.push_back(way + Vec3d{0, 0, -1});
    star.positions.push_back(Vec3d{0, 0, -1} - way);
    star.triangles.push_back({top, below, below + 1});
  }
  return star;
}

TEST(BoundedMemory, OfTheFirstIntersectionsIsLimited) {
  for (const bool has_common_vertex : {false, true}) {
    const TriangleMesh star = make_star(400, has_common_vertex);
    WorldObject object(star.positions, star.triangles, {},
                       {.self_collision = true, .neighbours = Neighbours::exact}, {}, Parallel(1));
    object.move().set_positions(star.positions, Parallel(1));
    object.update({.resting = true}, Parallel(1));
    const IntersectedObject listed{
        {0, 0}, object.resting_view(), &object.octree(), {}, &object.vertex_triangles()};
    const auto find = [&](IntersectionPass& pass, std::uint64_t most, std::uint32_t threads) {
      const ContactJob job{0, 0};
      const std::uint64_t version = 1;
      StepStats stats;
      pass.run({{&job, 1}, {&version, 1}, most, {}, Parallel(threads)}, {&listed, 1},
               {.colliding_vertices = false}, stats);
      return pass.contacts();
    };
    IntersectionPass all;
    const auto expected = find(all, any_number, 1);
    ASSERT_EQ(expected.size(), 400u * 399 / 2);
    EXPECT_GE(all.largest_buffer(), 2 * expected.size());
    for (const std::uint32_t threads : {1u, 3u}) {
      for (const std::uint64_t most : {0u, 1u, 1000u}) {
        IntersectionPass some;
        const auto found = find(some, most, threads);
        EXPECT_TRUE(some.is_truncated());
        ASSERT_EQ(found.size(), most);
        for (std::size_t i = 0; i < most; ++i) {
          ASSERT_EQ(found[i].triangle_a, expected[i].triangle_a);
          ASSERT_EQ(found[i].triangle_b, expected[i].triangle_b);
          const auto points = some.contact_points().subspan(found[i].first_point, found[i].point_count);
          ASSERT_TRUE(std::ranges::equal(
              points, all.contact_points().subspan(expected[i].first_point, expected[i].point_count)));
          ASSERT_EQ(found[i].normal, expected[i].normal);
        }
        EXPECT_LT(some.largest_buffer(), all.largest_buffer() / 3);
      }
    }
  }
}

}  // namespace supple::bounded_memory_test
