#include "broad_phase/brute_force.hpp"

#include <atomic>

#include "broad_phase/object_volume.hpp"
#include "broad_phase/overlap_kernel.hpp"

namespace supple {

std::span<const IndexPair> BruteForce::find_pairs(const ObjectVolumes& volumes, const Parallel& parallel) {
  const std::size_t slots = slot_count(volumes, bounding_volume_);
  lanes_.resize(slots);
  std::size_t live = 0;
  for (std::size_t slot = 0; slot < slots; ++slot) {
    const ObjectVolume volume = volume_at(volumes, bounding_volume_, slot);
    if (!volume.empty()) lanes_.set(live++, static_cast<std::uint32_t>(slot), volume.box);
  }
  lanes_.resize(live);

  found_.resize(parallel.worker_count());
  for (PairBuffer& found : found_) found.clear();
  std::atomic<std::uint64_t> tests = 0;
  constexpr std::size_t kGrain = 64;
  parallel.for_ranges(live, kGrain, [&](std::size_t begin, std::size_t end, std::uint32_t worker) {
    const std::size_t first = found_[worker].size();
    tests += find_overlaps(lanes_, begin, end, found_[worker]);
    if (bounding_volume_ == BoundingVolume::sphere)
      keep_overlapping_spheres(volumes.spheres, first, found_[worker]);
  });
  sorter_.sort(found_, slots, false, parallel, pairs_);
  stats_ = {};
  stats_.object_pairs_tested = tests;
  stats_.objects_changed = stats_.objects_paired = live;
  return pairs_;
}

}  // namespace supple
