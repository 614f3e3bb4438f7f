#include "broad_phase/brute/brute_search.hpp"

#include <atomic>

namespace supple {

void BruteSearch::search(const VolumeStore& volumes, const Parallel& parallel, FoundPairs& found) {
  const auto boxes = volumes.boxes();
  lanes_.resize(boxes.size());
  std::size_t count = 0;
  for (std::uint32_t slot = 0; slot < boxes.size(); ++slot)
    if (!boxes[slot].empty()) lanes_.set(count++, slot, boxes[slot], marks_of(volumes, slot));
  lanes_.resize(count);

  const auto lists = sorter_.start(parallel.worker_count(), boxes.size());
  std::atomic<std::uint64_t> tests = 0;
  constexpr std::size_t grain = 64;
  parallel.for_ranges(count, grain, [&](std::size_t begin, std::size_t end, std::uint32_t worker) {
    tests += find_overlaps(lanes_, begin, end, volumes, lists[worker]);
  });
  sorter_.finish(parallel, found.pairs);
  found.stats.object_pairs_tested = tests;
  found.stats.objects_paired = count;
}

}  // namespace supple
