#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "support/golden_hash.hpp"
#include "support/hard_scenes.hpp"
#include "support/random.hpp"
#include "support/scenes.hpp"

namespace supple {

inline Scene scene_of(const std::vector<TriangleMesh>& meshes, const SceneOptions& options) {
  Scene scene(options);
  for (const TriangleMesh& mesh : meshes) {
    // Colliding vertices belong to whole leaves, so the hash depends on the octree; it uses a regular one.
    scene.add(mesh,
              {.self_collision = true,
               .octree = {.leaf_size = 3,
                          .build = options.comparison.colliding_vertices ? ObjectOctreeBuild::regular
                                                                         : ObjectOctreeBuild::balanced}});
  }
  return scene;
}

inline std::uint64_t hash_of_all_families(std::uint32_t threads) {
  std::uint64_t hash = empty_hash;
  for (const Family& family : hard_families()) {
    Scene scene = scene_of(family.make(3), {.threads = threads, .comparison = {.colliding_vertices = true}});
    hash = hash_of(scene.detect(), hash);
  }
  return hash;
}

inline std::uint64_t normal_hash_of_all_families(std::uint32_t threads) {
  std::uint64_t hash = empty_hash;
  for (const Family& family : hard_families()) {
    Scene scene = scene_of(family.make(3), {.threads = threads});
    hash = hash_of_normals(scene.detect(), hash);
  }
  return hash;
}

inline void keep_first(std::size_t triangles, TriangleMesh& mesh) {
  if (mesh.triangles.size() <= triangles) return;
  mesh.triangles.erase(mesh.triangles.begin() + static_cast<std::ptrdiff_t>(triangles), mesh.triangles.end());
}

/// Objects that move from the positions of some meshes to those of others. Uses only the first triangles of
/// each.
inline Scene moving_scene_of(std::vector<TriangleMesh> from, const std::vector<TriangleMesh>& to,
                             std::size_t triangles, std::uint32_t threads) {
  for (TriangleMesh& mesh : from) keep_first(triangles, mesh);
  SceneOptions options;
  options.contacts = ContactKinds::continuous;
  options.threads = threads;
  Scene scene = scene_of(from, options);
  const std::vector<ObjectId> objects = scene.objects();
  for (std::size_t i = 0; i < objects.size(); ++i) {
    scene.set_motion(objects[i], from[i].positions, to[i].positions);
  }
  return scene;
}

/// Nearly all pairs of elements need exact arithmetic.
inline std::uint64_t continuous_hash_of_all_families(std::uint32_t threads) {
  std::uint64_t hash = empty_hash;
  for (const Family& family : hard_families()) {
    Scene scene = moving_scene_of(family.make(6), family.make(7), 12, threads);
    hash = hash_of(scene.detect(), hash);
  }
  return hash;
}

/// The parts of a step that are safe, for few triangles, which are often apart at the start.
inline std::uint64_t safe_step_hash_of_all_families(std::uint32_t threads) {
  std::uint64_t hash = empty_hash;
  for (const Family& family : hard_families()) {
    for (std::uint64_t seed = 0; seed < 4; ++seed) {
      Scene scene = moving_scene_of(family.make(seed), family.make(seed + 4), 2, threads);
      for (const double part : {scene.max_step().step, scene.collision_free_step().step})
        hash = hash_of_word(std::bit_cast<std::uint64_t>(part), hash);
      for (const ObjectStep& found : scene.collision_free_steps())
        hash = hash_of_word(std::bit_cast<std::uint64_t>(found.safe.step), hash);
    }
  }
  return hash;
}

/// The largest coordinate difference within the meshes.
inline double size_of(const std::vector<TriangleMesh>& meshes) {
  double size = 0;
  for (const TriangleMesh& mesh : meshes) {
    for (const Vec3d& p : mesh.positions) {
      for (int axis = 0; axis < 3; ++axis) {
        const double difference = std::abs(p[axis] - meshes.front().positions.front()[axis]);
        if (std::isfinite(difference)) size = std::max(size, difference);
      }
    }
  }
  return size;
}

/// Every object near itself and the others, within a thousandth of the size. Uses only the first triangles of
/// each.
inline Scene near_scene_of(std::vector<TriangleMesh> meshes, const SceneOptions& options,
                           std::size_t triangles = 24) {
  const double margin = 1e-3 * size_of(meshes);
  Scene scene(options);
  for (TriangleMesh& mesh : meshes) {
    keep_first(triangles, mesh);
    scene.add(mesh, {.self_collision = true, .margin = margin, .octree = {.leaf_size = 3}});
  }
  return scene;
}

inline std::uint64_t proximity_hash_of_all_families(std::uint32_t threads) {
  std::uint64_t hash = empty_hash;
  for (const Family& family : hard_families()) {
    for (const ProximityListing listing : {ProximityListing::features, ProximityListing::elements}) {
      Scene scene = near_scene_of(
          family.make(3),
          {.contacts = ContactKinds::proximity, .proximity_listing = listing, .threads = threads});
      hash = hash_of_proximity(scene.detect().proximity_pairs, hash);
    }
  }
  return hash;
}

/// Closest points and first triangles on rays around the objects, and the distances of all pairs of objects.
inline std::uint64_t query_hash_of_all_families(std::uint32_t threads) {
  std::uint64_t hash = empty_hash;
  const auto add = [&](std::uint64_t value) {
    hash = (hash ^ value) * 0x100000001b3u;
    hash ^= hash >> 32;
  };
  const auto add_numbers = [&](const auto& numbers) {
    for (const double number : numbers) add(std::bit_cast<std::uint64_t>(number));
  };
  for (const Family& family : hard_families()) {
    const std::vector<TriangleMesh> meshes = family.make(3);
    Scene scene = scene_of(meshes, {.threads = threads});
    RandomNumbers random(9);
    const double size = size_of(meshes);
    std::vector<Vec3d> points;
    std::vector<Ray> rays;
    for (int i = 0; i < 60; ++i) {
      points.push_back(meshes.front().positions.front() + random.vector(size));
      rays.push_back({points.back(), random.vector(size)});
    }
    std::vector<std::optional<ClosestPoint>> closest(points.size());
    scene.closest(points, closest);
    for (const auto& found : closest) {
      add(found ? found->object.index : ~std::uint64_t{0});
      if (!found) continue;
      add(found->triangle);
      add_numbers(found->barycentric);
      for (const Vec3d& v : {found->point, found->normal}) add_numbers(std::array{v.x, v.y, v.z});
    }
    std::vector<std::optional<RayHit>> hits(rays.size());
    scene.cast(rays, hits, {.count_hits = true});
    for (const auto& hit : hits) {
      add(hit ? hit->object.index : ~std::uint64_t{0});
      if (!hit) continue;
      add(hit->triangle);
      add(hit->hits);
      add_numbers(std::array{hit->t});
      add_numbers(hit->barycentric);
    }
    hash = hash_of_proximity(scene.distances(std::numeric_limits<double>::infinity()), hash);
  }
  return hash;
}

/// Boxes with corners at random places, some of which are on a lattice.
inline std::uint64_t penetration_hash_of_boxes(std::uint32_t threads) {
  std::uint64_t hash = empty_hash;
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    RandomNumbers random(seed);
    Scene scene({.contacts = ContactKinds::penetration, .curves = true, .threads = threads});
    for (int i = 0; i < 4; ++i) {
      TriangleMesh box{"box",
                       {},
                       {{0, 1, 3},
                        {0, 3, 2},
                        {4, 6, 7},
                        {4, 7, 5},
                        {0, 4, 5},
                        {0, 5, 1},
                        {2, 3, 7},
                        {2, 7, 6},
                        {0, 2, 6},
                        {0, 6, 4},
                        {1, 5, 7},
                        {1, 7, 3}}};
      const Vec3d offset = random.vector(1);
      const bool is_on_lattice = i % 2 == 0;
      for (std::uint32_t corner = 0; corner < 8; ++corner) {
        const Vec3d at{static_cast<double>(corner >> 2), static_cast<double>(corner >> 1 & 1),
                       static_cast<double>(corner & 1)};
        const auto step = [&] { return 0.5 * random.between(-1, 1); };
        const double x = step(), y = step();
        box.positions.push_back(is_on_lattice ? at + Vec3d{x, y, step()} : at + offset + random.vector(0.2));
      }
      scene.add(box, {.self_collision = true, .solid = true, .octree = {.leaf_size = 3}});
    }
    hash = hash_of_penetrations(scene.detect(), hash);
  }
  return hash;
}

/// Results of all degenerate families, and of boxes that penetrate.
constexpr GoldenHash golden_scene_hashes[] = {
    {"contacts", hash_of_all_families, 5724621896693359205u},
    {"normals", normal_hash_of_all_families, 14020266159755522772u},
    {"continuous", continuous_hash_of_all_families, 2109742332807707606u},
    {"safe steps", safe_step_hash_of_all_families, 7812403333792642879u},
    {"proximity", proximity_hash_of_all_families, 15691034415588189283u},
    {"queries", query_hash_of_all_families, 16834821160368692095u},
    {"penetrations", penetration_hash_of_boxes, 7000535598674829499u},
};

}  // namespace supple
