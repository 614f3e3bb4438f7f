#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "supple/result_descriptions.hpp"
#include "supple/scene.hpp"
#include "support/random.hpp"

namespace supple::untested_test {

using enum NothingToTest;
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

const TriangleMesh triangle{"triangle", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
const TriangleMesh tetrahedron{"tetrahedron",
                               {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                               {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};
const TriangleMesh two_triangles{
    "two", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 9}, {1, 0, 9}, {0, 1, 9}}, {{0, 1, 2}, {3, 4, 5}}};

TriangleMesh moved(TriangleMesh mesh, double z) {
  for (Vec3d& p : mesh.positions) p.z += z;
  return mesh;
}

/// Why a kind was not tested; nothing when it was.
std::optional<NothingToTest> reason_of(Scene& scene, ContactKinds kind, DetectRequest request = {}) {
  request.contacts = kind;
  for (const UntestedKind& untested : scene.detect(request).untested) {
    if (untested.kind == kind) return untested.reason;
  }
  return std::nullopt;
}

constexpr std::array all_kinds{ContactKinds::intersection, ContactKinds::continuous, ContactKinds::proximity,
                               ContactKinds::penetration};

TEST(Untested, NoObjectAndNoTriangle) {
  for (const ContactKinds kind : all_kinds) {
    Scene scene;
    EXPECT_EQ(reason_of(scene, kind), no_objects);
    TriangleMesh cloud = triangle;
    cloud.triangles.clear();
    scene.add(cloud, {.self_collision = true});
    EXPECT_EQ(reason_of(scene, kind), no_elements);
    scene.add(cloud);
    EXPECT_EQ(reason_of(scene, kind), no_elements);
  }
}

TEST(Untested, NotFinite) {
  for (const ContactKinds kind : all_kinds) {
    Scene scene;
    TriangleMesh broken = triangle;
    for (const std::size_t v : {0, 1}) broken.positions[v].y = nan;
    const ObjectId a = scene.add(broken, {.margin = 1});
    scene.add(broken, {.margin = 1});
    scene.set_motion(a, broken.positions, broken.positions);
    EXPECT_EQ(reason_of(scene, kind), not_finite);
  }
  Scene scene;
  const ObjectId a = scene.add(triangle);
  scene.add(moved(triangle, 5));
  std::vector<Vec3d> broken = triangle.positions;
  broken[0].x = broken[1].x = nan;
  scene.set_motion(a, broken, triangle.positions);
  EXPECT_EQ(reason_of(scene, ContactKinds::continuous), no_motion);
  EXPECT_EQ(reason_of(scene, ContactKinds::intersection), std::nullopt);
}

TEST(Untested, OneObject) {
  Scene scene;
  const ObjectId a = scene.add(two_triangles, {.margin = 1});
  EXPECT_EQ(reason_of(scene, ContactKinds::intersection), one_object);
  EXPECT_EQ(reason_of(scene, ContactKinds::proximity), one_object);
  EXPECT_EQ(reason_of(scene, ContactKinds::continuous), no_motion);
  EXPECT_EQ(reason_of(scene, ContactKinds::penetration), no_solid);
  scene.set_motion(a, two_triangles.positions, moved(two_triangles, 1).positions);
  EXPECT_EQ(reason_of(scene, ContactKinds::continuous), one_object);
  scene.set_options(a, {.self_collision = true});
  for (const ContactKinds kind :
       {ContactKinds::intersection, ContactKinds::continuous, ContactKinds::proximity})
    EXPECT_EQ(reason_of(scene, kind), std::nullopt);
  scene.add({});  // an object without triangles is no partner
  scene.set_options(a, {.self_collision = false});
  EXPECT_EQ(reason_of(scene, ContactKinds::intersection), one_object);
}

TEST(Untested, OneElementHasNoPartnerInItsObject) {
  for (const TriangleMesh& mesh : {triangle, tetrahedron}) {
    Scene scene;
    const ObjectId object = scene.add(mesh, {.self_collision = true, .margin = 0.01});
    scene.set_motion(object, mesh.positions, moved(mesh, 1).positions);
    for (const ContactKinds kind :
         {ContactKinds::intersection, ContactKinds::continuous, ContactKinds::proximity})
      EXPECT_EQ(reason_of(scene, kind),
                mesh.triangles.size() == 1 ? std::optional(one_object) : std::nullopt);
  }
}

TEST(Untested, NeedsOfKinds) {
  Scene scene;
  const ObjectId a = scene.add(tetrahedron);
  scene.add(moved(tetrahedron, 5));
  EXPECT_EQ(reason_of(scene, ContactKinds::intersection), std::nullopt);
  EXPECT_EQ(reason_of(scene, ContactKinds::continuous), no_motion);
  EXPECT_EQ(reason_of(scene, ContactKinds::proximity), no_margin);
  EXPECT_EQ(reason_of(scene, ContactKinds::penetration), no_solid);
  const DetectResult& all = scene.detect(
      {.contacts = ContactKinds::penetration | ContactKinds::proximity | ContactKinds::continuous});
  ASSERT_EQ(all.untested.size(), 3u);
  EXPECT_EQ(all.untested[0], (UntestedKind{ContactKinds::continuous, no_motion}));
  EXPECT_EQ(all.untested[1], (UntestedKind{ContactKinds::proximity, no_margin}));
  EXPECT_EQ(all.untested[2], (UntestedKind{ContactKinds::penetration, no_solid}));
  scene.set_options(a, {.margin = 0.5});
  scene.add(moved(tetrahedron, 10), {.solid = true});
  scene.set_motion(a, tetrahedron.positions, moved(tetrahedron, 1).positions);
  for (const ContactKinds kind : all_kinds) EXPECT_EQ(reason_of(scene, kind), std::nullopt);
  EXPECT_TRUE(scene.detect({.contacts = ContactKinds::none}).untested.empty());
}

TEST(Untested, AKindWithContactsIsTested) {
  Scene scene;  // two objects at rest that touch
  scene.add(tetrahedron);
  scene.add(moved(tetrahedron, 0.25));
  for (const ContactKinds kind :
       {ContactKinds::intersection, ContactKinds::continuous, ContactKinds::proximity})
    EXPECT_EQ(reason_of(scene, kind), std::nullopt);
}

TEST(Untested, StaticObjectsGroupsAndFilters) {
  Scene scene;
  const ObjectId a = scene.add(triangle, {.is_static = true});
  const ObjectId b = scene.add(moved(triangle, 5), {.is_static = true});
  EXPECT_EQ(reason_of(scene, ContactKinds::intersection), all_static);
  scene.set_options(a, {.is_static = false});
  EXPECT_EQ(reason_of(scene, ContactKinds::intersection), std::nullopt);
  scene.set_options(b, {.group = 2, .mask = 2});  // a has group 1 and every mask
  EXPECT_EQ(reason_of(scene, ContactKinds::intersection), groups);
  scene.set_options(b, {.group = 2, .mask = 1});
  EXPECT_EQ(reason_of(scene, ContactKinds::intersection), std::nullopt);
  scene.set_pair_filter([](ObjectId, ObjectId) { return false; });
  EXPECT_EQ(reason_of(scene, ContactKinds::intersection), filter);
  scene.set_pair_filter([&](ObjectId, ObjectId second) { return second == b; });
  EXPECT_EQ(reason_of(scene, ContactKinds::intersection), std::nullopt);
}

TEST(Untested, LinesAndPoints) {
  const TriangleMesh particles{"particles", {{0, 0, 0}, {1, 0, 0}}, {}, {}, {0, 1}};
  Scene scene;
  const ObjectId a = scene.add(particles, {.self_collision = true, .margin = 0.1});
  EXPECT_EQ(reason_of(scene, ContactKinds::intersection), no_elements);
  EXPECT_EQ(reason_of(scene, ContactKinds::proximity), std::nullopt);
  EXPECT_EQ(reason_of(scene, ContactKinds::proximity, {.element_kinds = ElementKinds::edge_edge}),
            no_elements);
  scene.set_options(a, {.self_collision = false});
  EXPECT_EQ(reason_of(scene, ContactKinds::proximity), one_object);
}

struct Member {
  TriangleMesh mesh;
  ObjectOptions options;

  /// The triangles that take part: those of three finite vertices, or with `parts` those of two.
  std::ptrdiff_t elements(bool parts) const {
    return std::ranges::count_if(mesh.triangles, [&](const Triangle& t) {
      return std::ranges::count_if(t, [&](std::uint32_t v) { return !std::isnan(mesh.positions[v].x); }) >=
             (parts ? 2 : 3);
    });
  }
};

/// All pairs of objects, by the words of the options.
TEST(Untested, EqualsTheRulesOfPairs) {
  RandomNumbers random(7);
  const auto bits = [&] { return static_cast<std::uint32_t>(random.below(4)); };
  int untested = 0, tested = 0;
  for (int round = 0; round < 3000; ++round) {
    Scene scene({.threads = 1});
    std::vector<Member> members(random.below(5));
    for (std::size_t i = 0; i < members.size(); ++i) {
      Member& member = members[i];
      member.mesh = random.below(3) == 0 ? two_triangles : random.below(2) == 0 ? triangle : tetrahedron;
      member.mesh = moved(member.mesh, 20.0 * static_cast<double>(i));
      if (random.below(5) == 0) member.mesh.triangles.clear();
      member.options.self_collision = random.below(3) == 0;
      member.options.is_static = random.below(2) == 0;
      member.options.margin = 0.01;
      member.options.group = bits();
      member.options.mask = bits();
      const ObjectId id = scene.add(member.mesh, member.options);
      const std::size_t vertices = member.mesh.positions.size();
      if (random.below(4) == 0) {
        member.mesh.positions[random.below(static_cast<std::uint32_t>(vertices))].x = nan;
        scene.set_options(id, {.is_static = false});
        scene.set_positions(id, member.mesh.positions);
        scene.set_options(id, {.is_static = member.options.is_static});
      }
    }
    std::uint64_t refused = 0;  // pairs, as bits
    if (random.below(4) == 0) refused = random.bits();
    const std::vector<ObjectId> ids = scene.objects();
    const auto accepts = [&](std::size_t i, std::size_t j) { return (refused >> (5 * i + j) & 1) == 0; };
    const auto place = [&](ObjectId id) {
      return static_cast<std::size_t>(std::ranges::find(ids, id) - ids.begin());
    };
    scene.set_pair_filter([&](ObjectId a, ObjectId b) { return accepts(place(a), place(b)); });
    for (const ContactKinds kind : {ContactKinds::intersection, ContactKinds::proximity}) {
      const DetectResult& result = scene.detect({.contacts = kind});
      ASSERT_TRUE(result.contacts.empty() && result.proximity_pairs.empty());
      bool expected = false;
      for (std::size_t i = 0; i < members.size(); ++i) {
        for (std::size_t j = i; j < members.size(); ++j) {
          const ObjectOptions &a = members[i].options, &b = members[j].options;
          const bool parts = kind == ContactKinds::proximity;
          const auto of_a = members[i].elements(parts), of_b = members[j].elements(parts);
          expected |= i == j ? a.self_collision && of_a > 1
                             : of_a > 0 && of_b > 0 && !(a.is_static && b.is_static) &&
                                   (a.group & b.mask) != 0 && (b.group & a.mask) != 0 && accepts(i, j);
        }
      }
      ASSERT_EQ(result.untested.empty(), expected) << "round " << round << ", kind " << word_of(kind);
      ++(expected ? tested : untested);
    }
  }
  EXPECT_GT(tested, 500);
  EXPECT_GT(untested, 500);
}

}  // namespace supple::untested_test
