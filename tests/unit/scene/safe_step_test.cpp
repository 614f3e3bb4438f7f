#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "supple/distance.hpp"
#include "supple/error.hpp"
#include "supple/scene.hpp"
#include "support/hard_scenes.hpp"
#include "support/random.hpp"
#include "verify/brute_force_elements.hpp"

namespace supple::safe_step_test {

struct Path {
  TriangleMesh mesh;
  std::vector<Vec3d> to;
};

Scene scene_of(const std::vector<Path>& paths, double separation = 0) {
  SceneOptions options;
  options.contacts = ContactKinds::continuous;
  options.impact.min_separation = separation;
  Scene scene(options);
  for (const Path& path : paths) {
    const ObjectId id = scene.add(path.mesh, {.self_collision = true, .octree = {.leaf_size = 3}});
    scene.set_motion(id, path.mesh.positions, path.to);
  }
  return scene;
}

std::vector<Vec3d> at(const Path& path, double t) {
  std::vector<Vec3d> positions;
  for (std::size_t v = 0; v < path.to.size(); ++v) {
    const Vec3d& from = path.mesh.positions[v];
    positions.push_back(from + t * (path.to[v] - from));
  }
  return positions;
}

/// Calls `visit` with the points of each vertex-face and edge-edge pair at the start and at time t.
template <class Visit>
void for_each_pair(const std::vector<Path>& paths, double t, const Visit& visit) {
  std::vector<PlainObject> objects;
  std::vector<BoxedElements> elements;
  for (const Path& path : paths) {
    objects.push_back({path.mesh.positions, at(path, t), path.mesh.triangles});
    elements.push_back(boxed_elements(objects.back()));
  }
  const auto visit_all = [&](std::size_t a, const std::vector<BoxedElement>& of_a, std::size_t b,
                             const std::vector<BoxedElement>& of_b) {
    for (const BoxedElement& p : of_a) {
      for (const BoxedElement& q : of_b) {
        if (a == b && (share_vertex(p, q) || (p.kind == q.kind && q.name <= p.name))) continue;
        const auto points = [&](const std::vector<Vec3d>& positions, const BoxedElement& element) {
          std::vector<Vec3d> found;
          for (std::size_t i = 0; i <= static_cast<std::size_t>(element.kind); ++i)
            found.push_back(positions[element.vertices[i]]);
          return found;
        };
        visit(std::array{points(objects[a].start, p), points(objects[b].start, q)},
              std::array{points(objects[a].end, p), points(objects[b].end, q)});
      }
    }
  };
  for (std::size_t a = 0; a < paths.size(); ++a) {
    for (std::size_t b = 0; b < paths.size(); ++b) {
      visit_all(a, elements[a].vertices, b, elements[b].faces);
      if (a <= b) visit_all(a, elements[a].edges, b, elements[b].edges);
    }
  }
}

double distance_of(const std::array<std::vector<Vec3d>, 2>& elements) {
  const auto& [a, b] = elements;
  if (a.size() == 2) return edge_edge_distance({a[0], a[1]}, {b[0], b[1]})->distance;
  return point_triangle_distance(a[0], {b[0], b[1], b[2]})->distance;
}

/// The least share of its distance that a pair has at the rounded positions at time t.
double least_share(const std::vector<Path>& paths, double t, double separation) {
  double least = std::numeric_limits<double>::infinity();
  for_each_pair(paths, t, [&](const auto& start, const auto& end) {
    const double before = distance_of(start), after = distance_of(end);
    const double excess = before > separation ? separation : 0;
    least = std::min(least, (after - excess) / (before - excess));
  });
  return least;
}

/// Sheets that fly through each other, deformed and far from touching at the start.
std::vector<Path> flying_sheets(std::uint64_t seed, double scale = 1, double gap = 0.4) {
  RandomNumbers random(seed);
  std::vector<Path> paths;
  for (int i = 0; i < 2; ++i) {
    Path path{crumpled_sheet(3, 3, 0.1, seed + static_cast<std::uint64_t>(i)), {}};
    for (Vec3d& p : path.mesh.positions) {
      p.y += gap * i;
      p = scale * p;
    }
    const Vec3d way = random.vector(1);
    for (const Vec3d& p : path.mesh.positions)
      path.to.push_back(p + scale * (Vec3d{way.x, i == 0 ? 0.5 : -0.5, way.z} + random.vector(0.2)));
    paths.push_back(path);
  }
  return paths;
}

TEST(SafeStep, KeepsTheShareOfEachDistanceAndIsTheLargest) {
  for (const double keep : {0.0, 0.2, 0.5, 0.9}) {
    for (const double separation : {0.0, 0.02}) {
      for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        const std::vector<Path> paths = flying_sheets(seed);
        Scene scene = scene_of(paths, separation);
        const double t = scene.collision_free_step({.keep = keep}).step;
        ASSERT_GT(t, 0);
        EXPECT_GE(least_share(paths, t, separation), keep * (1 - 0x1p-18) - 1e-9);
        if (t == 1) continue;
        EXPECT_LE(least_share(paths, t * (1 + 1e-4), separation), keep + 1e-3)
            << "a longer step keeps it too";
      }
    }
  }
}

TEST(SafeStep, IsThatOfTheFirstImpactWhenNothingIsKept) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Scene scene = scene_of(flying_sheets(seed));
    const double first = scene.max_step().step;
    const double t = scene.collision_free_step({.keep = 0}).step;
    EXPECT_LE(t, first);
    EXPECT_NEAR(t, first, 1e-6);
  }
}

TEST(SafeStep, DoesNotDependOnThreadsOrScale) {
  const std::vector<Path> paths = flying_sheets(3), huge = flying_sheets(3, 0x1p300),
                          tiny = flying_sheets(3, 0x1p-300);
  Scene scene = scene_of(paths);
  const double t = scene.collision_free_step().step;
  EXPECT_LT(t, 1);
  for (const std::uint32_t threads : {1u, 2u, 5u}) {
    Scene other({.contacts = ContactKinds::continuous, .threads = threads});
    for (const Path& path : paths)
      other.set_motion(other.add(path.mesh, {.self_collision = true}), path.mesh.positions, path.to);
    EXPECT_EQ(other.collision_free_step().step, t) << threads;
  }
  Scene of_huge = scene_of(huge), of_tiny = scene_of(tiny);
  for (const double keep : {0.2, 0.9, 0.99}) {
    const double expected = scene.collision_free_step({.keep = keep}).step;
    EXPECT_NEAR(of_huge.collision_free_step({.keep = keep}).step, expected, 1e-9) << keep;
    EXPECT_NEAR(of_tiny.collision_free_step({.keep = keep}).step, expected, 1e-9) << keep;
  }
}

/// A line search that repeats the step always advances, and nothing crosses at the rounded positions.
TEST(SafeStep, AlwaysAdvancesInALineSearch) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    std::vector<Path> paths = flying_sheets(seed);
    Scene scene = scene_of(paths);
    for (int step = 0; step < 20; ++step) {
      const double t = scene.collision_free_step().step;
      ASSERT_GT(t, 0) << step;
      Scene check = scene_of(paths);
      for (std::size_t i = 0; i < paths.size(); ++i) {
        const std::vector<Vec3d> reached = at(paths[i], t);
        check.set_motion(check.objects()[i], paths[i].mesh.positions, reached);
        paths[i].mesh.positions = reached;
        scene.set_motion(scene.objects()[i], reached, paths[i].to);
      }
      ASSERT_FALSE(check.earliest_impact()) << step;
    }
  }
}

TriangleMesh triangle_at(double z, double size = 1) {
  TriangleMesh mesh;
  mesh.positions = {{-size, -size, z}, {size, -size, z}, {0, size, z}};
  mesh.triangles = {{0, 1, 2}};
  return mesh;
}

/// Gaps below the rounding of the coordinates: the positions from + t (to - from) decide.
TEST(SafeStep, ReachesRoundedPositionsWithoutContact) {
  for (const double gap : {1e-4, 1e-12, 0x1p-50, 0x1p-52}) {
    const std::vector<Path> paths{{triangle_at(1 + gap), triangle_at(0.3).positions},
                                  {triangle_at(1), triangle_at(1).positions}};
    Scene scene = scene_of(paths);
    const double t = scene.collision_free_step().step;
    EXPECT_GT(t, 0) << gap;
    Scene check = scene_of({{paths[0].mesh, at(paths[0], t)}, {paths[1].mesh, at(paths[1], t)}});
    EXPECT_FALSE(check.earliest_impact()) << gap;
    EXPECT_GT(at(paths[0], t)[0].z, 1) << gap;
  }
  for (const double gap : {1e-20, 1e-100, 1e-300}) {
    Scene scene =
        scene_of({{triangle_at(gap), triangle_at(-1).positions}, {triangle_at(0), triangle_at(0).positions}});
    const double t = scene.collision_free_step().step;
    EXPECT_GT(t, 0) << gap;
    EXPECT_NEAR(t / gap, 0.8, 1e-4) << gap;
  }
}

/// Neither plate approaches the other, but the rounding of positions would bring them into contact.
TEST(SafeStep, ProvesThatPlatesWhichMoveTogetherDoNotTouch) {
  for (const double gap : {0x1p-52, 0x1p-51, 0x1p-50}) {
    for (const double way : {0.7, 1 / 3.0, 1e5}) {
      std::vector<Path> paths{{triangle_at(1 + gap), {}}, {triangle_at(1), {}}};
      for (Path& path : paths) {
        for (const Vec3d& p : path.mesh.positions) path.to.push_back(p + Vec3d{0, 0, way});
      }
      Scene scene = scene_of(paths);
      const double t = scene.collision_free_step().step;
      Scene check = scene_of({{paths[0].mesh, at(paths[0], t)}, {paths[1].mesh, at(paths[1], t)}});
      EXPECT_FALSE(check.earliest_impact()) << gap << " " << way;
    }
  }
}

/// Moves `way` on.
Path moved(const TriangleMesh& mesh, Vec3d way) {
  Path path{mesh, mesh.positions};
  for (Vec3d& p : path.to) p += way;
  return path;
}

/// Two triangles that touch at rest, in all ways to say so: without paths, static, with paths that end where
/// they start, with the same way, and as parts of one object.
TEST(SafeStep, DoesNotEndWhereElementsTouchAtRest) {
  const TriangleMesh mesh = triangle_at(-5);
  TriangleMesh pierced = mesh;
  pierced.positions = {{0, 0, -5}, {3, 0, 2}, {3, 1, 2}};  // a vertex in the face
  // A pair that moves freely, and one whose positions round so coarsely that they need a proof.
  const std::vector<std::vector<Path>> others{
      {},
      {{triangle_at(1.5), triangle_at(0.5).positions}, {triangle_at(0), triangle_at(0).positions}},
      {{triangle_at(1 + 0x1p-50), triangle_at(0.3).positions}, {triangle_at(1), triangle_at(1).positions}}};
  for (const TriangleMesh& other : {mesh, pierced}) {
    for (const std::vector<Path>& paths : others) {
      const SafeStep expected = scene_of(paths).collision_free_step();
      EXPECT_GT(expected.step, 0);
      const auto add_static = [&](Scene& scene, const TriangleMesh& added, bool is_static) {
        return scene.add(added, {.self_collision = true, .is_static = is_static});
      };
      for (const bool is_static : {false, true}) {
        Scene plain = scene_of(paths);
        add_static(plain, mesh, is_static);
        add_static(plain, other, false);
        EXPECT_EQ(plain.collision_free_step(), expected);
        Scene on_paths = scene_of(paths);
        add_static(on_paths, mesh, is_static);
        on_paths.set_motion(add_static(on_paths, other, false), other.positions, other.positions);
        EXPECT_EQ(on_paths.collision_free_step(), expected);
      }
      Scene together = scene_of(paths);
      for (const TriangleMesh* part : {&mesh, &other}) {
        const Path path = moved(*part, {0.25, 0.5, -1});
        together.set_motion(add_static(together, *part, false), path.mesh.positions, path.to);
      }
      EXPECT_EQ(together.collision_free_step(), expected);
      for (const Vec3d& way : {Vec3d{}, Vec3d{0.25, 0.5, -1}}) {
        TriangleMesh both = mesh;
        both.positions.insert(both.positions.end(), other.positions.begin(), other.positions.end());
        both.triangles.push_back({3, 4, 5});
        Scene one = scene_of(paths);
        const Path path = moved(both, way);
        one.set_motion(add_static(one, both, false), path.mesh.positions, path.to);
        EXPECT_EQ(one.collision_free_step(), expected);
      }
    }
  }
}

/// A cloth whose fixed vertices lie on a static triangle: in the face, on an edge, and on a corner.
TEST(SafeStep, DoesNotEndWhereFixedVerticesTouch) {
  for (const Vec3d& fixed : {Vec3d{0, 0, 0}, Vec3d{0, -1, 0}, Vec3d{-1, -1, 0}}) {
    for (const double gap : {0.5, 0x1p-60}) {
      TriangleMesh cloth;
      cloth.positions = {fixed, {5, 0, gap}, {5, 1, gap}};
      cloth.triangles = {{0, 1, 2}};
      std::vector<Vec3d> to = cloth.positions;
      to[1].z += 0.25;
      to[2].z += 0.5;
      Scene scene = scene_of({{cloth, to}});
      scene.add(triangle_at(0), {.is_static = true});
      EXPECT_EQ(scene.collision_free_step(), SafeStep{}) << fixed.x << " " << fixed.y << " " << gap;
      to[0].z -= 0x1p-40;
      scene.set_motion(scene.objects()[0], cloth.positions, to);
      EXPECT_EQ(scene.collision_free_step().step, 0) << "it moves";
    }
  }
}

TEST(SafeStep, ReturnsTheFirstOfThePairsThatLimitIt) {
  // Four equal pairs of a falling triangle and a floor, and one that falls less.
  std::vector<Path> paths{moved(triangle_at(1), {0, 0, -0.5}), moved(triangle_at(0), {})};
  for (int i = 1; i < 5; ++i) {
    for (Path path : {moved(triangle_at(1), {0, 0, -2}), moved(triangle_at(0), {})}) {
      for (std::size_t v = 0; v < 3; ++v) {
        path.mesh.positions[v].x += 10 * i;
        path.to[v].x += 10 * i;
      }
      paths.push_back(path);
    }
  }
  std::vector<LimitingPair> limits;
  for (const std::uint32_t threads : {1u, 3u}) {
    Scene scene({.contacts = ContactKinds::continuous, .threads = threads});
    for (const Path& path : paths) scene.set_motion(scene.add(path.mesh), path.mesh.positions, path.to);
    const SafeStep safe = scene.collision_free_step({.keep = 0.5}), first = scene.max_step();
    ASSERT_TRUE(safe.limit && first.limit);
    for (const LimitingPair& limit : {*safe.limit, *first.limit}) {
      EXPECT_EQ(limit.object_a, scene.objects()[2]);
      EXPECT_EQ(limit.object_b, scene.objects()[3]);
      EXPECT_EQ(limit.kind, ElementPairKind::vertex_face);
    }
    limits.push_back(*safe.limit);
    EXPECT_EQ(limits.back(), limits.front()) << threads;
    EXPECT_EQ(first.step, scene.earliest_impact()->toi);
    const ElementVertices a = scene.vertices_of(*safe.limit, ContactSide::a),
                          b = scene.vertices_of(*safe.limit, ContactSide::b);
    EXPECT_EQ(a.size(), 1u);
    EXPECT_EQ(b.size(), 3u);
  }
  Scene free = scene_of({moved(triangle_at(1), {0, 0, 1}), moved(triangle_at(0), {})});
  EXPECT_EQ(free.collision_free_step(), SafeStep{});
  EXPECT_EQ(free.max_step(), SafeStep{});
}

TEST(SafeStep, IsNotEndedByPairsWithinTheSeparationThatPart) {
  const std::vector<Path> paths{{triangle_at(0.01), triangle_at(0.5).positions},
                                {triangle_at(0), triangle_at(0).positions}};
  Scene scene = scene_of(paths, 0.1);
  EXPECT_EQ(scene.max_step().step, 1);
  EXPECT_EQ(scene.earliest_impact()->toi, 0) << "a contact does not say whether they part";
  EXPECT_EQ(scene.collision_free_step().step, 1);
  Scene nearer = scene_of(
      {{triangle_at(0.01), triangle_at(0).positions}, {triangle_at(0), triangle_at(0).positions}}, 0.1);
  EXPECT_EQ(nearer.max_step().step, 0);
  EXPECT_NEAR(nearer.collision_free_step({.keep = 0.25}).step, 0.75, 1e-5);
}

TEST(SafeStep, IsZeroWhereElementsTouchAtTheStartAndOneLeavesAFaceInwards) {
  for (const double height : {1.0, -1.0}) {
    Scene scene = scene_of(
        {{triangle_at(0), triangle_at(height).positions}, {triangle_at(0), triangle_at(0).positions}});
    EXPECT_EQ(scene.collision_free_step().step, height > 0 ? 1 : 0);
    EXPECT_EQ(scene.max_step().step, height > 0 ? 1 : 0);
    EXPECT_EQ(scene.earliest_impact()->toi, 0);
  }
  Scene at_rest =
      scene_of({{triangle_at(0), triangle_at(0).positions}, {triangle_at(0), triangle_at(0).positions}});
  EXPECT_EQ(at_rest.collision_free_step().step, 1) << "nothing moves";
}

/// Moves each island by a part of its own and checks that nothing has crossed and shares are kept.
void expect_safe(const std::vector<Path>& paths, const std::vector<ObjectStep>& steps, double separation,
                 double keep, RandomNumbers& random) {
  std::vector<Path> reached = paths;
  std::vector<double> factors;
  for (std::size_t i = 0; i < paths.size(); ++i) {
    ASSERT_LE(steps[i].island.index, i);
    const ObjectStep& island = steps[steps[i].island.index];
    EXPECT_EQ(steps[i].safe, island.safe);
    factors.push_back(std::array{0.0, 1.0, random.uniform(0, 1)}[random.below(3)]);
    const double part = factors[island.object.index] * island.safe.step;
    reached[i].to = at(paths[i], part);
  }
  Scene check = scene_of(reached);
  EXPECT_FALSE(check.earliest_impact());
  EXPECT_GE(least_share(reached, 1, separation), keep * (1 - 1e-6) - 1e-9);
}

/// Sheets at random places that fly in random directions; some rest.
std::vector<Path> scattered_sheets(RandomNumbers& random, double space) {
  std::vector<Path> paths;
  for (int i = 0; i < 6; ++i) {
    Path path{crumpled_sheet(2, 2, 0.1, random.bits()), {}};
    const Vec3d place = random.vector(space), way = random.vector(random.below(3) == 0 ? 0 : 1);
    for (Vec3d& p : path.mesh.positions) {
      p += place;
      path.to.push_back(p + way + (way == Vec3d{} ? Vec3d{} : random.vector(0.1)));
    }
    paths.push_back(path);
  }
  return paths;
}

TEST(SafeSteps, OfObjectsAreSafeTogether) {
  RandomNumbers random(7);
  int longer = 0, islands = 0;
  for (int round = 0; round < 30; ++round) {
    const std::vector<Path> paths = scattered_sheets(random, 1 + round % 3);
    const double separation = round % 2 == 0 ? 0 : 0.05, keep = std::array{0.0, 0.2, 0.9}[round % 3];
    Scene scene = scene_of(paths, separation);
    const SafeStep all = scene.collision_free_step({.keep = keep});
    if (all.step == 0) continue;
    const auto found = scene.collision_free_steps({.keep = keep});
    const std::vector<ObjectStep> steps(found.begin(), found.end());
    ASSERT_EQ(steps.size(), paths.size());
    double least = 1;
    for (std::size_t i = 0; i < steps.size(); ++i) {
      EXPECT_EQ(steps[i].object, scene.objects()[i]);
      EXPECT_EQ(steps[i].safe.step < 1, steps[i].safe.limit.has_value());
      if (steps[i].island != steps[i].object) continue;
      least = std::min(least, steps[i].safe.step);
      longer += steps[i].safe.step > all.step ? 1 : 0;
      islands += steps[i].safe.step < 1 ? 1 : 0;
    }
    EXPECT_EQ(least, all.step);
    for (int i = 0; i < 3; ++i) expect_safe(paths, steps, separation, keep, random);
  }
  EXPECT_GT(longer, 20);
  EXPECT_GT(islands, 10);
}

TEST(SafeSteps, DoNotStopObjectsThatAreApart) {
  // Three triangles fall on one floor: from three heights, far from each other.
  std::vector<Path> paths{moved(triangle_at(0, 50), {})};
  for (int i = 0; i < 3; ++i) {
    Path path = moved(triangle_at(1 + i), {0, 0, -4});
    for (std::size_t v = 0; v < 3; ++v) {
      path.mesh.positions[v].x += 5 * i - 5;
      path.to[v].x += 5 * i - 5;
    }
    paths.push_back(path);
  }
  for (const std::uint32_t threads : {1u, 3u}) {
    Scene scene({.contacts = ContactKinds::continuous, .threads = threads});
    for (const Path& path : paths) scene.set_motion(scene.add(path.mesh), path.mesh.positions, path.to);
    const auto steps = scene.collision_free_steps({.keep = 0.5});
    EXPECT_EQ(steps[0].safe, SafeStep{});
    for (std::size_t i = 1; i < 4; ++i) {
      EXPECT_EQ(steps[i].island, steps[i].object);
      EXPECT_NEAR(steps[i].safe.step, static_cast<double>(i) / 8, 1e-6);
      EXPECT_EQ(steps[i].safe.limit->object_a, scene.objects()[0]);
      EXPECT_EQ(steps[i].safe.limit->object_b, scene.objects()[i]);
    }
  }
}

/// Objects that move together stay together: the first would be overtaken by the second.
TEST(SafeSteps, MoveObjectsThatFollowEachOtherByTheSamePart) {
  const std::vector<Path> paths{moved(triangle_at(0), {0, 0, -4}), moved(triangle_at(0.5), {0, 0, -4}),
                                moved(triangle_at(-2, 5), {})};
  Scene scene = scene_of(paths);
  const auto steps = scene.collision_free_steps({.keep = 0.5});
  EXPECT_NEAR(steps[0].safe.step, 0.25, 1e-6);
  EXPECT_EQ(steps[1].safe, steps[0].safe);
  EXPECT_EQ(steps[1].island, steps[0].object);
  EXPECT_EQ(steps[2].island, steps[2].object);
  EXPECT_TRUE(Scene().collision_free_steps().empty());
}

TEST(SafeStep, OfFastThingsTogetherDoesNotCountTheirWay) {
  TriangleMesh sheet = crumpled_sheet(8, 8, 0.05, 1);
  std::vector<Vec3d> to = sheet.positions;
  for (Vec3d& p : to) p = p + Vec3d{100, 50, 20};
  Scene scene = scene_of({{sheet, to}});
  EXPECT_EQ(scene.collision_free_step({.keep = 0.9}).step, 1);
}

TEST(SafeStep, IgnoresVerticesThatAreNotFinite) {
  std::vector<Path> paths = flying_sheets(2);
  paths[0].to[3].x = std::numeric_limits<double>::quiet_NaN();
  Scene scene = scene_of(paths);
  const double t = scene.collision_free_step().step;
  EXPECT_GT(t, 0);
  EXPECT_LE(t, 1);
  EXPECT_EQ(Scene().collision_free_step().step, 1);
}

TEST(SafeSteps, ListNoFreeSlots) {
  Scene scene({.contacts = ContactKinds::continuous});
  const TriangleMesh high = triangle_at(1);
  const ObjectId falling = scene.add(high), removed = scene.add(high), floor = scene.add(triangle_at(0));
  scene.set_motion(falling, high.positions, triangle_at(-1).positions);
  scene.remove(removed);
  const auto steps = scene.collision_free_steps();
  ASSERT_EQ(steps.size(), 2u);
  EXPECT_EQ(steps[0].object, falling);
  EXPECT_LT(steps[0].safe.step, 0.5);
  EXPECT_EQ(steps[1].object, floor);
  scene.remove(falling);
  EXPECT_EQ(scene.collision_free_steps().size(), 1u);
}

/// Boxes of the ways decide which objects can be in one island, whatever volumes the scene has.
TEST(SafeSteps, HaveTheSameIslandsForAllVolumes) {
  RandomNumbers random(3);
  int joined = 0;
  for (int round = 0; round < 40; ++round) {
    const std::vector<Path> paths = scattered_sheets(random, 2);
    std::vector<ObjectStep> expected;
    for (const BoundingVolume volume :
         {BoundingVolume::aabb, BoundingVolume::sphere, BoundingVolume::obb, BoundingVolume::kdop18}) {
      Scene scene({.bounding_volume = volume, .contacts = ContactKinds::continuous});
      for (const Path& path : paths) scene.set_motion(scene.add(path.mesh), path.mesh.positions, path.to);
      const auto found = scene.collision_free_steps({.keep = 0.5});
      if (expected.empty()) expected.assign(found.begin(), found.end());
      EXPECT_TRUE(std::ranges::equal(found, expected)) << round;
      joined += std::ranges::count_if(found, [](const ObjectStep& s) { return s.island != s.object; }) > 0;
    }
  }
  EXPECT_GT(joined, 20);
}

/// Sheets that fly `length` times as far as they are large.
std::vector<Path> wild_sheets(double length) {
  RandomNumbers random(5);
  std::vector<Path> paths = flying_sheets(4);
  for (Path& path : paths) {
    for (std::size_t v = 0; v < path.to.size(); ++v)
      path.to[v] = path.mesh.positions[v] + length * random.vector(1);
  }
  return paths;
}

/// The step of a motion is in proportion to its length, and it is found with as little exact arithmetic.
TEST(SafeStep, OfWildMotionsIsThatOfShortOnes) {
  for (const double keep : {0.0, 0.2, 0.9}) {
    Scene of_short = scene_of(wild_sheets(1));
    const double expected = of_short.collision_free_step({.keep = keep}).step,
                 longest = of_short.max_step().step;
    for (const double length : {1e3, 1e6, 1e9}) {
      Scene scene = scene_of(wild_sheets(length));
      const SafeStep found = scene.collision_free_step({.keep = keep});
      EXPECT_NEAR(found.step * length / expected, 1, 1e-5) << length << " " << keep;
      EXPECT_NEAR(scene.max_step().step * length / longest, 1, 1e-5) << length;
      const std::vector<Path> paths = wild_sheets(length);
      if (length < 1e9) {
        EXPECT_GE(least_share(paths, found.step, 0), keep * (1 - 1e-4)) << length;
      }
      double least = 1;
      for (const ObjectStep& step : scene.collision_free_steps({.keep = keep}))
        least = std::min(least, step.safe.step);
      EXPECT_EQ(least, found.step) << length << " " << keep;
    }
  }
}

#ifdef __cpp_lib_jthread
TEST(SafeStep, IsSafeWhereTheCallEndsEarlier) {
  std::stop_source source;
  source.request_stop();
  for (const double length : {1.0, 1e6}) {
    const std::vector<Path> paths = wild_sheets(length);
    Scene scene = scene_of(paths);
    const SafeStep whole = scene.collision_free_step(), longest = scene.max_step();
    const StepLimits stopped{.stop = source.get_token()}, out_of_time{.seconds = 0};
    for (const StepLimits& limits : {stopped, out_of_time}) {
      for (const SafeStep& found : {scene.collision_free_step({}, limits), scene.max_step(limits)}) {
        EXPECT_TRUE(found.stopped);
        EXPECT_FALSE(found.limit);
        EXPECT_GE(found.step, 0);
        EXPECT_LE(found.step, whole.step);
      }
      const auto steps = scene.collision_free_steps({}, limits);
      ASSERT_EQ(steps.size(), 2u);
      for (const ObjectStep& step : steps) {
        EXPECT_TRUE(step.safe.stopped);
        EXPECT_EQ(step.island, steps[0].object);
        EXPECT_LE(step.safe.step, whole.step);
      }
      EXPECT_FALSE(scene.earliest_impact(limits));
    }
    EXPECT_EQ(scene.collision_free_step({}, {.seconds = 1e6}), whole);
    EXPECT_EQ(scene.max_step(), longest);
    EXPECT_FALSE(whole.stopped);
  }
}
#endif

TEST(SafeStep, RefusesSharesOutOfRange) {
  Scene scene;
  for (const double seconds : {-1.0, std::numeric_limits<double>::quiet_NaN()}) {
    const StepLimits limits{.seconds = seconds};
    EXPECT_THROW(scene.collision_free_step({}, limits), Error);
    EXPECT_THROW(scene.collision_free_steps({}, limits), Error);
    EXPECT_THROW(scene.max_step(limits), Error);
    EXPECT_THROW(scene.earliest_impact(limits), Error);
  }
  for (const double keep : {-0.1, 1.0, std::numeric_limits<double>::quiet_NaN()})
    EXPECT_THROW(scene.collision_free_step({.keep = keep}), Error);
}

}  // namespace supple::safe_step_test
