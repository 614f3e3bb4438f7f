#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "support/hard_scenes.hpp"
#include "support/scenes.hpp"

namespace supple {

/// Hashes of the results of all degenerate families: contacts at given positions, and contacts during motion.
/// They have the same bits on every machine and with every compiler, build type, number of threads and
/// instruction set.
constexpr std::uint64_t golden_hash = 5724621896693359205u;
constexpr std::uint64_t golden_continuous_hash = 18216801788449742353u;
constexpr std::uint64_t golden_normal_hash = 14020266159755522772u;
constexpr std::uint64_t golden_proximity_hash = 649647511004271498u;

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
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (const Family& family : hard_families()) {
    Scene scene = scene_of(family.make(3), {.threads = threads, .comparison = {.colliding_vertices = true}});
    hash = hash_of(scene.detect(), hash);
  }
  return hash;
}

inline std::uint64_t normal_hash_of_all_families(std::uint32_t threads) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (const Family& family : hard_families()) {
    Scene scene = scene_of(family.make(3), {.threads = threads});
    hash = hash_of_normals(scene.detect(), hash);
  }
  return hash;
}

/// Uses only the first triangles of each object: nearly all of these pairs need exact arithmetic.
inline std::uint64_t continuous_hash_of_all_families(std::uint32_t threads) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (const Family& family : hard_families()) {
    std::vector<TriangleMesh> from = family.make(6);
    const std::vector<TriangleMesh> to = family.make(7);
    for (TriangleMesh& mesh : from) mesh.triangles.resize(std::min(mesh.triangles.size(), std::size_t{12}));
    SceneOptions options;
    options.contacts = ContactKinds::continuous;
    options.threads = threads;
    Scene scene = scene_of(from, options);
    const std::vector<ObjectId> objects = scene.objects();
    for (std::size_t i = 0; i < objects.size(); ++i) {
      scene.set_motion(objects[i], from[i].positions, to[i].positions);
    }
    hash = hash_of(scene.detect(), hash);
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
    mesh.triangles.resize(std::min(mesh.triangles.size(), triangles));
    scene.add(mesh, {.self_collision = true, .margin = margin, .octree = {.leaf_size = 3}});
  }
  return scene;
}

inline std::uint64_t proximity_hash_of_all_families(std::uint32_t threads) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (const Family& family : hard_families()) {
    for (const ProximityListing listing : {ProximityListing::features, ProximityListing::elements}) {
      Scene scene = near_scene_of(
          family.make(3),
          {.contacts = ContactKinds::proximity, .proximity_listing = listing, .threads = threads});
      hash = hash_of_proximity(scene.detect(), hash);
    }
  }
  return hash;
}

}  // namespace supple
