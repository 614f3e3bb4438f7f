// `Scene::set_vertices` and the refit of the part that moved: bits equal to those of a full refit.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>
#include <string>
#include <tuple>
#include <vector>

#include "octree/object_octree.hpp"
#include "supple/error.hpp"
#include "supple/inspection.hpp"
#include "supple/models.hpp"
#include "supple/scene.hpp"
#include "support/scenes.hpp"
#include "support/soups.hpp"

namespace supple::set_vertices_test {

template <class Element>
bool same_bits(const Element* a, const Element* b, std::size_t count) {
  return std::memcmp(a, b, count * sizeof(Element)) == 0;
}

/// Some vertices of a mesh: scattered ones, or neighbours in the numbering.
std::vector<std::uint32_t> some_vertices(std::uint32_t vertex_count, RandomNumbers& random) {
  std::vector<std::uint32_t> ids;
  const std::uint32_t count = random.below(1 + vertex_count / 10), first = random.below(vertex_count);
  const bool scattered = random.below(2) == 0;
  for (std::uint32_t i = 0; i < count; ++i)
    ids.push_back(scattered ? random.below(vertex_count) : (first + i) % vertex_count);
  return ids;
}

TEST(RefitMoved, HasTheBitsOfAFullRefit) {
  for (const bool is_double : {false, true}) {
    for (const auto& [fit, build, arity] : {std::tuple{SphereFit::vertices, ObjectOctreeBuild::balanced, 8u},
                                            {SphereFit::minimal, ObjectOctreeBuild::bottom_up, 8u},
                                            {SphereFit::minimal, ObjectOctreeBuild::regular, 2u},
                                            {SphereFit::medial, ObjectOctreeBuild::balanced, 8u},
                                            {SphereFit::box, ObjectOctreeBuild::regular, 4u}}) {
      TriangleMesh mesh = make_model("human");
      mesh.positions.push_back({0, 0, 0});  // in no triangle
      RandomNumbers random(7);
      const ObjectOctreeOptions options{.leaf_size = 5, .arity = arity, .build = build};
      ObjectOctree part(mesh.positions, mesh.triangles, options, BoundingVolume::sphere, fit),
          all(mesh.positions, mesh.triangles, options, BoundingVolume::sphere, fit);
      const Parallel one(1), four(4);
      VertexBuffer vertices;
      std::vector<Vec3f> floats(mesh.positions.size());
      const auto assign = [&] {
        for (std::size_t v = 0; v < floats.size(); ++v) {
          for (int axis = 0; axis < 3; ++axis) floats[v][axis] = static_cast<float>(mesh.positions[v][axis]);
        }
        is_double ? vertices.assign(mesh.positions, one) : vertices.assign(floats, one);
      };
      assign();
      ASSERT_TRUE(part.refit(vertices, {}, one));
      // A refit that is refused leaves nothing behind.
      const std::uint32_t last = static_cast<std::uint32_t>(mesh.positions.size()) - 1;
      for (const std::uint32_t vertex : {100u, last}) {
        const Vec3d kept = mesh.positions[vertex];
        mesh.positions[vertex].y = std::numeric_limits<double>::quiet_NaN();
        assign();
        EXPECT_FALSE(part.refit_moved(vertices, std::vector{0u, 1u, 2u, vertex}, one));
        mesh.positions[vertex] = kept;
      }
      for (int step = 0; step < 12; ++step) {
        const auto ids = some_vertices(static_cast<std::uint32_t>(mesh.positions.size()), random);
        for (const std::uint32_t v : ids) mesh.positions[v] += random.vector(0.05);
        assign();
        const auto triangles = part.refit_moved(vertices, ids, step % 2 == 0 ? one : four);
        ASSERT_TRUE(triangles);
        EXPECT_LE(*triangles, mesh.triangles.size());
        EXPECT_EQ(*triangles == 0, ids.empty() || (ids.size() == 1 && ids[0] + 1 == mesh.positions.size()));
        ASSERT_TRUE(all.refit(vertices, {}, one));
        const std::size_t nodes = all.nodes().size();
        ASSERT_TRUE(same_bits(part.boxes(), all.boxes(), nodes)) << step;
        for (std::uint32_t n = 0; n < nodes; ++n) {
          for (int child = 0; child < node_width; ++child)
            ASSERT_EQ(part.volumes()->sphere(n, child), all.volumes()->sphere(n, child)) << step;
        }
        ASSERT_EQ(part.box(), all.box());
        ASSERT_EQ(part.sphere(), all.sphere());
      }
    }
  }
}

/// Two scenes with the same objects: one sets vertices, the other one sets all positions.
struct Pair {
  explicit Pair(const SceneOptions& options) : part(options), all(options) {
    for (const char* model : {"fish", "pawn"}) {
      meshes.push_back(make_model(model));
      const ObjectOptions object{.self_collision = meshes.size() == 1,
                                 .octree = {.leaf_size = 8, .build = ObjectOctreeBuild::bottom_up}};
      part_ids.push_back(part.add(meshes.back(), object));
      all_ids.push_back(all.add(meshes.back(), object));
    }
    transforms.resize(meshes.size());
    offsets.resize(meshes.size());
  }

  void set_vertices(std::size_t i, const std::vector<std::uint32_t>& ids, RandomNumbers& random,
                    bool break_one) {
    std::vector<Vec3d> positions;
    for (const std::uint32_t v : ids) {
      Vec3d& p = meshes[i].positions[v];
      if (!std::isfinite(p.x)) p.x = 0;
      p += random.vector(0.02);
      if (break_one && v % 16 == 0) p.x = std::numeric_limits<double>::quiet_NaN();
    }
    for (const std::uint32_t v : ids) positions.push_back(meshes[i].positions[v]);
    part.set_vertices(part_ids[i], ids, positions);
  }
  void place(std::size_t i, const RigidTransform& transform) {
    transforms[i] = transform;
    offsets[i] = {};
    part.set_transform(part_ids[i], transform);
  }
  void translate(std::size_t i, Vec3d offset) {
    offsets[i].push_back(offset);
    part.translate(part_ids[i], offset);
  }

  void expect_equal_steps(int step) {
    for (std::size_t i = 0; i < meshes.size(); ++i) {
      all.set_positions(all_ids[i], meshes[i].positions);
      all.set_transform(all_ids[i], transforms[i]);
      for (const Vec3d& offset : offsets[i]) all.translate(all_ids[i], offset);
    }
    const DetectResult& found = part.detect();
    const DetectResult& expected = all.detect();
    ASSERT_EQ(hash_of(found), hash_of(expected)) << step;
    ASSERT_EQ(found.non_finite_vertices.size(), expected.non_finite_vertices.size());
    ASSERT_EQ(SceneInspector(part).validate(), "") << step;
    contacts += found.contacts.size();
  }

  Scene part, all;
  std::vector<TriangleMesh> meshes;
  std::vector<ObjectId> part_ids, all_ids;
  std::vector<RigidTransform> transforms;
  std::vector<std::vector<Vec3d>> offsets;  // since the transform
  std::size_t contacts = 0;
};

TEST(SetVertices, EqualsSettingAllPositions) {
  for (const BoundingVolume volume : {BoundingVolume::aabb, BoundingVolume::sphere}) {
    for (const ContactKinds kinds :
         {ContactKinds::intersection, ContactKinds::intersection | ContactKinds::continuous}) {
      Pair pair({.bounding_volume = volume, .contacts = kinds, .threads = 2});
      RandomNumbers random(11);
      for (int step = 0; step < 15; ++step) {
        for (std::size_t i = 0; i < 2; ++i) {
          const auto count = static_cast<std::uint32_t>(pair.meshes[i].positions.size());
          for (std::uint32_t calls = random.below(3); calls-- > 0;)
            pair.set_vertices(i, some_vertices(count, random), random, random.below(8) == 0);
          if (random.below(6) == 0) {
            const double c = random.uniform(-1, 1), s = random.uniform(-1, 1);
            pair.place(i, {{c, -s, 0, s, c, 0, 0, 0, 1}, random.vector(0.1)});
          }
          if (random.below(6) == 0) pair.translate(i, random.vector(random.below(6) == 0 ? 1e31 : 0.1));
        }
        pair.expect_equal_steps(step);
        if (HasFatalFailure()) return;
      }
      EXPECT_GT(pair.contacts, 100u);
    }
  }
}

TEST(SetVertices, RefitsOnlyThePartThatMoved) {
  const TriangleMesh mesh = make_icosphere(60);
  Scene scene({.threads = 1});
  const ObjectId id = scene.add(mesh);
  EXPECT_EQ(scene.detect().stats.triangles_refitted, 0u) << "add refits";
  const Triangle& triangle = mesh.triangles[1234];
  const std::vector<std::uint32_t> ids(triangle.begin(), triangle.end());
  const std::vector<Vec3d> raised{{2, 0, 0}, {0, 2, 0}, {0, 0, 2}};
  scene.set_vertices(id, ids, raised);
  const std::uint64_t refitted = scene.detect().stats.triangles_refitted;
  EXPECT_GE(refitted, 10u) << "all triangles around the three vertices";
  EXPECT_LE(refitted, mesh.triangles.size() / 8);
  EXPECT_EQ(scene.result().stats.objects_refitted, 1u);
  EXPECT_EQ(scene.position(id, ids[1]), raised[1]);
  EXPECT_EQ(scene.detect().stats.triangles_refitted, 0u);

  scene.set_vertices(id, {}, std::vector<Vec3d>());
  EXPECT_EQ(scene.detect().stats.triangles_refitted, 0u);
  std::vector<std::uint32_t> all(mesh.positions.size());
  std::iota(all.begin(), all.end(), 0u);
  scene.set_vertices(id, all, mesh.positions);
  EXPECT_EQ(scene.detect().stats.triangles_refitted, mesh.triangles.size());
  scene.set_positions(id, mesh.positions);
  scene.set_vertices(id, ids, raised);
  EXPECT_EQ(scene.detect().stats.triangles_refitted, mesh.triangles.size());
}

TEST(SetVertices, CopiesSharedPositions) {
  const TriangleMesh mesh = make_icosphere(8);
  std::vector<Vec3d> shared = mesh.positions;
  Scene scene;
  const ObjectId id = scene.add(mesh);
  scene.share_positions(id, shared);
  scene.detect();
  scene.set_vertices(id, std::vector{3u}, std::vector{Vec3d{5, 5, 5}});
  EXPECT_EQ(shared, mesh.positions) << "the user's memory stays";
  std::fill(shared.begin(), shared.end(), Vec3d{});
  scene.detect();
  EXPECT_EQ(SceneInspector(scene).validate(), "");
  EXPECT_EQ(scene.position(id, 3), (Vec3d{5, 5, 5}));
  EXPECT_EQ(scene.position(id, 4), mesh.positions[4]);
}

TEST(SetVertices, EndsAPath) {
  const TriangleMesh mesh = make_icosphere(4);
  Scene scene({.contacts = ContactKinds::continuous});
  const ObjectId id = scene.add(mesh);
  std::vector<Vec3d> to = mesh.positions;
  for (Vec3d& p : to) p.x += 3;
  scene.set_motion(id, mesh.positions, to);
  scene.add(TriangleMesh{"wall", {{1.5, -9, -9}, {1.5, 9, -9}, {1.5, 0, 9}}, {{0, 1, 2}}});
  EXPECT_GT(scene.detect().continuous_contacts.size(), 0u);
  scene.set_vertices(id, std::vector{0u}, std::vector{to[0]});
  EXPECT_EQ(scene.detect().continuous_contacts.size(), 0u);
  EXPECT_EQ(scene.position(id, 1), to[1]);
}

TEST(SetVertices, ReportsWhatIsWrong) {
  const auto error_of = [](const auto& call) -> std::string {
    try {
      call();
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  Scene scene;
  const ObjectId id = scene.add(make_icosphere(2), {.name = "ball"});
  const ObjectId fixed = scene.add(make_icosphere(2), {.name = "floor", .is_static = true});
  const std::vector<Vec3d> one{{1, 2, 3}};
  const std::vector<Vec3f> one_float{{1, 2, 3}};
  EXPECT_EQ(error_of([&] {
              scene.set_vertices(id, std::vector{0u, 1u}, one);
            }),
            "set_vertices: 1 positions for 2 vertices of ball; give one for each vertex");
  EXPECT_EQ(error_of([&] { scene.set_vertices(id, std::vector{42u}, one); }),
            "set_vertices: ball has no vertex 42; it has 42, numbered from 0");
  EXPECT_EQ(error_of([&] { scene.set_vertices(id, std::vector{0u}, one_float); }),
            "set_vertices: the positions are float, those of ball are double; give both in one precision");
  EXPECT_NE(error_of([&] { scene.set_vertices(fixed, std::vector{0u}, one); }).find("floor is static"),
            std::string::npos);
}

}  // namespace supple::set_vertices_test
