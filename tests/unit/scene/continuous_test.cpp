// Compares the continuous contacts of whole scenes in every configuration with the algebraic reference, which
// tests every pair of elements.

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

#include "supple/error.hpp"
#include "supple/inspection.hpp"
#include "supple/models.hpp"
#include "supple/trigonometry.hpp"
#include "supple/verify.hpp"
#include "support/hard_scenes.hpp"
#include "support/instruction_sets.hpp"
#include "support/scenes.hpp"

namespace supple::continuous_test {

using Vertices = std::vector<Vec3d>;

/// A mesh and the end positions of its vertices.
struct Moving {
  TriangleMesh mesh;
  Vertices to;
};

/// The first triangles of a mesh, few enough for brute force with the algebraic reference.
TriangleMesh cropped(TriangleMesh mesh, std::size_t triangles) {
  mesh.triangles.resize(std::min(mesh.triangles.size(), triangles));
  return mesh;
}

/// Objects that are degenerate in the same way at both ends of the step.
std::vector<Moving> moving(const Family& family, std::uint64_t seed) {
  const std::vector<TriangleMesh> from = family.make(seed), to = family.make(seed + 1);
  std::vector<Moving> objects;
  for (std::size_t i = 0; i < from.size(); ++i) objects.push_back({cropped(from[i], 12), to[i].positions});
  return objects;
}

SceneOptions continuous(double separation = 0, std::uint32_t threads = 1) {
  SceneOptions options;
  options.contacts = ContactKinds::continuous;
  options.impact.min_separation = separation;
  options.threads = threads;
  return options;
}

Scene scene_of(const std::vector<Moving>& objects, const SceneOptions& options, std::uint32_t leaf_size = 3,
               std::uint32_t arity = 8) {
  Scene scene(options);
  for (const Moving& object : objects) {
    const ObjectId id = scene.add(
        object.mesh,
        {.self_collision = true,
         .octree = {.leaf_size = leaf_size,
                    .arity = arity,
                    .build = arity == 8 ? ObjectOctreeBuild::balanced : ObjectOctreeBuild::regular}});
    scene.set_motion(id, object.mesh.positions, object.to);
  }
  return scene;
}

std::vector<ContinuousContact> contacts_of(Scene& scene) {
  const auto contacts = scene.detect().continuous_contacts;
  return {contacts.begin(), contacts.end()};
}

/// One line per difference that `verify` finds; empty if it agrees.
std::string faults(const Scene& scene) {
  const char* const names[] = {"missed", "added", "late", "early"};
  std::string text;
  for (const ContinuousDifference& d : verify(scene).continuous_differences) {
    text += std::string(names[static_cast<int>(d.fault)]) + " kind " + std::to_string(int(d.kind));
    for (const auto& element : {d.element_a, d.element_b}) {
      text += " {" + std::to_string(element[0]) + ' ' + std::to_string(element[1]) + '}';
    }
    text += "\n";
  }
  return text;
}

class ContinuousScenes : public testing::TestWithParam<Family> {};

TEST_P(ContinuousScenes, EqualAlgebraInEveryConfiguration) {
  const std::vector<Moving> objects = moving(GetParam(), 1);
  Scene reference = scene_of(objects, continuous());
  const std::vector<ContinuousContact> expected = contacts_of(reference);
  ASSERT_GT(expected.size(), 0u);
  ASSERT_EQ(faults(reference), "");
  ASSERT_EQ(SceneInspector(reference).validate(), "");
  for (const BoundingVolume volume : {BoundingVolume::aabb, BoundingVolume::sphere}) {
    for (const BroadPhaseMethod method :
         {BroadPhaseMethod::automatic, BroadPhaseMethod::octree, BroadPhaseMethod::grid,
          BroadPhaseMethod::sweep, BroadPhaseMethod::brute, BroadPhaseMethod::sweep3}) {
      for (const std::uint32_t threads : {1u, 2u, 5u}) {
        SceneOptions options = continuous(0, threads);
        options.bounding_volume = volume;
        options.broad_phase = method;
        Scene scene = scene_of(objects, options, threads, threads == 1 ? 8 : threads == 2 ? 4 : 2);
        ASSERT_EQ(contacts_of(scene), expected) << threads;
        ASSERT_EQ(SceneInspector(scene).validate(), "");
      }
    }
  }
  for_each_target([&](const char* target) {
    Scene scene = scene_of(objects, continuous());
    EXPECT_EQ(contacts_of(scene), expected) << target;
  });
}

TEST_P(ContinuousScenes, FindTheEarliestOfAll) {
  for (const std::uint64_t seed : {1u, 2u}) {
    const std::vector<Moving> objects = moving(GetParam(), seed);
    for (const std::uint32_t threads : {1u, 3u}) {
      Scene scene = scene_of(objects, continuous(0, threads));
      const std::vector<ContinuousContact> all = contacts_of(scene);
      const auto first = std::min_element(all.begin(), all.end(),
                                          [](const auto& p, const auto& q) { return p.toi < q.toi; });
      ASSERT_NE(first, all.end());
      EXPECT_EQ(scene.earliest_impact(), *first) << seed;
      // What touches at the start may part.
      if (first->toi > 0) {
        EXPECT_EQ(scene.max_step().step, first->toi);
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Families, ContinuousScenes, testing::ValuesIn(hard_families()),
                         [](const auto& family) { return family.param.name; });

TEST(ContinuousSeparation, EqualsAlgebraAndGrowsWithTheDistance) {
  std::vector<Moving> objects;
  for (const std::uint64_t seed : {5u, 6u}) {
    Moving object{cropped(random_soup(14, 1, 0.3, seed), 14), {}};
    RandomNumbers random(seed);
    for (const Vec3d& p : object.mesh.positions) object.to.push_back(p + random.vector(0.2));
    objects.push_back(object);
  }
  std::size_t fewer = 0;
  for (const double separation : {0.0, 0.02, 0.1, 0.4}) {
    Scene scene = scene_of(objects, continuous(separation));
    const std::size_t count = contacts_of(scene).size();
    EXPECT_EQ(faults(scene), "") << separation;
    EXPECT_GT(count, fewer) << separation;
    fewer = count;
  }
}

TriangleMesh one_triangle(double height) {
  return {"triangle", {{0, 0, height}, {4, 0, height}, {0, 4, height}}, {{0, 1, 2}}};
}

/// A triangle that falls by `fall`. Its first corner is lower than the others.
struct Falling {
  Scene scene;
  ObjectId floor, stone;

  explicit Falling(double fall, const SceneOptions& options = continuous()) : scene(options) {
    floor = scene.add(one_triangle(0));
    const Vertices from{{1, 1, 1}, {1, 1.5, 2}, {1.5, 1, 2}};
    stone = scene.add({"stone", from, {{0, 1, 2}}});
    Vertices to = from;
    for (Vec3d& p : to) p.z -= fall;
    scene.set_motion(stone, from, to);
  }
};

TEST(ContinuousContacts, ATriangleFallsOnAnother) {
  Falling falling(2);
  const DetectResult& result = falling.scene.detect();
  ASSERT_EQ(result.continuous_groups.size(), 1u);
  const auto contacts = result.continuous_contacts_of(result.continuous_groups[0]);
  ASSERT_EQ(contacts.size(), 3u);  // the first corner at 1/2, the others at 1
  const ContinuousContact& contact = contacts[0];
  EXPECT_EQ(contact.kind, ElementPairKind::face_vertex);
  EXPECT_EQ(contact.element_a, (std::array{0u, 0u}));
  EXPECT_EQ(contact.element_b, (std::array{0u, 0u}));
  EXPECT_LE(contact.toi, 0.5);
  EXPECT_NEAR(contact.toi, 0.5, 1e-9);
  EXPECT_EQ(contact.certainty, ImpactCertainty::certain);
  EXPECT_NEAR(contact.barycentric_a[0], 0.5, 1e-9);
  EXPECT_NEAR(contact.barycentric_a[1], 0.25, 1e-9);
  EXPECT_NEAR(contact.barycentric_a[2], 0.25, 1e-9);
  EXPECT_EQ(contact.barycentric_b, (std::array{1.0, 0.0, 0.0}));
  EXPECT_NEAR(contact.point.x, 1, 1e-9);
  EXPECT_NEAR(contact.point.z, 0, 1e-9);
  EXPECT_EQ(contact.normal, (Vec3d{0, 0, -1}));  // from the stone (b) to the floor (a)
  EXPECT_EQ(result.contact_events.begin.size(), 1u);
  EXPECT_TRUE(result.groups.empty() && result.contacts.empty());
}

TEST(ContinuousContacts, NothingTouchesThatStopsShort) {
  Falling falling(0.999);
  EXPECT_TRUE(falling.scene.detect().continuous_contacts.empty());
  EXPECT_FALSE(falling.scene.earliest_impact().has_value());
  EXPECT_EQ(falling.scene.max_step().step, 1);
}

TEST(ContinuousContacts, ReachTheSeparationEarlier) {
  Falling falling(2, continuous(0.25));
  EXPECT_NEAR(falling.scene.max_step().step, 0.375, 1e-9);
  EXPECT_LE(falling.scene.max_step().step, 0.375);
  Falling stops(0.75, continuous(0.25));  // ends exactly at the separation
  EXPECT_EQ(stops.scene.detect().continuous_contacts.size(), 1u);
  Falling short_of_it(0.75 - 0x1p-50, continuous(0.25));
  EXPECT_EQ(short_of_it.scene.detect().continuous_contacts.size(), 0u);
}

TEST(ContinuousContacts, WhatExactArithmeticWouldDecideIsReportedWithoutIt) {
  SceneOptions options = continuous(0.25);
  options.impact.exact = false;
  Falling short_of_it(0.75 - 0x1p-50, options);
  const auto contacts = short_of_it.scene.detect().continuous_contacts;
  ASSERT_EQ(contacts.size(), 1u);
  EXPECT_EQ(contacts[0].certainty, ImpactCertainty::within_tolerance);
  EXPECT_TRUE(verify(short_of_it.scene).agrees());
}

TEST(ContinuousContacts, OfAnObjectAtRestAreAtTheStart) {
  Scene scene(continuous());
  scene.add(one_triangle(0));
  const ObjectId other = scene.add({"upright", {{1, 1, 0}, {1, 1, 1}, {2, 1, 1}}, {{0, 1, 2}}});
  const std::vector<ContinuousContact> at_rest = contacts_of(scene);
  ASSERT_FALSE(at_rest.empty());
  for (const ContinuousContact& contact : at_rest) EXPECT_EQ(contact.toi, 0);
  scene.translate(other, {0, 0, 10});
  EXPECT_TRUE(contacts_of(scene).empty());
  scene.set_transform(other, {.translation = {0, 0, 0}});
  EXPECT_EQ(contacts_of(scene), at_rest);
  EXPECT_EQ(SceneInspector(scene).validate(), "");
}

TEST(ContinuousContacts, HoldUntilTheObjectIsMovedOtherwise) {
  Falling falling(2);
  const std::vector<ContinuousContact> first = contacts_of(falling.scene);
  EXPECT_EQ(contacts_of(falling.scene), first);
  EXPECT_EQ(falling.scene.position(falling.stone, 0), (Vec3d{1, 1, -1}));
  falling.scene.set_positions(falling.stone, Vertices{{1, 1, 5}, {1, 1.5, 6}, {1.5, 1, 6}});
  EXPECT_TRUE(contacts_of(falling.scene).empty());
}

TEST(ContinuousContacts, FloatPathsGiveTheContactsOfTheSameNumbers) {
  const Moving sheet{crumpled_sheet(8, 8, 0.05, 1), crumpled_sheet(8, 8, 0.1, 2).positions};
  std::vector<Vec3f> from, to;
  Moving rounded = sheet;
  for (std::size_t i = 0; i < sheet.to.size(); ++i) {
    const auto round = [](Vec3d& p, std::vector<Vec3f>& list) {
      list.push_back({static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)});
      p = {list.back().x, list.back().y, list.back().z};
    };
    round(rounded.mesh.positions[i], from);
    round(rounded.to[i], to);
  }
  Scene doubles = scene_of({rounded}, continuous());
  Scene floats = scene_of({sheet}, continuous());
  floats.set_motion(floats.objects().front(), from, to);
  const std::vector<ContinuousContact> expected = contacts_of(doubles);
  ASSERT_FALSE(expected.empty());
  EXPECT_EQ(contacts_of(floats), expected);
}

TEST(ContinuousContacts, AVertexThatIsNotFiniteHidesNoOther) {
  Moving sheet{crumpled_sheet(6, 6, 0.1, 3), crumpled_sheet(6, 6, 0.2, 4).positions};
  sheet.to[8].x = std::numeric_limits<double>::quiet_NaN();
  sheet.mesh.positions[30].z = std::numeric_limits<double>::infinity();
  Scene scene = scene_of({sheet}, continuous());
  EXPECT_FALSE(contacts_of(scene).empty());
  EXPECT_EQ(faults(scene), "");
  EXPECT_EQ(scene.result().non_finite_vertices.size(), 2u);
}

/// A fine sheet that waves without touching itself, though its neighbouring triangles are very close.
TEST(ContinuousContacts, OfAWavingSheetAreNone) {
  Moving sheet{crumpled_sheet(40, 40, 0, 0), {}};
  sheet.to = sheet.mesh.positions;
  for (Vec3d& p : sheet.mesh.positions) p.y = 0.05 * sin_turns(p.x + p.z);
  for (Vec3d& p : sheet.to) p.y = 0.05 * sin_turns(p.x - p.z + 0.25);
  Scene scene = scene_of({sheet}, continuous(), 8);
  EXPECT_TRUE(contacts_of(scene).empty());
}

TEST(ContinuousContacts, OfAFoldingSheetAreThoseOfAlgebra) {
  Moving sheet{crumpled_sheet(12, 6, 0, 0), {}};
  sheet.to = sheet.mesh.positions;
  for (Vec3d& p : sheet.to) {  // the far half folds over onto the near one and passes through it
    if (p.x > 0.5) p = {1 - p.x, 0.3 - 0.7 * (p.x - 0.5), p.z};
  }
  Scene scene = scene_of({sheet}, continuous());
  EXPECT_FALSE(contacts_of(scene).empty());
  EXPECT_EQ(faults(scene), "");
}

TEST(ContinuousContacts, RandomLivesEqualAlgebra) {
  RandomNumbers random(11);
  Scene scene(continuous(0, 2));
  std::vector<ObjectId> ids;
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    ids.push_back(scene.add(random_soup(8, 0.7, 0.3, seed), {.self_collision = seed % 2 == 0}));
  }
  std::size_t found = 0;
  for (int step = 0; step < 12; ++step) {
    for (const ObjectId id : ids) {
      Vertices from(24), to(24);
      for (Vec3d& p : from) p = random.vector(0.8);
      for (std::size_t i = 0; i < to.size(); ++i) to[i] = from[i] + random.vector(0.3);
      switch (random.below(4)) {
        case 0:
          scene.set_positions(id, from);
          break;
        case 1:
          scene.translate(id, random.vector(0.5));
          break;
        default:
          scene.set_motion(id, from, to);
      }
    }
    if (step == 6) scene.set_pair_filter([](ObjectId a, ObjectId b) { return (a.index + b.index) % 2 == 1; });
    found += scene.detect().continuous_contacts.size();
    ASSERT_EQ(faults(scene), "") << step;
    ASSERT_EQ(SceneInspector(scene).validate(), "") << step;
  }
  EXPECT_GT(found, 100u);
}

std::string message_of(const std::function<void()>& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(ContinuousErrors, SayWhatToDo) {
  Scene discrete;
  EXPECT_NE(message_of([&] {
              discrete.detect({.impact = ImpactOptions{.min_separation = -1}});
            }).find("DetectRequest::impact"),
            std::string::npos);
  EXPECT_NE(message_of([] { Scene scene(continuous(-1)); }).find("min_separation is -1"), std::string::npos);
  EXPECT_NE(message_of([] {
              Scene scene(continuous(std::numeric_limits<double>::infinity()));
            }).find("min_separation"),
            std::string::npos);
  Scene scene(continuous());
  const ObjectId id = scene.add(one_triangle(0));
  EXPECT_NE(
      message_of([&] { scene.set_motion(id, Vertices(3), Vertices(2)); }).find("2 positions for triangle"),
      std::string::npos);
  scene.set_options(id, {.is_static = true});
  EXPECT_NE(message_of([&] { scene.set_motion(id, Vertices(3), Vertices(3)); }).find("static"),
            std::string::npos);
  EXPECT_NE(message_of([&] { verify(scene); }).find("call detect first"), std::string::npos);
}

}  // namespace supple::continuous_test
