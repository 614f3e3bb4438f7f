#pragma once

#include <cstdint>
#include <vector>

#include "broad_phase/octree/scene_octree.hpp"
#include "broad_phase/overlap_kernel.hpp"
#include "broad_phase/pair_search.hpp"

namespace supple {

/// The paper's broad phase: tests pairs of objects that share a leaf of the scene octree. The regions follow
/// the objects that changed. When few objects changed, only their pairs are searched and all other pairs
/// stay. The regions are rebuilt when most objects left their regions, when the cube no longer suits the
/// scene, or when another method searched the step before.
class OctreeSearch final : public PairSearch {
 public:
  OctreeSearch(BoundingVolume bounding_volume, const SceneOctreeOptions& options)
      : tree_(bounding_volume, options), cube_chooser_(options.root) {}

  void search(const VolumeStore& volumes, const Parallel& parallel, FoundPairs& found) override;
  std::vector<SceneRegion> regions(std::optional<std::uint32_t> slot) const override {
    return tree_.describe(slot);
  }
  std::string validate(const VolumeStore& volumes) const override { return tree_.validate(volumes); }

 private:
  /// Scratch memory of one worker.
  struct Worker {
    BoxLanes lanes;
    std::vector<std::uint64_t> order;
    std::vector<std::uint32_t> others;
    std::uint64_t tests = 0;
  };

  void follow_changes(const VolumeStore& volumes, BroadPhaseStats& stats);
  void build(const VolumeStore& volumes, const SceneCube& cube, BroadPhaseStats& stats);
  void find_in_leaf(const VolumeStore& volumes, const SceneOctree::Region& leaf, Worker& worker,
                    PairList& pairs) const;
  void find_of_object(const VolumeStore& volumes, std::uint32_t slot, Worker& worker, PairList& pairs) const;
  void erase_repeats(std::vector<IndexPair>& pairs) const;
  void merge_kept(std::vector<IndexPair>& pairs);

  SceneOctree tree_;
  SceneCubeChooser cube_chooser_;
  std::uint64_t revision_ = ~std::uint64_t{0};  // of the volumes in the regions; the first value is none
  std::size_t placements_before_choice_ = 0;    // moves of objects until the cube is chosen again
  std::vector<std::uint32_t> crossing_;         // changed objects that may have left their regions
  std::vector<std::uint8_t> is_changed_;        // per slot; all 0 between searches
  std::vector<Worker> workers_;
  PairSorter sorter_;
  std::vector<IndexPair> fresh_, kept_;
};

}  // namespace supple
