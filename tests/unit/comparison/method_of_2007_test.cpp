// The parts of the paper's program, one at a time and together: the contacts are those of the defaults.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "supple/comparison.hpp"
#include "supple/error.hpp"
#include "supple/inspection.hpp"
#include "supple/models.hpp"
#include "supple/scene.hpp"
#include "supple/verify.hpp"
#include "support/random.hpp"
#include "support/scenes.hpp"
#include "support/soups.hpp"

namespace supple::method_of_2007_test {

/// The volumes and descents that `lazy_refit` allows.
std::vector<SceneOptions> lazy_options() {
  std::vector<SceneOptions> all;
  for (const BoundingVolume volume : {BoundingVolume::aabb, BoundingVolume::sphere}) {
    for (const SphereFit fit : {SphereFit::vertices, SphereFit::minimal, SphereFit::medial}) {
      for (const Descent descent : {Descent::both_sides, Descent::one_side_first}) {
        if (volume == BoundingVolume::aabb && fit != SphereFit::vertices) continue;
        SceneOptions& options = all.emplace_back();
        options.bounding_volume = volume;
        options.threads = static_cast<std::uint32_t>(1 + all.size() % 3);
        options.comparison = {.sphere_fit = fit, .colliding_vertices = true, .descent = descent};
      }
    }
  }
  return all;
}

SceneOptions lazy(SceneOptions options) {
  options.comparison.lazy_refit = true;
  return options;
}

/// Two scenes with the same objects: one refits all nodes, one only where objects meet.
class LazyAndFull {
 public:
  LazyAndFull(const SceneOptions& options, std::uint32_t leaf_size) : full_(options), lazy_(lazy(options)) {
    for (std::uint64_t k = 0; k < 6; ++k) {
      ObjectOptions object;
      object.octree.leaf_size = leaf_size;
      if (k % 2 == 0) object.octree.build = ObjectOctreeBuild::regular;
      object.self_collision = k == 5;
      meshes_.push_back(k < 3 ? random_soup(120, 1, 0.1, k) : make_icosphere(4));
      for (Vec3d& p : meshes_.back().positions) p += Vec3d{0.7 * static_cast<double>(k), 0, 0};
      ids_.push_back(full_.add(meshes_.back(), object));
      lazy_.add(meshes_.back(), object);
    }
  }

  template <class Change>
  void change(const Change& change) {
    change(full_);
    change(lazy_);
  }
  void check(const std::string& what) {
    const DetectResult &full = full_.detect(), &lazily = lazy_.detect();
    EXPECT_EQ(hash_of(lazily), hash_of(full)) << what;
    if (checks_++ % 5 == 0) {
      EXPECT_TRUE(verify(lazy_).agrees()) << what;
    }
    EXPECT_LE(lazily.stats.node_pairs_visited, full.stats.node_pairs_visited) << what;
    read_ += lazily.stats.triangles_refitted;
    contacts_ += full.contacts.size();
  }

  Scene full_, lazy_;
  std::vector<TriangleMesh> meshes_;
  std::vector<ObjectId> ids_;
  std::uint64_t read_ = 0, contacts_ = 0;
  int checks_ = 0;
};

TEST(LazyRefit, FindsWhatAFullRefitFinds) {
  for (const SceneOptions& options : lazy_options()) {
    for (const std::uint32_t leaf_size : {1u, 30u}) {
      LazyAndFull both(options, leaf_size);
      RandomNumbers random(3);
      for (int step = 0; step < 12; ++step) {
        const std::size_t moved = static_cast<std::size_t>(step) % both.ids_.size();
        std::vector<Vec3d> positions = both.meshes_[moved].positions;
        for (Vec3d& p : positions) {
          for (int axis = 0; axis < 3; ++axis) p[axis] += random.uniform(-0.2, 0.2);
        }
        const ObjectId id = both.ids_[moved], other = both.ids_[(moved + 2) % both.ids_.size()];
        both.change([&](Scene& scene) {
          scene.set_positions(id, positions);
          if (step % 3 == 1) scene.translate(other, {0.1, 0.03, -0.02});
          if (step % 4 == 2) scene.set_vertices(id, std::array{0u, 5u}, std::array{Vec3d{}, Vec3d{1, 1, 1}});
          if (step == 7) scene.set_positions(other, both.meshes_[(moved + 2) % both.ids_.size()].positions);
        });
        both.check("step " + std::to_string(step));
      }
      EXPECT_GT(both.contacts_, 500u);
    }
  }
}

TEST(LazyRefit, ReadsLittleWhereLittleMeets) {
  Scene scene(lazy({.threads = 1}));
  const TriangleMesh ball = make_icosphere(20);
  const ObjectId a = scene.add(ball), b = scene.add(ball);
  scene.translate(b, {5, 0, 0});
  scene.detect();
  scene.set_positions(a, ball.positions);
  EXPECT_EQ(scene.detect().stats.triangles_refitted, 0u) << "the balls are apart";
  scene.translate(b, {-3.01, 0, 0});
  scene.set_positions(a, ball.positions);
  const DetectResult& result = scene.detect();
  EXPECT_GT(result.contacts.size(), 0u);
  EXPECT_LT(result.stats.triangles_refitted, 6 * ball.triangles.size());
}

TEST(LazyRefit, OfVerticesThatAreNotFiniteRefitsAll) {
  for (const SceneOptions& options : lazy_options()) {
    LazyAndFull both(options, 4);
    std::vector<Vec3d> positions = both.meshes_[1].positions;
    positions[3].y = std::numeric_limits<double>::quiet_NaN();
    positions[10].x = std::numeric_limits<double>::infinity();
    both.change([&](Scene& scene) { scene.set_positions(both.ids_[1], positions); });
    both.check("NaN");
    EXPECT_EQ(both.lazy_.result().non_finite_vertices.size(), 2u);
    both.change([&](Scene& scene) { scene.set_positions(both.ids_[1], both.meshes_[1].positions); });
    both.check("finite again");
    EXPECT_EQ(both.lazy_.result().non_finite_vertices.size(), 0u);
  }
}

TEST(LazyRefit, QueriesOtherKindsAndTheInspectorSeeAllNodes) {
  for (const SceneOptions& options : lazy_options()) {
    LazyAndFull both(options, 8);
    for (TriangleMesh& mesh : both.meshes_) {
      for (Vec3d& p : mesh.positions) p = {1.5 * p.y, p.x, p.z * p.x};
    }
    both.change([&](Scene& scene) {
      for (std::size_t k = 0; k < both.ids_.size(); ++k)
        scene.set_positions(both.ids_[k], both.meshes_[k].positions);
    });
    both.check("bent");
    const SceneInspector full(both.full_), lazily(both.lazy_);
    for (const ObjectId id : both.ids_) {
      const auto expected = full.cells(id), found = lazily.cells(id);
      ASSERT_EQ(found.size(), expected.size());
      for (std::size_t i = 0; i < found.size(); ++i) {
        for (int axis = 0; axis < 3; ++axis) {
          EXPECT_EQ(found[i].box.min[axis], expected[i].box.min[axis]);
          EXPECT_EQ(found[i].box.max[axis], expected[i].box.max[axis]);
        }
      }
    }
    both.change([&](Scene& scene) { scene.set_positions(both.ids_[0], both.meshes_[1].positions); });
    const std::vector<Vec3d> points{{0, 0, 0}, {1, 1, 1}, {-1, 2, 0.5}};
    std::vector<std::optional<ClosestPoint>> near(points.size()), expected_near(points.size());
    both.lazy_.closest(points, near);
    both.full_.closest(points, expected_near);
    for (std::size_t i = 0; i < points.size(); ++i) EXPECT_EQ(near[i]->distance, expected_near[i]->distance);
    both.check("after queries");
    both.change([&](Scene& scene) { scene.detect({.contacts = ContactKinds::continuous}); });
    both.check("after another kind");
  }
}

TEST(LazyRefit, TakesBoundsThatTheMotionFound) {
  for (const SceneOptions& options : lazy_options()) {
    Scene plain(lazy(options)), given(lazy(options));
    const TriangleMesh ball = make_icosphere(5);
    const ObjectId a = plain.add(ball), b = plain.add(ball);
    given.add(ball);
    given.add(ball);
    for (int step = 0; step < 5; ++step) {
      std::vector<Vec3d> positions = ball.positions;
      std::array<Vec3d, 2> bounds{Vec3d{9, 9, 9}, Vec3d{-9, -9, -9}};
      for (Vec3d& p : positions) {
        p = {p.x + 0.4 * step, p.y * (1 + 0.1 * step), p.z};
        for (int axis = 0; axis < 3; ++axis) {
          bounds[0][axis] = std::min(bounds[0][axis], p[axis]);
          bounds[1][axis] = std::max(bounds[1][axis], p[axis]);
        }
      }
      plain.set_positions(a, positions);
      given.set_positions(a, positions, bounds);
      plain.translate(b, {0, 0.1, 0});
      given.translate(b, {0, 0.1, 0});
      EXPECT_EQ(hash_of(given.detect()), hash_of(plain.detect())) << step;
    }
    // A translation beyond 1e30 is added to the positions; the bounds are those from before.
    TriangleMesh large = ball;
    for (Vec3d& p : large.positions) p = p * 1e29;
    for (Scene* const scene : {&plain, &given}) {
      if (scene == &plain) scene->set_positions(a, large.positions);
      if (scene == &given)
        scene->set_positions(a, large.positions, {{Vec3d{-1e29, -1e29, -1e29}, Vec3d{1e29, 1e29, 1e29}}});
      scene->set_positions(b, large.positions);
      for (const ObjectId id : {a, b}) scene->translate(id, {2e30, 0, 0});
    }
    EXPECT_EQ(hash_of(given.detect()), hash_of(plain.detect()));
    EXPECT_FALSE(given.result().contacts.empty());
    EXPECT_TRUE(verify(given).agrees());
    constexpr double inf = std::numeric_limits<double>::infinity();
    EXPECT_THROW(given.set_positions(a, ball.positions, {{Vec3d{-inf, 0, 0}, Vec3d{1, 1, 1}}}), Error);
  }
}

/// A mesh in which each third vertex, also the first and the last, is far away and of no triangle.
TriangleMesh with_unused_vertices(const TriangleMesh& mesh) {
  const auto place_of = [](std::uint32_t vertex) { return vertex + vertex / 2 + 1; };
  const auto count = static_cast<std::uint32_t>(mesh.positions.size());
  TriangleMesh result{mesh.name, std::vector<Vec3d>(place_of(count - 1) + 2, Vec3d{50, 50, 50}),
                      mesh.triangles};
  for (std::uint32_t v = 0; v < count; ++v) result.positions[place_of(v)] = mesh.positions[v];
  for (Triangle& triangle : result.triangles) {
    for (std::uint32_t& vertex : triangle) vertex = place_of(vertex);
  }
  return result;
}

TEST(LazyRefit, GivesAnObjectTheVolumesOfAFullRefit) {
  for (const BoundingVolume volume : {BoundingVolume::aabb, BoundingVolume::sphere}) {
    const SceneOptions options{.bounding_volume = volume, .threads = 1};
    Scene full(options), lazily(lazy(options));
    const std::vector<TriangleMesh> meshes{make_icosphere(3),
                                           with_unused_vertices(random_soup(90, 1, 0.1, 4)),
                                           make_model("pawn"), with_unused_vertices(make_model("fish"))};
    for (Scene* const scene : {&full, &lazily}) {
      for (const TriangleMesh& mesh : meshes) scene->add(mesh, {.octree = octree_of_2007()});
    }
    for (int step = 0; step < 4; ++step) {
      const std::vector<ObjectId> ids = full.objects();
      for (std::size_t i = 0; i < ids.size(); ++i) {
        std::vector<Vec3d> positions = meshes[i].positions;
        for (Vec3d& p : positions)
          p = {p.x, p.y * (1 + 0.2 * step * p.x), p.z + 7.0 * static_cast<double>(i)};
        for (Scene* const scene : {&full, &lazily}) scene->set_positions(ids[i], positions);
      }
      full.detect();
      lazily.detect();
      for (const ObjectId id : ids) {
        const OctreeCell expected = SceneInspector(full).cells(id, 0)[0];
        const OctreeCell found = SceneInspector(lazily).cells(id, 0)[0];
        EXPECT_EQ(found.sphere.radius, expected.sphere.radius);
        for (int axis = 0; axis < 3; ++axis) {
          EXPECT_EQ(found.sphere.center[axis], expected.sphere.center[axis]);
          EXPECT_EQ(SceneInspector(lazily).bounds(id).min[axis], SceneInspector(full).bounds(id).min[axis]);
          EXPECT_EQ(SceneInspector(lazily).bounds(id).max[axis], SceneInspector(full).bounds(id).max[axis]);
        }
      }
    }
  }
}

TEST(LazyRefit, NeedsBoxesOrSpheres) {
  SceneOptions options = lazy({.bounding_volume = BoundingVolume::obb});
  EXPECT_THROW(Scene{options}, Error);
  options.comparison = {.descent = Descent::one_side_first};
  EXPECT_THROW(Scene{options}, Error);
}

/// Counts the tests of Figure 4 on the cells of the inspector.
std::uint64_t tests_of_figure_4(const Scene& scene, ObjectId a, ObjectId b) {
  const SceneInspector inspector(scene);
  const NodePairList list = inspector.node_pairs(a, b);
  const auto children = [&](ObjectId object, const OctreeCell& cell, std::uint64_t arity) {
    std::vector<OctreeCell> found;
    for (const OctreeCell& other : inspector.cells(object, cell.level + 1)) {
      if (other.level != cell.level + 1) continue;
      std::uint64_t above = *other.number;
      while (above > *cell.number) above = (above - 1) / arity;
      if (above == *cell.number) found.push_back(other);
    }
    return found;
  };
  std::uint64_t tests = 0;
  for (const NodePairList::Pair& pair : list.pairs) {
    const OctreeCell &cell_a = list.nodes_a[pair.a], &cell_b = list.nodes_b[pair.b];
    if (cell_a.is_leaf && cell_b.is_leaf) continue;
    const auto of_a = children(a, cell_a, 8), of_b = children(b, cell_b, 8);
    if (cell_a.is_leaf || cell_b.is_leaf) {
      tests += std::max(of_a.size(), of_b.size());
      continue;
    }
    for (const OctreeCell& child : of_a) {
      const bool collides = child.box.min.x <= cell_b.box.max.x && cell_b.box.min.x <= child.box.max.x &&
                            child.box.min.y <= cell_b.box.max.y && cell_b.box.min.y <= child.box.max.y &&
                            child.box.min.z <= cell_b.box.max.z && cell_b.box.min.z <= child.box.max.z;
      tests += 1 + (collides ? of_b.size() : 0);
    }
  }
  return tests;
}

TEST(OneSideFirst, CountsTheTestsOfFigure4) {
  SceneOptions options{.contacts = ContactKinds::none, .threads = 1};
  options.comparison.descent = Descent::one_side_first;
  for (const auto& [count_a, count_b] : {std::pair(80u, 60u), {1u, 60u}, {60u, 1u}, {1u, 1u}}) {
    Scene scene(options);
    const ObjectOptions object{.octree = octree_of_2007()};
    const ObjectId a = scene.add(random_soup(count_a, 1, 0.3, 1), object);
    const ObjectId b = scene.add(random_soup(count_b, 1, 0.3, 2), object);
    const DetectResult& result = scene.detect();
    EXPECT_EQ(result.stats.boxes_tested, tests_of_figure_4(scene, a, b));
    if (count_a == 80) {
      EXPECT_GT(result.stats.boxes_tested, 500u);
    }
    if (count_a + count_b == 61) {
      EXPECT_EQ(result.object_pairs.size(), 1u);
      EXPECT_GT(result.stats.boxes_tested, 0u);
    }
  }
}

TEST(MethodOf2007, HasTheRootAndItsChildrenAlways) {
  SceneOptions options = with_method_of_2007({.threads = 1});
  options.scene_octree.root = RootCube{{-4, -4, -4}, 8};
  Scene scene(options);
  const ObjectOptions object{.octree = octree_of_2007()};
  const ObjectId a = scene.add(make_icosphere(2), object), b = scene.add(make_icosphere(2), object);
  scene.translate(a, {-2.5, -2.5, -2.5});
  scene.translate(b, {2.5, 2.5, 2.5});
  scene.detect();
  const SceneInspector inspector(scene);
  EXPECT_EQ(inspector.regions().size(), 9u) << "no region has two objects";
  scene.translate(b, {-4, -4, -4});
  scene.detect();
  // Both are in one octant, which divides down to level 2. The objects are as large as its children.
  EXPECT_EQ(inspector.regions().size(), 17u);
  EXPECT_TRUE(inspector.regions().back().is_leaf);
  options.scene_octree.max_level = 0;
  EXPECT_THROW(Scene{options}, Error);
  options.scene_octree.max_level = most_full_levels + 1;
  EXPECT_THROW(Scene{options}, Error);
}

TEST(MethodOf2007, FindsTheContactsOfTheDefaults) {
  for (const BoundingVolume volume : {BoundingVolume::aabb, BoundingVolume::sphere}) {
    SceneOptions options = with_method_of_2007({.bounding_volume = volume, .threads = 1});
    options.scene_octree.root = RootCube{{-3, -3, -3}, 6};
    Scene as_2007(options), defaults;
    std::vector<ObjectId> ids;
    std::vector<TriangleMesh> meshes;
    for (const char* const name : {"pawn", "fish", "rabbit"}) {
      meshes.push_back(make_model(name));
      ids.push_back(as_2007.add(meshes.back(), {.octree = octree_of_2007()}));
      defaults.add(meshes.back());
    }
    std::size_t contacts = 0;
    for (int step = 0; step < 10; ++step) {
      for (std::size_t k = 0; k < ids.size(); ++k) {
        std::vector<Vec3d> positions = meshes[k].positions;
        for (Vec3d& p : positions) p = {p.x + 0.05 * step * p.y, p.y + 0.1 * static_cast<double>(k), p.z};
        as_2007.set_positions(ids[k], positions);
        defaults.set_positions(ids[k], positions);
      }
      const auto &found = as_2007.detect().contacts, &expected = defaults.detect().contacts;
      ASSERT_EQ(found.size(), expected.size());
      for (std::size_t i = 0; i < found.size(); ++i) {
        EXPECT_EQ(found[i].triangle_a, expected[i].triangle_a);
        EXPECT_EQ(found[i].triangle_b, expected[i].triangle_b);
      }
      contacts += expected.size();
      EXPECT_FALSE(as_2007.result().colliding_vertices.empty());
    }
    EXPECT_GT(contacts, 100u);
  }
}

}  // namespace supple::method_of_2007_test
