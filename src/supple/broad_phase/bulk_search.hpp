#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "broad_phase/row_kernel.hpp"
#include "broad_phase/search_plan.hpp"
#include "core/parallel.hpp"

namespace supple {

/// Boxes that have come, and where they are to be kept: copied as they are measured, so that they come from
/// memory once. None when empty.
struct IncomingBoxes {
  std::span<const Aabb> from;
  Aabb* to = nullptr;  ///< the boxes that are searched, as they were
};

/// Finds all overlapping pairs of boxes anew, with nothing kept from the step before: boxes are measured in
/// whole steps, dealt out by size, row and cell, and each is held against those that follow it in its row and
/// the rows beside, 16 at a time. Each pair is found once. Memory is kept from call to call.
class BulkSearch {
 public:
  /// Adds the pairs to `found`, which has bins for each worker, or returns false without having searched: so
  /// many boxes share cells that regions, which divide space where they are, will do better. Of balls, if
  /// there are some, these are the boxes, and only pairs of balls that overlap are added. `last_pair_count`
  /// pairs came of the call before.
  bool find(std::span<const Aabb> boxes, std::span<const BoundingSphere> spheres, const Parallel& parallel,
            std::size_t last_pair_count, std::span<PairBins> found, const IncomingBoxes& incoming = {});
  std::uint64_t tests() const;
  std::size_t changed() const;  ///< how many of the incoming boxes differed from those before
  std::size_t box_count() const { return block_begins_.back(); }  ///< that were not empty
  /// How the last call searched.
  const BoxMeasure& measure() const { return measure_; }
  const DealtBoxes& dealt() const { return boxes_; }

 private:
  /// A range of boxes that are measured by one worker.
  struct Chunk {
    std::size_t begin = 0, end = 0, measured = 0, changed = 0;
    std::vector<std::uint32_t> block_sizes;  // then the places that its boxes go to
    std::vector<std::array<std::uint32_t, 3>> reach;
  };

  bool deal_by_old_plan(const Parallel& parallel);
  void divide();
  void measure(const IncomingBoxes& incoming, const Parallel& parallel);
  void measure_chunk(const IncomingBoxes& incoming, Chunk& chunk);
  /// Returns the sum over all cells of the squares of their counts.
  std::uint64_t deal(const Parallel& parallel);
  void deal_chunk(Chunk& chunk);
  std::uint64_t order_block(std::size_t block);
  std::size_t level_of(std::size_t block) const;

  SearchPlanner planner_;
  SearchPlan plan_;
  std::uint32_t plan_uses_ = 0;                   // since it was made
  std::size_t planned_count_ = 0;                 // of boxes when it was made
  std::array<std::uint32_t, 3> planned_reach_{};  // of the largest ones then
  std::uint64_t company_ = 0;                     // sum over all cells of the squares of their counts then
  BoxMeasure measure_;
  std::vector<Chunk> chunks_;
  std::vector<MeasuredBox> measured_, dealt_;
  std::vector<std::uint32_t> blocks_;        // per measured box
  std::vector<std::uint32_t> block_begins_;  // and one more
  DealtBoxes boxes_;
  std::vector<RowSearch> workers_;
};

}  // namespace supple
