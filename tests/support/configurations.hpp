#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "supple/scene.hpp"
#include "support/option_word.hpp"
#include "support/scenes.hpp"

namespace supple {

/// One way to search. The contacts are the same for all.
struct Configuration {
  SceneOptions scene;
  ObjectOctreeOptions octree;

  std::string name() const {
    const auto word = [](auto value) { return std::string(word_of(value)); };
    return word(scene.broad_phase) + ' ' + name_of(scene.bounding_volume) + ' ' +
           word(scene.comparison.sphere_fit) + ' ' + word(octree.build) + ' ' + std::to_string(octree.arity);
  }
};

/// The builds with each arity that they allow.
inline std::vector<ObjectOctreeOptions> all_octrees() {
  std::vector<ObjectOctreeOptions> octrees{{}};
  for (const auto build : {ObjectOctreeBuild::regular, ObjectOctreeBuild::bottom_up}) {
    for (const std::uint32_t arity : {2u, 4u, 8u}) octrees.push_back({.arity = arity, .build = build});
  }
  return octrees;
}

using EnclosingVolume = std::pair<OptionWord<BoundingVolume>, OptionWord<SphereFit>>;

/// The volumes with the fits that enclose all triangles.
inline std::vector<EnclosingVolume> all_enclosing_volumes() {
  std::vector<EnclosingVolume> volumes{{BoundingVolume::sphere, SphereFit::minimal},
                                       {BoundingVolume::sphere, SphereFit::medial}};
  for (const BoundingVolume volume : all_bounding_volumes) volumes.emplace_back(volume, SphereFit::vertices);
  return volumes;
}

/// Every combination of broad phase, volume, octree and arity, the default first. The arity is also that of
/// the scene octree. Sizes of leaves and numbers of threads take turns.
inline std::vector<Configuration> all_configurations() {
  std::vector<Configuration> all{{}};
  std::uint32_t turn = 0;
  for (const auto method : {BroadPhaseMethod::automatic, BroadPhaseMethod::octree, BroadPhaseMethod::grid,
                            BroadPhaseMethod::sweep, BroadPhaseMethod::brute, BroadPhaseMethod::sweep3}) {
    for (const auto& [volume, fit] : all_enclosing_volumes()) {
      for (const ObjectOctreeOptions& octree : all_octrees()) {
        Configuration& next = all.emplace_back(Configuration{{}, octree});
        next.octree.leaf_size = std::array{1u, 7u, 64u}[turn % 3];
        next.scene.threads = std::array{1u, 2u, 3u, 8u}[turn % 4];
        next.scene.broad_phase = method;
        next.scene.bounding_volume = volume;
        next.scene.comparison.sphere_fit = fit;
        if (method == BroadPhaseMethod::automatic || method == BroadPhaseMethod::octree)
          next.scene.scene_octree.arity = octree.arity;
        ++turn;
      }
    }
  }
  return all;
}

}  // namespace supple
