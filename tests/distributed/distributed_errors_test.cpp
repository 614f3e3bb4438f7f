// An error on one rank is the same error on all of them, and the scene stays usable.

#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>
#include <iterator>
#include <stop_token>
#include <string>

#include "random_lives.hpp"
#include "supple/distributed.hpp"
#include "supple/error.hpp"
#include "supple/models.hpp"
#include "support/random.hpp"

namespace supple {
namespace {

template <class Call>
std::string error_of(const Call& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(DistributedErrors, TheSameErrorOnAllRanks) {
  DistributedScene scene(MPI_COMM_WORLD, {.scene = {.threads = 1}});
  const TriangleMesh ball = make_icosphere(3);
  const int last = scene.rank_count() - 1;
  // An open surface that one rank declares solid, in parts, so that only the test of two objects can find it.
  const TriangleMesh cloth = make_cloth(4, 4);
  std::vector<std::uint32_t> vertices(cloth.positions.size()), triangles(cloth.triangles.size());
  for (std::uint32_t v = 0; v < vertices.size(); ++v) vertices[v] = v;
  for (std::uint32_t t = 0; t < triangles.size(); ++t) triangles[t] = t;
  if (scene.rank() == last) {
    scene.add(ObjectId{0}, ball.positions, ball.triangles);
    scene.add_part(ObjectId{1}, cloth.positions, cloth.triangles, {vertices, triangles},
                   {.name = "sail", .solid = true});
  }
  const std::string error = error_of([&] { scene.detect({.contacts = ContactKinds::penetration}); });
  EXPECT_NE(error.find("sail is no solid"), std::string::npos) << error;
  EXPECT_EQ(error.find("rank "), 0u) << error;
  EXPECT_FALSE(scene.detect().stopped);
}

TEST(DistributedErrors, AnObjectThatIsOnTwoRanks) {
  DistributedScene scene(MPI_COMM_WORLD, {.scene = {.threads = 1}});
  if (scene.rank_count() == 1) GTEST_SKIP() << "needs two ranks";
  const TriangleMesh ball = make_icosphere(2);
  if (scene.rank() < 2) scene.add(ObjectId{7}, ball.positions, ball.triangles, {.name = "ball"});
  const std::string error = error_of([&] { scene.detect(); });
  EXPECT_NE(error.find("ball is on the ranks 0 and 1; add it on one, or in parts with add_part"),
            std::string::npos)
      << error;
  if (scene.rank() == 1) scene.remove(ObjectId{7});
  EXPECT_EQ(scene.detect().step, 0u);
}

TEST(DistributedErrors, PartsWithOtherOptions) {
  DistributedScene scene(MPI_COMM_WORLD, {.scene = {.threads = 1}});
  if (scene.rank_count() == 1) GTEST_SKIP() << "needs two ranks";
  const std::vector<Vec3d> corners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  const std::vector<std::uint32_t> vertices{0, 1, 2}, face{static_cast<std::uint32_t>(scene.rank())};
  const std::vector<Triangle> triangle{{0, 1, 2}};
  scene.add_part(ObjectId{0}, corners, triangle, {vertices, face},
                 {.name = "sheet", .margin = scene.rank() == 0 ? 0.1 : 0.2});
  EXPECT_NE(error_of([&] { scene.detect(); }).find("sheet has other options on rank 1 than on rank 0"),
            std::string::npos);
}

TEST(DistributedErrors, OfCallsOfOneRank) {
  DistributedScene scene(MPI_COMM_WORLD, {.scene = {.threads = 1}});
  const TriangleMesh ball = make_icosphere(2);
  scene.add(ObjectId{static_cast<std::uint32_t>(scene.rank())}, ball.positions, ball.triangles);
  const ObjectId mine{static_cast<std::uint32_t>(scene.rank())}, other{1000};
  EXPECT_NE(
      error_of([&] { scene.add(mine, ball.positions, ball.triangles); }).find("is on this rank already"),
      std::string::npos);
  EXPECT_NE(error_of([&] { scene.set_positions(other, ball.positions); }).find("is not on this rank"),
            std::string::npos);
  EXPECT_NE(
      error_of([&] { scene.set_positions(mine, std::vector<Vec3d>(3)); }).find("3 positions for object"),
      std::string::npos);
  EXPECT_NE(error_of([&] { scene.add(other, ball.positions, ball.triangles, {.weld = true}); }).find("weld"),
            std::string::npos);
  const std::vector<Triangle> wrong{{0, 1, 99}};
  EXPECT_NE(error_of([&] { scene.add(other, std::vector<Vec3d>(3), wrong); }).find("uses vertex 99"),
            std::string::npos);
  const std::vector<std::uint32_t> vertices{0, 2, 1}, face{0};
  const std::vector<Triangle> triangle{{0, 1, 2}};
  EXPECT_NE(error_of([&] {
              scene.add_part(other, std::vector<Vec3d>(3), triangle, {vertices, face});
            }).find("number 2 is 1 after 2"),
            std::string::npos);
}

TEST(DistributedErrors, OptionsThatAreNotSupported) {
  const auto with = [](const DistributedOptions& options) {
    return error_of([&] { DistributedScene scene(MPI_COMM_WORLD, options); });
  };
  EXPECT_NE(with({.scene = {.bounding_volume = BoundingVolume::sphere}}), "");
  EXPECT_NE(with({.cluster_triangles = 0}), "");
  EXPECT_NE(with({.max_imbalance = 0.5}), "");
  DistributedScene scene(MPI_COMM_WORLD);
  EXPECT_NE(error_of([&] { scene.detect({.max_contacts = 3}); }), "");
  EXPECT_NE(
      error_of([&] {
        scene.detect({.contacts = ContactKinds::continuous, .continuous_listing = ContinuousListing::first});
      }),
      "");
}

TEST(DistributedErrors, OfSettingsAndSearches) {
  DistributedScene scene(MPI_COMM_WORLD, {.scene = {.threads = 1}});
  const TriangleMesh ball = make_icosphere(2);
  const ObjectId mine{static_cast<std::uint32_t>(scene.rank())};
  scene.add(mine, ball.positions, ball.triangles, {.name = "ball", .margin = 0.1});
  EXPECT_NE(
      error_of([&] { scene.set_options(mine, {.margin = -1}); }).find("set_options: ObjectOptions::margin"),
      std::string::npos);
  EXPECT_NE(error_of([&] { scene.set_options(ObjectId{77}, {.margin = 1}); }).find("is not on this rank"),
            std::string::npos);
  const std::vector<std::uint32_t> one{1};
  EXPECT_NE(error_of([&] { scene.set_vertex_groups(mine, one, one); }).find("1 numbers for ball"),
            std::string::npos);
  EXPECT_NE(error_of([&] { scene.collision_free_step({.keep = 2}); }).find("keep"), std::string::npos);
  EXPECT_NE(error_of([&] { scene.distances(-1); }).find("distances"), std::string::npos);
  std::vector<std::optional<ClosestPoint>> found(1);
  EXPECT_NE(error_of([&] { scene.closest({}, found); }).find("closest"), std::string::npos);
  EXPECT_NE(error_of([&] { scene.closest({}, {}, {.filter = {.object = ObjectId{99}}}); }).find("object 99"),
            std::string::npos);
  EXPECT_NE(error_of([&] { scene.closest({}, {}, {.signed_distance = true}); }).find("signed_distance"),
            std::string::npos);
  std::vector<std::uint32_t> bits(ball.positions.size(), 1);
  if (scene.rank() == 0) scene.set_vertex_groups(mine, bits, bits);
  EXPECT_NE(error_of([&] {
              scene.detect({.contacts = ContactKinds::penetration});
            }).find("rank 0: detect: penetration needs all intersections, but ball has vertex groups"),
            std::string::npos);
  EXPECT_EQ(scene.detect().step, 0u);
}

std::string bytes_of_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}
void write_file(const std::string& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

TEST(DistributedErrors, OfCheckpoints) {
  const std::string path = path_of_job("supple_bad_checkpoint");
  const auto error_of_load = [&](const std::string& file) {
    return error_of([&] { DistributedScene(MPI_COMM_WORLD).load(file); });
  };
  DistributedScene scene(MPI_COMM_WORLD, {.scene = {.threads = 1}});
  const TriangleMesh ball = make_icosphere(2);
  scene.add(ObjectId{static_cast<std::uint32_t>(scene.rank())}, ball.positions, ball.triangles);
  scene.detect();
  scene.save(path);
  EXPECT_NE(error_of([&] { scene.load(path); }).find("the scene has objects"), std::string::npos);
  EXPECT_NE(error_of([&] { scene.save("/no such folder/checkpoint"); }).find("/no such folder/checkpoint"),
            std::string::npos);
  EXPECT_NE(error_of_load(path + "_missing").find(path + "_missing: cannot be opened"), std::string::npos);
  const std::string bytes = bytes_of_file(path);
  MPI_Barrier(MPI_COMM_WORLD);  // before rank 0 writes others
  const auto with = [&](const std::string& changed) {
    if (scene.rank() == 0) write_file(path, changed);
    MPI_Barrier(MPI_COMM_WORLD);
    const std::string error = error_of_load(path);
    MPI_Barrier(MPI_COMM_WORLD);
    return error;
  };
  EXPECT_NE(with("").find("is no checkpoint"), std::string::npos);
  EXPECT_NE(with(std::string(bytes.size(), 'x')).find("is no checkpoint"), std::string::npos);
  EXPECT_NE(with(bytes.substr(0, bytes.size() - 1)).find("is cut off"), std::string::npos);
  EXPECT_NE(with(bytes + "x").find("is cut off or damaged"), std::string::npos);
  std::string later = bytes;
  later[8] = 7;
  EXPECT_NE(with(later).find("version 7"), std::string::npos);
  EXPECT_EQ(with(bytes), "");
  if (scene.rank() == 0) std::remove(path.c_str());
}

/// Checksums cover the whole file: a changed bit is an error, and so are changed bytes.
TEST(DistributedErrors, OfDamagedCheckpoints) {
  const std::string path = path_of_job("supple_damaged_checkpoint");
  if (rank_of_world() != 0) return;
  DistributedScene scene(MPI_COMM_SELF, {.scene = {.threads = 1}});
  const TriangleMesh box = make_box({1, 1, 1}, 1);
  scene.add(ObjectId{0}, box.positions, box.triangles, {.name = "box", .edges = {{0, 1}}, .points = {2}});
  scene.add(ObjectId{1}, box.positions, box.triangles, {.name = "other box"});
  scene.detect();
  scene.save(path);
  const std::string bytes = bytes_of_file(path);
  const auto error_with = [&](const std::string& damaged) {
    write_file(path, damaged);
    DistributedScene restarted(MPI_COMM_SELF, {.scene = {.threads = 1}});
    return error_of([&] { restarted.load(path); });
  };
  EXPECT_EQ(error_with(bytes), "");
  // All of the head, the table and the pairs at the end; every seventh byte of the objects.
  for (std::size_t i = 0; i < bytes.size(); i += i < 160 || i + 80 > bytes.size() ? 1 : 7) {
    std::string damaged = bytes;
    damaged[i] = static_cast<char>(damaged[i] ^ (1 << (i % 8)));
    ASSERT_NE(error_with(damaged), "") << "byte " << i << " of " << bytes.size();
  }
  RandomNumbers random(5);
  for (int i = 0; i < 400; ++i) {
    std::string damaged = bytes;
    for (int k = 0; k < 2; ++k)
      damaged[random.below(static_cast<std::uint32_t>(bytes.size()))] = static_cast<char>(random.below(256));
    if (damaged == bytes) continue;
    ASSERT_NE(error_with(damaged), "") << i;
  }
  std::remove(path.c_str());
}

/// One rank of several makes another call, with other arguments, or with other options.
TEST(DistributedErrors, OtherCallsOnOneRank) {
  const DistributedOptions of_last{.scene = {.threads = 2}, .results = ResultPlacement::spread};
  const DistributedOptions options{.scene = {.threads = 1}};
  if (size_of_world() == 1) GTEST_SKIP() << "needs two ranks";
  const int last = size_of_world() - 1;
  const bool is_last = rank_of_world() == last;
  const auto expect = [&](const std::string& difference, const auto& call) {
    EXPECT_EQ(error_of(call), difference.empty() ? ""
                                                 : "the ranks make different calls: on rank 0, " +
                                                       difference + "; give all ranks the same");
  };
  const std::string on_last = "; on rank " + std::to_string(last) + ", ";
  expect("results is gathered" + on_last + "results is spread",
         [&] { DistributedScene(MPI_COMM_WORLD, is_last ? of_last : options); });
  DistributedOptions separated = options;
  if (is_last) separated.scene.impact.min_separation = 0.5;
  expect("min_separation is 0" + on_last + "min_separation is 0.5",
         [&] { DistributedScene(MPI_COMM_WORLD, separated); });

  DistributedOptions threads = options;  // each rank has its own
  if (is_last) threads.scene.threads = 2;
  DistributedScene scene(MPI_COMM_WORLD, threads);
  const TriangleMesh ball = make_icosphere(3);
  const auto rank = static_cast<std::uint32_t>(scene.rank());
  scene.add(ObjectId{rank}, ball.positions, ball.triangles);
  const auto kinds = is_last ? ContactKinds::proximity : ContactKinds::intersection;
  expect("contacts is intersection" + on_last + "contacts is proximity",
         [&] { scene.detect({.contacts = kinds}); });
  const ImpactOptions impact{.min_separation = is_last ? 0.125 : 0.12};
  expect("min_separation is 0.12" + on_last + "min_separation is 0.125",
         [&] { scene.detect({.contacts = ContactKinds::continuous, .impact = impact}); });
  expect("keep is 0.5" + on_last + "keep is 0.25",
         [&] { scene.collision_free_step({.keep = is_last ? 0.25 : 0.5}); });
  expect("max_distance is 1" + on_last + "max_distance is 2", [&] { scene.distances(is_last ? 2 : 1); });
  expect("object is none" + on_last + "object is 0 (generation 0)", [&] {
    scene.closest({}, {}, {.filter = {.object = is_last ? std::optional(ObjectId{0}) : std::nullopt}});
  });
  expect("call is detect" + on_last + "call is earliest_impact", [&] {
    if (is_last)
      scene.earliest_impact();
    else
      scene.detect();
  });
  expect("path is a\\" + on_last + "path is b c", [&] { scene.save(is_last ? "b\nc" : "a\\"); });
  if (is_last) scene.set_pair_filter([](ObjectId, ObjectId) { return true; });
  expect("pair filter is none" + on_last + "pair filter is set", [&] { scene.detect(); });
  scene.set_pair_filter({});
  EXPECT_EQ(scene.detect().contacts.empty(), scene.rank() != 0);  // the scene stays usable
  expect("", [&] { scene.verify(); });
}

TEST(DistributedErrors, AStopOfDistancesIsAnErrorOnAllRanks) {
  DistributedScene scene(MPI_COMM_WORLD, {.scene = {.threads = 1}});
  const TriangleMesh ball = make_icosphere(3);
  scene.add(ObjectId{static_cast<std::uint32_t>(scene.rank())}, ball.positions, ball.triangles);
  std::stop_source stop;
  if (scene.rank() == scene.rank_count() - 1) stop.request_stop();
  EXPECT_EQ(error_of([&] { scene.distances(1, {stop.get_token()}); }),
            "rank " + std::to_string(scene.rank_count() - 1) +
                ": distances: it was stopped, so there is no answer");
  EXPECT_EQ(scene.distances(1).empty(), scene.rank() != 0 || scene.rank_count() == 1);
}

TEST(DistributedErrors, AStopOnOneRankStopsAll) {
  DistributedScene scene(MPI_COMM_WORLD, {.scene = {.threads = 1}});
  const TriangleMesh ball = make_icosphere(4);
  const auto rank = static_cast<std::uint32_t>(scene.rank());
  scene.add(ObjectId{2 * rank}, ball.positions, ball.triangles);
  scene.add(ObjectId{2 * rank + 1}, ball.positions, ball.triangles);
  EXPECT_EQ(scene.detect().step, 0u);
  std::stop_source stop;
  if (scene.rank() == scene.rank_count() - 1) stop.request_stop();
  const DetectResult& stopped = scene.detect({.stop = stop.get_token()});
  EXPECT_TRUE(stopped.stopped);
  EXPECT_TRUE(stopped.contacts.empty());
  const DetectResult& found = scene.detect();
  EXPECT_FALSE(found.stopped);
  EXPECT_EQ(found.step, 1u);
  EXPECT_EQ(found.contacts.empty(), scene.rank() != 0);
  EXPECT_TRUE(found.volume_events.begin.empty());  // the pairs of step 0 go on
  EXPECT_GT(found.stats.total_seconds, 0);
}

TEST(DistributedErrors, AnEmptySceneHasNoContacts) {
  DistributedScene scene(MPI_COMM_WORLD);
  EXPECT_TRUE(scene.detect().contacts.empty());
  EXPECT_FALSE(scene.earliest_impact().has_value());
  EXPECT_EQ(scene.max_step(), SafeStep{});
  EXPECT_EQ(scene.collision_free_step(), SafeStep{});
  EXPECT_TRUE(scene.distances(1).empty());
  std::vector<std::optional<ClosestPoint>> found(1, ClosestPoint{});
  scene.closest(std::vector<Vec3d>{{0, 0, 0}}, found);
  EXPECT_FALSE(found[0].has_value());
}

}  // namespace
}  // namespace supple
