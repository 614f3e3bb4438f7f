#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "broad_phase/box_lanes.hpp"
#include "broad_phase/bulk_search.hpp"
#include "broad_phase/pair_finder.hpp"
#include "broad_phase/pair_sorter.hpp"
#include "broad_phase/scene_cube.hpp"
#include "broad_phase/scene_octree.hpp"

namespace supple {

/// The paper's broad phase: objects are tested against those they share a leaf of the scene octree with. Only
/// objects that changed are looked at; when these are few, the pairs among the others are kept from the step
/// before. Regions are made anew when many objects left theirs or the cube no longer suits the scene.
///
/// When many objects changed all pairs are searched in bulk, and the regions are left behind. They are made
/// again when few have changed for some steps.
class OctreeBroadPhase final : public PairFinder {
 public:
  OctreeBroadPhase(BoundingVolume bounding_volume, const SceneOctreeOptions& options);

  std::span<const IndexPair> find_pairs(const ObjectVolumes& volumes, const Parallel& parallel) override;
  std::string validate() const override;
  std::vector<SceneRegion> regions() const override;

 private:
  /// Scratch memory of one worker.
  struct Worker {
    BoxLanes lanes;
    std::vector<std::uint64_t> order;
    std::vector<std::uint32_t> others;
    PairBuffer found;
    std::uint64_t tests = 0;
  };

  void search_regions(const ObjectVolumes& volumes, const Parallel& parallel, bool few_changed);
  void search_in_bulk(const ObjectVolumes& volumes, const Parallel& parallel);
  void detect_changes(const ObjectVolumes& volumes, const Parallel& parallel);
  std::size_t detect_changes_in(const ObjectVolumes& volumes, std::size_t begin, std::size_t end);
  bool is_changed(const ObjectVolumes& volumes, std::size_t i) const;
  void collect_changes();
  void follow_changes(const ObjectVolumes& volumes);
  void make_regions();
  SceneOctree present_regions() const;
  void find_all(const Parallel& parallel);
  void find_in_leaf(const SceneOctree::Region& leaf, Worker& worker) const;
  void find_of_changed(const Parallel& parallel);
  void find_of_object(std::uint32_t slot, Worker& worker) const;
  void merge_kept();

  BoundingVolume bounding_volume_;
  bool always_regions_;
  std::uint32_t max_level_;
  SceneOctree tree_;
  SceneCubeChooser cube_chooser_;
  std::size_t known_slots_ = 0;
  std::size_t live_ = 0;
  std::size_t placed_since_choice_ = 0;  // objects placed since the cube was last thought over
  std::size_t frames_of_few_ = 0;        // in a row
  bool has_regions_ = false;             // and they are those of the present volumes
  bool has_regions_ever_ = false;

  std::vector<std::uint8_t> is_changed_;  // per slot
  std::vector<std::uint32_t> changed_;    // slots, ascending
  std::vector<std::uint32_t> crossing_;   // those of them to be placed anew
  std::vector<Worker> workers_;
  std::vector<PairBuffer> found_;
  PairSorter sorter_;
  BulkSearch bulk_;
  std::vector<IndexPair> pairs_, fresh_, last_pairs_;
};

}  // namespace supple
