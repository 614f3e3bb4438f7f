// Edits of meshes: answers are those of a scene to which the edited mesh was added.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "supple/error.hpp"
#include "supple/inspection.hpp"
#include "supple/models.hpp"
#include "supple/scene.hpp"
#include "supple/verify.hpp"
#include "support/random.hpp"

namespace supple::edit_test {

using Ids = std::vector<std::uint32_t>;
constexpr ContactKinds all_kinds = ContactKinds::intersection | ContactKinds::continuous |
                                   ContactKinds::proximity | ContactKinds::penetration;

/// A mesh that is edited. Removed triangles keep their places.
struct EditedMesh {
  TriangleMesh mesh;
  std::vector<Vec3d> from;  ///< starts of a path, or empty
  Ids removed;
  ObjectOptions options;
  ObjectId id{};

  bool has(std::uint32_t triangle) const { return std::ranges::find(removed, triangle) == removed.end(); }
  Vec3d center(const Triangle& t) const {
    Vec3d sum;
    for (const std::uint32_t v : t) {
      for (int axis = 0; axis < 3; ++axis) sum[axis] += mesh.positions[v][axis] / 3;
    }
    return sum;
  }

  /// Adds the mesh to a scene of its own. Removed triangles are one point, far away.
  void add_to(Scene& scene) const {
    TriangleMesh fresh = mesh;
    std::vector<Vec3d> starts = from;
    for (auto* const positions : {&fresh.positions, &starts}) positions->push_back({1e6, 1e6 + id.index, 0});
    const auto far = static_cast<std::uint32_t>(mesh.positions.size());
    for (const std::uint32_t triangle : removed) fresh.triangles[triangle] = {far, far, far};
    const ObjectId added = scene.add(fresh, options);
    if (!from.empty()) scene.set_motion(added, starts, fresh.positions);
  }

  /// Edits the object in the scene, and this mesh alike.
  void edit(Scene& scene, const Ids& gone, const std::vector<Triangle>& added,
            const std::vector<Vec3d>& vertices, const std::vector<Vec3d>& starts) {
    scene.edit(id, {.removed = gone, .added = added, .new_vertices = vertices, .new_starts = starts});
    removed.insert(removed.end(), gone.begin(), gone.end());
    mesh.positions.insert(mesh.positions.end(), vertices.begin(), vertices.end());
    mesh.triangles.insert(mesh.triangles.end(), added.begin(), added.end());
    from.insert(from.end(), starts.begin(), starts.end());
  }
};

/// A patch around a triangle is removed, and some triangles of it come back or change their corners.
void cut(EditedMesh& object, Scene& scene, RandomNumbers& random) {
  TriangleMesh& mesh = object.mesh;
  const std::uint32_t middle = random.below(static_cast<std::uint32_t>(mesh.triangles.size()));
  const Vec3d center = object.center(mesh.triangles[middle]);
  const double radius = random.uniform(0, 0.4);
  Ids removed, corners;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vec3d c = object.center(mesh.triangles[t]);
    if (!object.has(t) || std::hypot(c.x - center.x, c.y - center.y, c.z - center.z) > radius) continue;
    corners.insert(corners.end(), mesh.triangles[t].begin(), mesh.triangles[t].end());
    if (random.below(4) > 0) removed.push_back(t);
  }
  random.shuffle(removed);
  std::vector<Vec3d> vertices, starts;
  for (std::uint32_t k = random.below(6); k > 0; --k) {
    const Vec3d p = random.vector(0.1);
    vertices.push_back({center.x + p.x, center.y + p.y, center.z + p.z});
    if (!object.from.empty()) starts.push_back({center.x + p.z, center.y + p.x, center.z + p.y});
    corners.push_back(static_cast<std::uint32_t>(mesh.positions.size() + vertices.size() - 1));
  }
  std::vector<Triangle> added;
  for (std::uint32_t k = random.below(30); k > 0 && !corners.empty(); --k) {
    const auto corner = [&] { return corners[random.below(static_cast<std::uint32_t>(corners.size()))]; };
    added.push_back({corner(), corner(), corner()});
  }
  object.edit(scene, removed, added, vertices, starts);
}

/// Some triangles become three around a new vertex, so a closed surface stays closed.
void split(EditedMesh& object, Scene& scene, RandomNumbers& random) {
  TriangleMesh& mesh = object.mesh;
  Ids removed;
  std::vector<Vec3d> vertices, starts;
  std::vector<Triangle> added;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    if (!object.has(t) || random.below(20) > 0) continue;
    removed.push_back(t);
    const auto v = static_cast<std::uint32_t>(mesh.positions.size() + vertices.size());
    vertices.push_back(object.center(mesh.triangles[t]));
    if (!object.from.empty()) starts.push_back(vertices.back());
    const auto [p, q, r] = mesh.triangles[t];
    added.insert(added.end(), {{p, q, v}, {q, r, v}, {r, p, v}});
  }
  object.edit(scene, removed, added, vertices, starts);
}

void move(EditedMesh& object, Scene& scene, RandomNumbers& random) {
  const Vec3d offset = random.vector(0.1);
  std::vector<Vec3d> to = object.mesh.positions;
  for (Vec3d& p : to) {
    const Vec3d shake = random.vector(0.02);
    p = {p.x + offset.x + shake.x, p.y + offset.y + shake.y, p.z + offset.z + shake.z};
  }
  if (random.below(2) == 0) {
    scene.set_motion(object.id, object.mesh.positions, to);
    object.from = object.mesh.positions;
  } else {
    scene.set_positions(object.id, to);
    object.from.clear();
  }
  object.mesh.positions = to;
}

template <class Value>
bool same(std::span<const Value> a, std::span<const Value> b) {
  return std::ranges::equal(a, b);
}

void expect_same(const DetectResult& edited, const DetectResult& fresh) {
  EXPECT_TRUE(same(edited.contacts, fresh.contacts))
      << edited.contacts.size() << " " << fresh.contacts.size();
  EXPECT_TRUE(same(edited.contact_points, fresh.contact_points));
  EXPECT_TRUE(same(edited.continuous_contacts, fresh.continuous_contacts));
  EXPECT_TRUE(same(edited.proximity_pairs, fresh.proximity_pairs));
  EXPECT_TRUE(same(edited.penetrations, fresh.penetrations));
  EXPECT_TRUE(same(edited.vertices_on_surface, fresh.vertices_on_surface));
  EXPECT_TRUE(same(edited.curve_contacts, fresh.curve_contacts));
  EXPECT_TRUE(same(edited.enclosed_vertices, fresh.enclosed_vertices));
}

void expect_same_queries(const Scene& edited, const Scene& fresh, RandomNumbers& random, ObjectId a,
                         ObjectId b) {
  std::vector<Vec3d> points;
  std::vector<Ray> rays;
  for (int i = 0; i < 40; ++i) {
    points.push_back(random.vector(1.5));
    rays.push_back({points.back(), random.vector(1)});
  }
  std::vector<std::optional<ClosestPoint>> near_edited(points.size()), near_fresh(points.size());
  edited.closest(points, near_edited);
  fresh.closest(points, near_fresh);
  EXPECT_EQ(near_edited, near_fresh);
  std::vector<std::optional<RayHit>> hit_edited(rays.size()), hit_fresh(rays.size());
  edited.cast(rays, hit_edited);
  fresh.cast(rays, hit_fresh);
  EXPECT_EQ(hit_edited, hit_fresh);
  EXPECT_EQ(edited.distance(a, b), fresh.distance(a, b));
  EXPECT_EQ(edited.any_contact(a, b), fresh.any_contact(a, b));
}

TEST(Edit, AnswersAreThoseOfAFreshScene) {
#ifdef NDEBUG
  constexpr int lives = 24;
#else
  constexpr int lives = 4;
#endif
  std::size_t contacts = 0, crossings = 0, near = 0, inside = 0;
  for (int life = 0; life < lives; ++life) {
    SCOPED_TRACE(life);
    RandomNumbers random(static_cast<std::uint64_t>(life));
    SceneOptions options;
    options.contacts = life % 2 == 0 ? all_kinds : ContactKinds::intersection;
    options.bounding_volume = life % 8 == 7 ? BoundingVolume::sphere : BoundingVolume::aabb;
    Scene scene(options);
    std::vector<EditedMesh> objects(3);
    objects[0].mesh = make_icosphere(12);
    objects[1].mesh = make_cloth(24, 24, 2, 2);
    objects[2].mesh = make_icosphere(8);
    objects[0].options = {.name = "ball", .self_collision = life % 3 == 0, .margin = 0.01};
    objects[1].options = {.name = "cloth", .self_collision = life % 3 == 1, .margin = 0.01};
    objects[2].options = {.name = "solid", .margin = 0.01, .solid = true};
    for (EditedMesh& object : objects) {
      const Vec3d offset = random.vector(0.5);
      for (Vec3d& p : object.mesh.positions) p = {p.x + offset.x, p.y + offset.y, p.z + offset.z};
      if (life % 4 == 3) object.options.octree.leaf_size = 1 + random.below(16);
      object.id = scene.add(object.mesh, object.options);
    }
    for (int step = 0; step < 8; ++step) {
      SCOPED_TRACE(step);
      for (EditedMesh& object : objects) {
        if (random.below(2) == 0) move(object, scene, random);
        if (object.options.solid) {
          split(object, scene, random);
        } else {
          for (std::uint32_t edits = random.below(3); edits > 0; --edits) cut(object, scene, random);
        }
      }
      scene.detect();
      Scene fresh(options);
      for (const EditedMesh& object : objects) object.add_to(fresh);
      fresh.detect();
      expect_same(scene.result(), fresh.result());
      EXPECT_EQ(SceneInspector(scene).validate(), "");
      expect_same_queries(scene, fresh, random, objects[0].id, objects[1].id);
      EXPECT_EQ(scene.earliest_impact(), fresh.earliest_impact());
      contacts += scene.result().contacts.size();
      crossings += scene.result().continuous_contacts.size();
      near += scene.result().proximity_pairs.size();
      inside += scene.result().penetrations.size();
      if (testing::Test::HasFailure()) return;
    }
  }
  EXPECT_GT(std::min({contacts, crossings, near, inside}), 100u);
}

TEST(Edit, CompactRenumbersInOrder) {
  RandomNumbers random(5);
  Scene scene;
  EditedMesh object;
  object.mesh = make_icosphere(10);
  object.options = {.self_collision = true};
  object.id = scene.add(object.mesh, object.options);
  for (int i = 0; i < 20; ++i) cut(object, scene, random);
  scene.detect();
  const std::vector<Contact> before(scene.result().contacts.begin(), scene.result().contacts.end());
  ASSERT_GT(before.size(), 10u);
  const Ids numbers = scene.compact(object.id);
  EXPECT_EQ(numbers.size(), object.mesh.triangles.size());
  EXPECT_EQ(scene.triangle_count(object.id), object.mesh.triangles.size() - object.removed.size());
  std::uint32_t next = 0;
  for (std::uint32_t t = 0; t < numbers.size(); ++t)
    EXPECT_EQ(numbers[t], object.has(t) ? next++ : ~std::uint32_t{0});
  const auto after = scene.detect().contacts;
  ASSERT_EQ(after.size(), before.size());
  for (std::size_t i = 0; i < after.size(); ++i) {
    EXPECT_EQ(after[i].triangle_a, numbers[before[i].triangle_a]);
    EXPECT_EQ(after[i].triangle_b, numbers[before[i].triangle_b]);
  }
  EXPECT_TRUE(verify(scene).agrees());
}

TEST(Edit, KeepsWhatBelongsToTheObject) {
  Scene scene({.contacts = ContactKinds::penetration});
  const TriangleMesh ball = make_icosphere(4);
  const ObjectId a = scene.add(ball, {.solid = true, .user_data = 7}), b = scene.add(ball, {.solid = true});
  scene.set_transform(b, {.translation = {1, 0, 0}});
  const auto touch = [&] { return scene.detect().contact_events; };
  EXPECT_EQ(touch().begin.size(), 1u);
  scene.edit(a, {.removed = Ids{3, 4}});
  EXPECT_FALSE(scene.options(a).solid) << "the surface is open";
  EXPECT_EQ(scene.options(a).user_data, 7u);
  std::array<Containment, 1> inside{};
  EXPECT_THROW(scene.inside(std::array{Vec3d{}}, inside, {.object = a}), Error);
  EXPECT_TRUE(touch().begin.empty() && scene.result().contact_events.end.empty()) << "the pair stays";
  EXPECT_EQ(scene.triangle(a, 3), std::nullopt);
  EXPECT_EQ(scene.triangle(a, 5), ball.triangles[5]);
  scene.edit(a, {.added = std::vector{ball.triangles[3], ball.triangles[4]}});
  EXPECT_TRUE(scene.options(a).solid);
  EXPECT_EQ(scene.triangle(a, 321), ball.triangles[4]);
  EXPECT_THROW(SceneInspector(scene).explain(a, 321, b, 0), Error) << "no call has searched the edited mesh";
  scene.detect();
  EXPECT_TRUE(verify(scene).agrees());
  EXPECT_FALSE(scene.result().penetrations.empty());
  scene.inside(std::array{Vec3d{}}, inside, {.object = a});
  EXPECT_EQ(inside[0], Containment::inside);
  EXPECT_EQ(scene.mesh_version(a), 2u);
}

TEST(Edit, ChangesRodsAndParticles) {
  Scene scene({.contacts = ContactKinds::proximity});
  TriangleMesh rods{
      .name = "rods", .positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 0, 9}}, .triangles = {}};
  const ObjectId a = scene.add(rods, {.edges = {{0, 1}, {1, 2}}, .points = {3}, .margin = 0.1});
  const ObjectId b = scene.add(rods, {.edges = {{0, 1}}, .margin = 0.1});
  scene.translate(b, {0.5, 0.1, 0});
  EXPECT_FALSE(scene.detect().proximity_pairs.empty());
  const std::array<std::uint32_t, 2> first{1, 0}, last{1, 2};
  scene.edit(a, {.removed_edges = std::span(&first, 1)});
  scene.edit(a, {.removed_edges = std::span(&last, 1)});
  EXPECT_TRUE(scene.detect().proximity_pairs.empty());
  EXPECT_THROW(scene.edit(a, {.removed_edges = std::span(&last, 1)}), Error);
  scene.edit(a, {.new_vertices = std::vector<Vec3d>{{0.7, 0, 0}}, .added_points = Ids{4}});
  EXPECT_EQ(scene.detect().proximity_pairs.size(), 1u);
  EXPECT_TRUE(verify(scene).agrees());
  scene.edit(a, {.added = std::vector<Triangle>{{0, 1, 3}}, .removed_points = Ids{3, 4}});
  scene.detect();
  EXPECT_TRUE(verify(scene).agrees());
}

TEST(Edit, RefusesWhatIsWrongAndChangesNothing) {
  Scene scene;
  const TriangleMesh ball = make_icosphere(2);
  const ObjectId a = scene.add(ball, {.name = "ball"}),
                 fixed = scene.add(ball, {.name = "floor", .is_static = true});
  const std::vector<Vec3d> shifted(ball.positions.size(), Vec3d{1, 2, 3});
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto error_of = [&](const MeshEdit& edit, ObjectId id) -> std::string {
    try {
      scene.edit(id, edit);
    } catch (const Error& error) {
      EXPECT_EQ(scene.triangle_count(id), ball.triangles.size());
      EXPECT_EQ(scene.vertex_count(id), ball.positions.size());
      EXPECT_EQ(scene.mesh_version(id), 0u);
      return error.what();
    }
    return "";
  };
  const std::vector<Vec3d> one{{0, 0, 0}}, bad{{0, 0, 0}, {nan, 0, 0}};
  const std::vector<Vec3f> one_float{{0, 0, 0}};
  EXPECT_EQ(error_of({.removed = Ids{80}}, a), "edit: ball has no triangle 80; it has 80, numbered from 0");
  EXPECT_EQ(error_of({.removed = Ids{7, 2, 7}}, a), "edit: ball: triangle 7 is removed twice");
  EXPECT_EQ(error_of({.added = std::vector<Triangle>{{0, 1, 2}, {0, 1, 43}}, .new_vertices = one}, a),
            "edit: ball: triangle 1 uses vertex 43, but there are 43 vertices, numbered from 0");
  EXPECT_EQ(error_of({.new_vertices = bad}, a), "edit: ball: the position of new vertex 1 is not finite");
  EXPECT_EQ(error_of({.new_vertices = one_float}, a),
            "edit: ball has double positions, but the new vertices are float; give both in one precision");
  EXPECT_NE(error_of({.removed = Ids{0}}, fixed).find("floor is static"), std::string::npos);
  scene.set_motion(a, ball.positions, shifted);
  EXPECT_EQ(error_of({.new_vertices = one}, a),
            "edit: ball is on a path and has 0 starts for 1 new vertices; give 1");
  scene.share_positions(a, shifted);
  EXPECT_EQ(error_of({.removed = Ids{0}}, a),
            "edit: ball shares its positions, so an edit cannot add to them; call set_positions first");
  scene.set_positions(a, ball.positions);
  scene.edit(a, {.removed = Ids{5}});
  EXPECT_THROW(scene.edit(a, {.removed = Ids{5}}), Error);
}

}  // namespace supple::edit_test
