// Brute force over all ranks gives the report of `verify`, wherever the contacts are.

#include <gtest/gtest.h>

#include <memory>
#include <stop_token>
#include <string>

#include "compare_results.hpp"
#include "random_lives.hpp"
#include "supple/distributed.hpp"
#include "supple/error.hpp"
#include "supple/models.hpp"
#include "supple/scene.hpp"
#include "supple/verify.hpp"

namespace supple {
namespace {

constexpr ContactKinds kinds_without_time =
    ContactKinds::intersection | ContactKinds::proximity | ContactKinds::penetration;

void expect_same_report(const VerifyReport& found, const VerifyReport& expected, const std::string& where) {
  for (const auto count :
       {&VerifyReport::triangle_pairs_checked, &VerifyReport::intersecting_pairs,
        &VerifyReport::touching_element_pairs, &VerifyReport::near_pairs, &VerifyReport::inside_vertices})
    EXPECT_EQ(found.*count, expected.*count) << where;
  // Vertices of no triangle are in no part.
  for (const auto count : {&VerifyReport::element_pairs_checked, &VerifyReport::proximity_pairs_checked,
                           &VerifyReport::vertex_triangle_pairs_checked}) {
    EXPECT_LE(found.*count, expected.*count) << where;
    EXPECT_EQ(found.*count > 0, expected.*count > 0) << where;
  }
  EXPECT_EQ(found.stopped, expected.stopped) << where;
  EXPECT_EQ(found.differences, expected.differences) << where;
  EXPECT_EQ(found.continuous_differences, expected.continuous_differences) << where;
  EXPECT_EQ(found.proximity_differences, expected.proximity_differences) << where;
  EXPECT_EQ(found.penetration_differences, expected.penetration_differences) << where;
}

DistributedOptions small_clusters(ResultPlacement placement) {
  DistributedOptions options;
  options.cluster_triangles = 16;
  options.scene.threads = 1;
  options.results = placement;
  return options;
}

/// Brute force decides continuous contacts by exact algebra, which takes long where many elements are close.
VerifyReport verify_lives(std::uint64_t seed, ContactKinds kinds, int objects, ResultPlacement placement) {
  VerifyReport sum;
  Lives lives(seed, small_clusters(placement));
  for (int i = 0; i < objects; ++i) lives.add_object(true);
  for (int step = 0; step < 2; ++step) {
    if (step == 1) lives.change_ranks();
    lives.move_objects(step == 1);
    lives.plain.detect({.contacts = kinds});
    lives.distributed.detect({.contacts = kinds});
    const VerifyReport found = lives.distributed.verify();
    EXPECT_TRUE(found.agrees());
    if (rank_of_world() == 0)
      expect_same_report(found, verify(lives.plain),
                         "seed " + std::to_string(seed) + " step " + std::to_string(step));
    sum.intersecting_pairs += found.intersecting_pairs;
    sum.touching_element_pairs += found.touching_element_pairs;
    sum.near_pairs += found.near_pairs;
    sum.inside_vertices += found.inside_vertices;
  }
  return sum;
}

TEST(DistributedVerify, EqualsOneScene) {
  std::uint64_t seed = 720, near_pairs = 0, inside_vertices = 0, intersecting_pairs = 0;
  for (const auto placement : {ResultPlacement::gathered, ResultPlacement::owner, ResultPlacement::spread}) {
    const VerifyReport sum = verify_lives(seed++, kinds_without_time, 4, placement);
    intersecting_pairs += sum.intersecting_pairs;
    inside_vertices += sum.inside_vertices;
    near_pairs += sum.near_pairs;
  }
  EXPECT_GT(intersecting_pairs, 0u);
  EXPECT_GT(inside_vertices, 0u);
  EXPECT_GT(near_pairs, 0u);
}

TEST(DistributedVerify, ContinuousContactsEqualOneScene) {
  const VerifyReport sum = verify_lives(710, ContactKinds::continuous, 3, ResultPlacement::owner);
  EXPECT_GT(sum.touching_element_pairs, 0u);
}

/// A filter that lets more pairs through for `verify` than it did for `detect`: their contacts are missed.
TEST(DistributedVerify, SaysWhatIsMissed) {
  Lives lives(720, small_clusters(ResultPlacement::spread));
  for (int i = 0; i < 5; ++i) lives.add_object(true);
  lives.move_objects(true);
  const auto is_open = std::make_shared<bool>(false);
  const PairFilter filter = [=](ObjectId a, ObjectId b) { return *is_open || (a.index + b.index) % 2 == 0; };
  lives.plain.set_pair_filter(filter);
  lives.distributed.set_pair_filter(filter);
  lives.plain.detect({.contacts = kinds_without_time});
  lives.distributed.detect({.contacts = kinds_without_time});
  *is_open = true;
  const VerifyReport expected = verify(lives.plain);
  EXPECT_GT(expected.differences.size(), 0u);
  EXPECT_GT(expected.proximity_differences.size(), 0u);
  EXPECT_GT(expected.penetration_differences.size(), 0u);
  expect_same_report(lives.distributed.verify(), expected, "");
}

TEST(DistributedVerify, NeedsTheResultOfDetect) {
  DistributedScene scene(MPI_COMM_WORLD, {.scene = {.threads = 1}});
  const TriangleMesh ball = make_icosphere(2);
  const ObjectId id{static_cast<std::uint32_t>(scene.rank())};
  scene.add(id, ball.positions, ball.triangles);
  const auto error = [&] {
    try {
      scene.verify();
    } catch (const Error& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  const char* const nothing = "verify: nothing was detected at the present positions";
  EXPECT_NE(error().find(nothing), std::string::npos);
  scene.detect();
  EXPECT_EQ(error(), "");
  EXPECT_EQ(error(), "");
  if (scene.rank() == scene.rank_count() - 1) scene.set_positions(id, ball.positions);
  EXPECT_NE(error().find(nothing), std::string::npos);
  scene.detect();
  scene.max_step();
  EXPECT_NE(error().find(nothing), std::string::npos);
  scene.detect({.contacts = ContactKinds::none});
  EXPECT_NE(error().find("searched no contacts"), std::string::npos);
}

TEST(DistributedVerify, AStopOnOneRankIsAStopOfAll) {
  DistributedScene scene(MPI_COMM_WORLD, {.scene = {.threads = 1}});
  const TriangleMesh ball = make_icosphere(2);
  for (std::uint32_t i = 0; i < 3; ++i)
    scene.add(ObjectId{3 * static_cast<std::uint32_t>(scene.rank()) + i}, ball.positions, ball.triangles);
  scene.detect();
  std::stop_source stop;
  if (scene.rank() == scene.rank_count() - 1) stop.request_stop();
  EXPECT_TRUE(scene.verify({stop.get_token()}).stopped);
  EXPECT_FALSE(scene.verify().stopped);
}

}  // namespace
}  // namespace supple
