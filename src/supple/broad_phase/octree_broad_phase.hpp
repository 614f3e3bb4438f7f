#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "broad_phase/box_cells.hpp"
#include "broad_phase/box_lanes.hpp"
#include "broad_phase/bulk_search.hpp"
#include "broad_phase/pair_finder.hpp"
#include "broad_phase/pair_patch.hpp"
#include "broad_phase/pair_sorter.hpp"
#include "broad_phase/scene_cube.hpp"
#include "broad_phase/scene_octree.hpp"

namespace supple {

/// The paper's broad phase: objects are tested against those they share a leaf of the scene octree with. Only
/// objects that changed are looked at; when these are few, the pairs among the others are kept from the step
/// before. Regions are made anew when many objects left theirs or the cube no longer suits the scene.
///
/// Unless options ask for regions always, they are left to scenes too crowded for cells. Otherwise all pairs
/// are searched in bulk when many objects changed, and when few did, these are moved in the cells of the last
/// search in bulk, and the pairs changed that they begin or end.
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
  void search_in_bulk(const ObjectVolumes& volumes, const Parallel& parallel,
                      const IncomingBoxes& incoming = {});
  bool did_most_change(const ObjectVolumes& volumes) const;
  bool move_in_cells(const ObjectVolumes& volumes);
  void detect_changes(const ObjectVolumes& volumes, const Parallel& parallel);
  void take_told(const ObjectVolumes& volumes);
  void compare_all(const ObjectVolumes& volumes, const Parallel& parallel);
  std::size_t list_changed(const ObjectVolumes& volumes, std::size_t begin, std::size_t end,
                           std::uint32_t* out) const;
  bool is_changed(const ObjectVolumes& volumes, std::size_t i) const;
  void take_over(const ObjectVolumes& volumes);
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
  /// What is up to date besides the volumes.
  enum class Basis { nothing, regions, bulk, cells } basis_ = Basis::nothing;

  std::vector<std::uint32_t> listed_;       // memory of the next
  std::span<const std::uint32_t> changed_;  // slots, ascending
  std::vector<std::size_t> chunk_sizes_;    // scratch of `compare_all`
  std::vector<std::uint8_t> is_changed_;    // per slot, while regions are searched for few
  std::vector<std::uint32_t> crossing_;     // those of the changed to be placed anew
  std::vector<Worker> workers_;
  std::vector<PairBuffer> found_;
  PairSorter sorter_;
  BulkSearch bulk_;
  BoxCells cells_;
  std::int64_t tests_left_ = 0;  // of boxes, until they are dealt out anew
  std::vector<Aabb> moved_boxes_;
  std::vector<BoundingSphere> moved_spheres_;
  std::vector<std::uint64_t> toggled_;
  PairPatch patch_;
  std::vector<IndexPair> pairs_, fresh_, last_pairs_;
};

}  // namespace supple
