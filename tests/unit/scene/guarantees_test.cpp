// What docs/guarantees.md says, besides the tests of safe steps.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <tuple>
#include <vector>

#include "supple/scene.hpp"
#include "support/hard_scenes.hpp"
#include "support/random.hpp"

namespace supple::guarantees_test {

/// A vertex over a floor that a solver moves down by 1 in each frame. Once it is near, a constraint keeps
/// `distance_of` the present distance. Returns the distance after some frames.
template <class DistanceOf>
double distance_after(int frames, double keep, const DistanceOf& distance_of) {
  const auto constraint = [&](double distance) { return distance < 0.5 ? distance_of(distance) : 0; };
  TriangleMesh floor, needle;
  floor.positions = {{-9, -9, 0}, {9, -9, 0}, {0, 9, 0}};
  floor.triangles = {{0, 1, 2}};
  needle.positions = {{0, 0, 1}};
  Scene scene({.contacts = ContactKinds::continuous});
  scene.add(floor, {.is_static = true});
  const ObjectId id = scene.add(needle, {.points = {0}});
  double height = 1;
  for (int frame = 0; frame < frames; ++frame) {
    const double wanted = std::max(height - 1, constraint(height));
    scene.set_motion(id, std::array{Vec3d{0, 0, height}}, std::array{Vec3d{0, 0, std::min(wanted, height)}});
    height += (std::min(wanted, height) - height) * scene.collision_free_step({.keep = keep}).step;
    // The constraint moves it apart after the step.
    height = std::max(height, constraint(height));
  }
  return height;
}

TEST(GuaranteesForSolvers, LimitedPairsMustBePushedApart) {
  static constexpr double thickness = 0.25;
  const double keep = 0.2;
  const double unpushed = distance_after(10, keep, [](double) { return 0.0; });
  EXPECT_GT(unpushed, 0);
  EXPECT_NEAR(unpushed / std::pow(keep, 10), 1, 1e-3) << "each step keeps a fifth of the rest";
  // The first step cuts the distance below the thickness. Where the constraint keeps what is left, it stays.
  EXPECT_NEAR(distance_after(20, keep, [](double d) { return std::min(thickness, d); }), keep, 1e-4);
  EXPECT_NEAR(distance_after(20, keep, [](double d) { return std::min(thickness, d + thickness / 8); }),
              thickness, 1e-12);
}

/// Some needles over a floor fall in steps of 1, the first of them from just above the floor. Returns how far
/// the last one falls in some frames.
double fall_of_last(int frames, bool by_islands, bool pushes_apart) {
  constexpr double thickness = 0x1p-6;
  TriangleMesh floor, needle;
  floor.positions = {{-99, -99, 0}, {99, -99, 0}, {0, 99, 0}};
  floor.triangles = {{0, 1, 2}};
  needle.positions = {{0, 0, 0}};
  Scene scene({.contacts = ContactKinds::continuous});
  scene.add(floor, {.is_static = true});
  std::vector<ObjectId> ids;
  std::vector<Vec3d> places;
  for (int i = 0; i < 4; ++i) {
    ids.push_back(scene.add(needle, {.points = {0}}));
    places.push_back({static_cast<double>(i), 0, i < 3 ? thickness / (i + 1) : 1e3});
  }
  for (int frame = 0; frame < frames; ++frame) {
    std::vector<Vec3d> to = places;
    for (std::size_t i = 0; i < places.size(); ++i) {
      const bool is_near = places[i].z < 2 * thickness;
      to[i].z = pushes_apart && is_near ? std::max(places[i].z, thickness) : places[i].z - 1;
      scene.set_motion(ids[i], std::array{places[i]}, std::array{to[i]});
    }
    const double all = scene.collision_free_step().step;
    std::vector<double> step(places.size(), all);
    if (by_islands) {
      for (const ObjectStep& of : scene.collision_free_steps()) {
        const auto found = std::find(ids.begin(), ids.end(), of.object);
        if (found != ids.end()) step[static_cast<std::size_t>(found - ids.begin())] = of.safe.step;
      }
    }
    for (std::size_t i = 0; i < places.size(); ++i) places[i] += step[i] * (to[i] - places[i]);
  }
  for (const Vec3d& place : places) EXPECT_GT(place.z, 0);
  return 1e3 - places.back().z;
}

TEST(GuaranteesForSolvers, OneStepForAllStopsAPile) {
  EXPECT_LT(fall_of_last(30, false, false), 0x1p-6);
  EXPECT_EQ(fall_of_last(30, true, false), 30);
  EXPECT_EQ(fall_of_last(30, true, true), 30);
  // One pair that is left is enough to stop all; here none is.
  EXPECT_EQ(fall_of_last(30, false, true), 30);
}

using Pair = std::tuple<std::uint32_t, std::uint32_t, FeatureKind, FeatureKind, std::array<std::uint32_t, 2>,
                        std::array<std::uint32_t, 2>>;

std::set<Pair> near_elements(Scene& scene) {
  std::set<Pair> found;
  for (const ProximityPair& pair : scene.detect().proximity_pairs)
    found.insert(
        {pair.object_a.index, pair.object_b.index, pair.kind_a, pair.kind_b, pair.element_a, pair.element_b});
  return found;
}

/// What is nearer than the thickness after a motion was within thickness + approach before it.
TEST(GuaranteesForSolvers, MarginsListEveryPairThatComesNear) {
  RandomNumbers random(3);
  std::size_t near = 0;
  for (int round = 0; round < 20; ++round) {
    const double thickness = 0.05, longest = 0.1;
    std::vector<TriangleMesh> sheets{crumpled_sheet(3, 3, 0.2, random.bits()),
                                     crumpled_sheet(3, 3, 0.2, random.bits())};
    const auto scene_with = [&](double reach) {
      Scene scene({.contacts = ContactKinds::proximity, .proximity_listing = ProximityListing::elements});
      for (const TriangleMesh& sheet : sheets)
        scene.add(sheet, {.self_collision = true, .margin = reach / 2});
      return scene;
    };
    Scene before = scene_with(thickness + 2 * longest);
    const std::set<Pair> listed = near_elements(before);
    for (TriangleMesh& sheet : sheets) {
      for (Vec3d& p : sheet.positions) {
        const Vec3d way = random.vector(1);
        p += way * (longest * (1 - 1e-9) / std::max(norm(way), 1.0));
      }
    }
    Scene after = scene_with(thickness);
    for (const Pair& pair : near_elements(after)) {
      // An edge and a face are listed only while the edge goes through the face.
      const auto [a, b, kind_a, kind_b, element_a, element_b] = pair;
      if ((kind_a == FeatureKind::edge) != (kind_b == FeatureKind::edge)) continue;
      EXPECT_TRUE(listed.contains(pair));
      ++near;
    }
  }
  EXPECT_GT(near, 100u);
}

/// Two parallel edges side by side: their nearest points are at vertices, or at a vertex and an edge.
TEST(GuaranteesForSolvers, OnlyElementsNameParallelEdges) {
  for (const double shift : {0.0, 0.5}) {
    const auto are_two_edges = [&](ProximityListing listing) {
      Scene scene({.contacts = ContactKinds::proximity, .proximity_listing = listing});
      for (const double y : {0.0, 0.1}) {
        TriangleMesh edge;
        const double from = y > 0 ? shift : 0;
        edge.positions = {{from, y, 0}, {from + 1, y, 0}};
        scene.add(edge, {.edges = {{0, 1}}, .margin = 0.06});
      }
      std::vector<bool> are_edges;
      for (const ProximityPair& pair : scene.detect().proximity_pairs)
        are_edges.push_back(pair.kind_a == FeatureKind::edge && pair.kind_b == FeatureKind::edge);
      return are_edges;
    };
    const auto features = are_two_edges(ProximityListing::features),
               elements = are_two_edges(ProximityListing::elements);
    EXPECT_EQ(std::count(features.begin(), features.end(), true), 0);
    EXPECT_EQ(std::count(elements.begin(), elements.end(), true), 1);
    EXPECT_FALSE(features.empty());
  }
}

}  // namespace supple::guarantees_test
