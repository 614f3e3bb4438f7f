// What continuous contacts and proximity leave out on request: kinds of elements, all but first contacts,
// late times, elements that part, and pairs of vertex groups. `verify` knows each of them by other code.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <string_view>
#include <tuple>
#include <vector>

#include "supple/error.hpp"
#include "supple/scene.hpp"
#include "supple/verify.hpp"
#include "support/golden_scenes.hpp"
#include "support/hard_scenes.hpp"
#include "support/random.hpp"

namespace supple::element_search_test {

constexpr ContactKinds continuous = ContactKinds::continuous;
// Few enough for algebra, which is slow in builds with sanitizers.
#ifdef NDEBUG
constexpr std::size_t triangles = 7, near_triangles = 6;
#else
constexpr std::size_t triangles = 4, near_triangles = 4;
#endif

/// Objects that are degenerate in the same way at both ends of the step, each also tested against itself.
Scene moving_scene(const Family& family, const SceneOptions& options, std::uint64_t seed = 1) {
  const std::vector<TriangleMesh> from = family.make(seed), to = family.make(seed + 1);
  Scene scene(options);
  for (std::size_t i = 0; i < from.size(); ++i) {
    TriangleMesh mesh = from[i];
    mesh.triangles.resize(std::min(mesh.triangles.size(), triangles));
    const ObjectId id = scene.add(mesh, {.self_collision = true, .octree = {.leaf_size = 3}});
    if (i % 3 != 2) scene.set_motion(id, mesh.positions, to[i].positions);
  }
  return scene;
}

/// A separation within which some elements are. None where algebra takes seconds for it.
double separation_of(const Family& family) {
  if (family.name == std::string_view("MixedScales")) return 0;
  double size = 0;
  const std::vector<TriangleMesh> meshes = family.make(1);
  for (const Vec3d& p : meshes.front().positions) {
    for (int axis = 0; axis < 3; ++axis) {
      if (std::isfinite(p[axis])) size = std::max(size, std::fabs(p[axis]));
    }
  }
  return size / 20;
}

void expect_agreement(const Scene& scene) {
  const VerifyReport report = verify(scene);
  EXPECT_TRUE(report.agrees()) << report.difference_count() << " differences";
}

bool is_of_edges(const ContinuousContact& contact) {
  return contact.kind == ElementPairKind::edge_edge;
}

class ElementSearch : public testing::TestWithParam<Family> {};

TEST_P(ElementSearch, OfOneKindIsAPartOfAll) {
  for (const double separation : {0.0, separation_of(GetParam())}) {
    Scene scene =
        moving_scene(GetParam(), {.contacts = continuous, .impact = {.min_separation = separation}});
    const auto found = [&](ElementKinds kinds) {
      DetectRequest request;
      request.element_kinds = kinds;
      const auto contacts = scene.detect(request).continuous_contacts;
      expect_agreement(scene);
      return std::vector(contacts.begin(), contacts.end());
    };
    auto all = found(ElementKinds::all);
    const auto edges = found(ElementKinds::edge_edge), faces = found(ElementKinds::vertex_face);
    EXPECT_EQ(edges.size() + faces.size(), all.size());
    EXPECT_TRUE(std::all_of(edges.begin(), edges.end(), is_of_edges));
    std::erase_if(all, is_of_edges);
    EXPECT_EQ(faces, all);
  }
}

TEST_P(ElementSearch, ListsTheFirstContactOfEachElement) {
  Scene scene = moving_scene(GetParam(), {.contacts = continuous});
  const auto all_contacts = scene.detect().continuous_contacts;
  const std::vector all(all_contacts.begin(), all_contacts.end());
  // The first contact of each element, by time and place in the list.
  using Element = std::tuple<ObjectId, FeatureKind, std::array<std::uint32_t, 2>>;
  std::map<Element, std::pair<double, std::size_t>> firsts;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto [kind_a, kind_b] = feature_kinds(all[i].kind);
    for (const Element& element : {Element{all[i].object_a, kind_a, all[i].element_a},
                                   Element{all[i].object_b, kind_b, all[i].element_b}}) {
      const auto [known, is_new] = firsts.try_emplace(element, all[i].toi, i);
      known->second = std::min(known->second, std::pair(all[i].toi, i));
    }
  }
  std::vector<std::size_t> places;
  for (const auto& [element, first] : firsts) places.push_back(first.second);
  std::sort(places.begin(), places.end());
  places.erase(std::unique(places.begin(), places.end()), places.end());
  std::vector<ContinuousContact> expected;
  for (const std::size_t place : places) expected.push_back(all[place]);

  DetectRequest request;
  request.continuous_listing = ContinuousListing::first;
  const DetectResult& result = scene.detect(request);
  EXPECT_EQ(std::vector(result.continuous_contacts.begin(), result.continuous_contacts.end()), expected);
  EXPECT_EQ(result.stats.contacts, expected.size());
  std::size_t next = 0;
  for (const ContactGroup& group : result.continuous_groups) {
    EXPECT_EQ(group.first_contact, next);
    for (const ContinuousContact& contact : result.continuous_contacts_of(group))
      EXPECT_EQ(std::pair(contact.object_a, contact.object_b), std::pair(group.a, group.b));
    next += group.contact_count;
  }
  EXPECT_EQ(next, expected.size());
  expect_agreement(scene);
  for (std::size_t most = 0; most < expected.size(); most += 1 + expected.size() / 3) {
    request.max_contacts = most;
    const DetectResult& limited = scene.detect(request);
    EXPECT_EQ(std::vector(limited.continuous_contacts.begin(), limited.continuous_contacts.end()),
              std::vector(expected.begin(), expected.begin() + static_cast<std::ptrdiff_t>(most)));
    EXPECT_TRUE(limited.truncated);
  }
}

TEST_P(ElementSearch, EndsAtALargestTime) {
  Scene scene = moving_scene(GetParam(), {.contacts = continuous});
  const auto all_contacts = scene.detect().continuous_contacts;
  const std::vector all(all_contacts.begin(), all_contacts.end());
  std::vector<double> times{0, 0.001, 0.1, 0.5};
  if (!all.empty()) times.push_back(all[all.size() / 2].toi);
  for (const double until : times) {
    DetectRequest request;
    request.impact = ImpactOptions{.max_time = until};
    const auto found = scene.detect(request).continuous_contacts;
    std::vector<ContinuousContact> expected = all;
    std::erase_if(expected, [&](const ContinuousContact& contact) { return contact.toi > until; });
    EXPECT_EQ(std::vector(found.begin(), found.end()), expected) << until;
    expect_agreement(scene);
  }
}

TEST_P(ElementSearch, LeavesOutElementsThatPart) {
  const double separation = separation_of(GetParam());
  Scene scene = moving_scene(GetParam(), {.contacts = continuous, .impact = {.min_separation = separation}});
  const auto all_contacts = scene.detect().continuous_contacts;
  const std::vector all(all_contacts.begin(), all_contacts.end());
  DetectRequest request;
  request.impact = ImpactOptions{.min_separation = separation, .skip_parting = true};
  const auto found = scene.detect(request).continuous_contacts;
  expect_agreement(scene);
  std::vector<ContinuousContact> skipped;
  std::copy_if(all.begin(), all.end(), std::back_inserter(skipped), [&](const ContinuousContact& contact) {
    return std::find(found.begin(), found.end(), contact) == found.end();
  });
  EXPECT_EQ(skipped.size() + found.size(), all.size());
  for (const ContinuousContact& contact : skipped) {
    EXPECT_TRUE(contact.touching_at_start);
    EXPECT_GT(contact.start_distance, 0);
  }
}

TEST_P(ElementSearch, AddsTheSeparationsOfObjects) {
  const double part = separation_of(GetParam()) / 5;
  Scene scene = moving_scene(GetParam(), {.contacts = continuous, .impact = {.min_separation = part}});
  const std::vector<ObjectId> objects = scene.objects();
  for (std::size_t i = 0; i < objects.size(); ++i)
    scene.set_options(objects[i], {.min_separation = 2 * part * static_cast<double>(i)});
  scene.detect();
  expect_agreement(scene);
  for (const ObjectId object : objects) scene.set_options(object, {.min_separation = 2 * part});
  const auto contacts = scene.detect().continuous_contacts;
  const std::vector of_objects(contacts.begin(), contacts.end());
  for (const ObjectId object : objects) scene.set_options(object, {.min_separation = 0});
  DetectRequest request;
  request.impact = ImpactOptions{.min_separation = part + (2 * part + 2 * part)};
  const auto same = scene.detect(request).continuous_contacts;
  EXPECT_EQ(of_objects, std::vector(same.begin(), same.end()));
}

TEST_P(ElementSearch, SkipsPairsOfVertexGroups) {
  for (const ContactKinds kinds :
       {ContactKinds::intersection, continuous, ContactKinds::intersection | continuous}) {
    Scene scene = moving_scene(GetParam(), {.contacts = kinds});
    const auto count = [&] {
      const DetectResult& result = scene.detect();
      expect_agreement(scene);
      return result.contacts.size() + result.continuous_contacts.size();
    };
    const std::size_t all = count();
    RandomNumbers random(3);
    for (const ObjectId object : scene.objects()) {
      std::vector<std::uint32_t> groups(scene.vertex_count(object)), masks(groups.size());
      for (std::size_t v = 0; v < groups.size(); ++v) {
        groups[v] = 1u << random.below(3);
        masks[v] = random.below(8);
      }
      scene.set_vertex_groups(object, groups, masks);
    }
    EXPECT_LE(count(), all);
    for (const ObjectId object : scene.objects()) {
      const std::vector<std::uint32_t> none(scene.vertex_count(object), 0);
      scene.set_vertex_groups(object, none, none);
    }
    EXPECT_EQ(count(), 0u);
    EXPECT_FALSE(scene.earliest_impact());
    for (const ObjectId object : scene.objects()) scene.set_vertex_groups(object, {}, {});
    EXPECT_EQ(count(), all);
  }
}

TEST_P(ElementSearch, OfProximityHasKindsAndGroups) {
  for (const ProximityListing listing : {ProximityListing::features, ProximityListing::elements}) {
    Scene scene =
        near_scene_of(GetParam().make(1), {.contacts = ContactKinds::proximity, .proximity_listing = listing},
                      near_triangles);
    const std::size_t all = scene.detect().proximity_pairs.size();
    for (const ElementKinds kinds : {ElementKinds::vertex_face, ElementKinds::edge_edge}) {
      DetectRequest request;
      request.element_kinds = kinds;
      EXPECT_LE(scene.detect(request).proximity_pairs.size(), all);
      expect_agreement(scene);
    }
    RandomNumbers random(4);
    for (const ObjectId object : scene.objects()) {
      std::vector<std::uint32_t> groups(scene.vertex_count(object)), masks(groups.size());
      for (std::uint32_t& group : groups) group = 1u << random.below(3);
      for (std::uint32_t& mask : masks) mask = random.below(8);
      scene.set_vertex_groups(object, groups, masks);
    }
    EXPECT_LE(scene.detect().proximity_pairs.size(), all);
    expect_agreement(scene);
  }
}

INSTANTIATE_TEST_SUITE_P(Families, ElementSearch, testing::ValuesIn(hard_families()),
                         [](const auto& family) { return family.param.name; });

TriangleMesh triangle_at(double z) {
  TriangleMesh mesh;
  mesh.positions = {{0, 0, z}, {1, 0, z}, {0, 1, z}};
  mesh.triangles = {{0, 1, 2}};
  return mesh;
}

TEST(VertexGroups, LetTrianglesTouchWhereOnePairOfVerticesMay) {
  Scene scene;
  const ObjectId a = scene.add(triangle_at(0)), b = scene.add(triangle_at(0));
  EXPECT_EQ(scene.detect().contacts.size(), 1u);
  scene.set_vertex_groups(a, std::array{1u, 1u, 2u}, std::array{0u, 0u, 4u});
  EXPECT_EQ(scene.detect().contacts.size(), 1u) << "an object without groups has all bits";
  scene.set_vertex_groups(b, std::array{4u, 8u, 8u}, std::array{1u, 1u, 1u});
  EXPECT_EQ(scene.detect().contacts.size(), 0u) << "vertex 2 of a may touch 0 of b, but not the reverse";
  scene.set_vertex_groups(b, std::array{4u, 8u, 8u}, std::array{2u, 1u, 1u});
  EXPECT_EQ(scene.detect().contacts.size(), 1u);
}

TEST(VertexGroups, AreErrorsWithoutANumberForEachVertex) {
  Scene scene;
  const ObjectId a = scene.add(triangle_at(0));
  EXPECT_THROW(scene.set_vertex_groups(a, std::array{1u}, std::array{1u}), Error);
  EXPECT_THROW(scene.set_vertex_groups(a, {}, std::array{1u, 1u, 1u}), Error);
  scene.set_vertex_groups(a, std::array{1u, 1u, 1u}, std::array{1u, 1u, 1u});
  DetectRequest request;
  request.contacts = ContactKinds::penetration;
  EXPECT_THROW(scene.detect(request), Error);
  scene.set_vertex_groups(a, {}, {});
  EXPECT_NO_THROW(scene.detect(request));
}

TEST(SkipParting, KeepsElementsThatComeNearerLater) {
  SceneOptions options{.contacts = continuous, .impact = {.min_separation = 0.1, .skip_parting = true}};
  options.element_kinds = ElementKinds::vertex_face;
  const auto found = [&](double end) {
    Scene scene(options);
    const ObjectId a = scene.add(triangle_at(0.05));
    scene.add(triangle_at(0));
    scene.set_motion(a, triangle_at(0.05).positions, triangle_at(end).positions);
    return scene.detect().continuous_contacts.size();
  };
  EXPECT_EQ(found(0.2), 0u);
  EXPECT_EQ(found(0.05), 0u) << "they stay where they are";
  EXPECT_EQ(found(0.0499999), 0u) << "they come nearer by less than 2^-10";
  EXPECT_GT(found(0.04), 0u);
}

}  // namespace supple::element_search_test
