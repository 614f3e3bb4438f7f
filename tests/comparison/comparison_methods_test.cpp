#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "supple/comparison.hpp"
#include "supple/error.hpp"
#include "supple/models.hpp"
#include "supple/option_descriptions.hpp"
#include "supple/scene.hpp"
#include "supple/use_manifolds.hpp"

namespace supple::comparison_methods_test {

struct Method {
  std::string name;
  SceneOptions scene{};
  ObjectOctreeOptions octree{};

  std::size_t contacts() const {
    Scene tested(scene);
    for (int i = 0; i < 2; ++i) tested.add(make_model("fish"), {.octree = octree});
    return tested.detect().contacts.size();
  }
};

std::vector<Method> all_methods() {
  std::vector<Method> methods;
  for (std::size_t v = 1; v < words<BoundingVolume>.size(); ++v) {
    methods.push_back({std::string("the bounding volume ") + words<BoundingVolume>[v],
                       { .bounding_volume = static_cast<BoundingVolume>(v) }});
  }
  for (std::size_t b = 1; b < words<ObjectOctreeBuild>.size(); ++b) {
    methods.push_back({std::string("the octree build ") + words<ObjectOctreeBuild>[b],
                       {},
                       {.build = static_cast<ObjectOctreeBuild>(b)}});
  }
  for (const BroadPhaseMethod broad_phase :
       {BroadPhaseMethod::sweep, BroadPhaseMethod::brute, BroadPhaseMethod::sweep3})
    methods.push_back({std::string("the broad phase ") + word_of(broad_phase), {.broad_phase = broad_phase}});
  methods.push_back({"the descent one_side_first", {.comparison = {.descent = Descent::one_side_first}}});
  methods.push_back({"the lazy refit", {.comparison = {.lazy_refit = true}}});
  methods.push_back({"the list of colliding vertices", {.comparison = {.colliding_vertices = true}}});
  return methods;
}

TEST(ComparisonMethods, AreRefusedByNameUntilTheyAreInUse) {
  const std::size_t expected = Method{}.contacts();
  EXPECT_GT(expected, 0u);
  for (const Method& method : all_methods()) {
    try {
      method.contacts();
      FAIL() << method.name;
    } catch (const Error& error) {
      EXPECT_EQ(error.what(), method.name +
                                  " is in the library supple::comparison; link it and call "
                                  "supple::use_comparison_methods() first");
    }
  }
  std::thread other(use_comparison_methods);
  use_comparison_methods();
  other.join();
  for (const Method& method : all_methods()) EXPECT_EQ(method.contacts(), expected) << method.name;
}

TEST(Manifolds, AreRefusedByNameUntilTheyAreInUse) {
  Scene scene({.contacts = ContactKinds::penetration});
  for (int i = 0; i < 2; ++i) scene.add(make_model("fish"));
  const auto expect_refused = [](const auto& search, const std::string& what) {
    try {
      search();
      FAIL() << what;
    } catch (const Error& error) {
      EXPECT_EQ(
          error.what(),
          what + " are in the library supple::manifold; link it and call supple::use_manifolds() first");
    }
  };
  expect_refused([&] { scene.detect({.manifolds = true}); }, "manifolds");
  expect_refused([&] { scene.detect({.curves = true}); }, "curves");
  expect_refused([&] { scene.search({.curves = true}); }, "curves");
  EXPECT_GT(scene.detect().contacts.size(), 0u) << "the scene goes on";
  std::thread other(use_manifolds);
  use_manifolds();
  other.join();
  const DetectResult& result = scene.detect({.manifolds = true});
  EXPECT_GT(result.curves.size(), 0u);
  EXPECT_GT(result.manifolds.size(), 0u);
  EXPECT_EQ(result.step, 1u) << "the failed step does not count";
}

}  // namespace supple::comparison_methods_test
