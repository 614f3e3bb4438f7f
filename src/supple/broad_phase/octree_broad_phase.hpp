#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "broad_phase/box_lanes.hpp"
#include "broad_phase/pair_finder.hpp"
#include "broad_phase/pair_sorter.hpp"
#include "broad_phase/scene_cube.hpp"
#include "broad_phase/scene_octree.hpp"

namespace supple {

/// The paper's broad phase: objects are tested against those they share a leaf of the scene octree with. Only
/// objects that changed are looked at; when these are few, the pairs among the others are kept from the step
/// before. Regions are made anew when many objects left theirs or the cube no longer suits the scene.
class OctreeBroadPhase final : public PairFinder {
 public:
  OctreeBroadPhase(BoundingVolume bounding_volume, const SceneOctreeOptions& options);

  void find_pairs(const ObjectVolumes& volumes, const Parallel& parallel,
                  std::vector<IndexPair>& pairs) override;
  std::string validate() const override;
  std::vector<SceneRegion> regions() const override { return tree_.describe(); }

 private:
  /// What became of an object since the last step.
  enum class Change : std::uint8_t { none, within_regions, across_regions };

  /// Scratch memory of one worker.
  struct Worker {
    BoxLanes lanes;
    std::vector<std::uint64_t> order;
    std::vector<std::uint32_t> others;
    PairBuffer found;
    std::uint64_t tests = 0;
  };

  void detect_changes(const ObjectVolumes& volumes, const Parallel& parallel);
  Change take_change(const ObjectVolumes& volumes, std::size_t i);
  void collect_changes();
  void update_regions(const ObjectVolumes& volumes);
  void find_all(const Parallel& parallel);
  void find_in_leaf(const SceneOctree::Region& leaf, Worker& worker) const;
  void find_of_changed(const Parallel& parallel);
  void find_of_object(std::uint32_t slot, Worker& worker) const;
  void merge_kept(std::vector<IndexPair>& pairs);

  BoundingVolume bounding_volume_;
  std::uint32_t max_level_;
  SceneOctree tree_;
  SceneCubeChooser cube_chooser_;
  std::size_t known_slots_ = 0;
  std::size_t live_ = 0;
  std::size_t placed_since_choice_ = 0;  // objects placed since the cube was last thought over
  bool built_ = false;

  std::vector<Change> changes_;          // per slot
  std::vector<std::uint32_t> changed_;   // slots, ascending
  std::vector<std::uint32_t> crossing_;  // those of them to be placed anew
  std::vector<Worker> workers_;
  std::vector<PairBuffer> found_;
  PairSorter sorter_;
  std::vector<IndexPair> fresh_, last_pairs_;
};

}  // namespace supple
