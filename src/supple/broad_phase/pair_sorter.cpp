#include "broad_phase/pair_sorter.hpp"

#include <algorithm>
#include <bit>
#include <utility>

#include "broad_phase/run_kernel.hpp"
#include "geometry/sphere.hpp"

namespace supple {

void PairBins::reset(int shift, std::size_t bin_count) {
  shift_ = shift;
  chunk_count_ = bin_count;
  if (before_.size() < bin_count) {
    before_.resize(2 * bin_count);
    pool_.resize(before_.size() * kChunk);
  }
  next_.resize(bin_count);
  for (std::size_t bin = 0; bin < bin_count; ++bin) next_[bin] = bin * kChunk;
}

std::size_t PairBins::chunk_after(std::size_t chunk) {
  if (chunk_count_ == before_.size()) {
    before_.resize(2 * chunk_count_);
    pool_.resize(before_.size() * kChunk);
  }
  before_[chunk_count_] = static_cast<std::uint32_t>(chunk);
  fetch(chunk_count_);
  return chunk_count_++ * kChunk;
}

void PairBins::push_all(const std::uint32_t* first, const std::uint32_t* second, std::size_t count) {
  const auto pair_of = [&](std::size_t i) -> IndexPair {
    return {std::min(first[i], second[i]), std::max(first[i], second[i])};
  };
  if (next_.size() != 1) {
    for (std::size_t i = 0; i < count; ++i) push(pair_of(i));
    return;
  }
  // One bin: by whole chunks.
  for (std::size_t i = 0; i < count;) {
    IndexPair* const out = pool_.data() + next_[0];
    const std::size_t part = std::min(count - i, kChunk - next_[0] % kChunk);
    for (std::size_t k = 0; k < part; ++k) out[k] = pair_of(i + k);
    i += part;
    next_[0] += part;
    if (next_[0] % kChunk == 0) next_[0] = chunk_after(next_[0] / kChunk - 1);
  }
}

std::size_t PairBins::count(std::size_t bin) const {
  std::size_t sum = 0;
  for_each_chunk(bin, [&](std::span<const IndexPair> pairs) { sum += pairs.size(); });
  return sum;
}

std::span<PairBins> PairSorter::start(std::size_t workers, std::size_t slot_count) {
  // Counters of a bin stay in the first-level cache, and so do the places that a worker writes to next.
  constexpr int kBits = 11;
  shift_ = std::max(kBits, static_cast<int>(std::bit_width(slot_count)) - kBits);
  slot_count_ = slot_count;
  bins_.resize(workers);
  const std::size_t bin_count = (slot_count >> shift_) + 1;
  for (PairBins& bins : bins_) bins.reset(shift_, bin_count);
  bin_begins_.resize(bin_count + 1);
  return bins_;
}

void PairSorter::finish(bool may_repeat, const Parallel& parallel, std::vector<IndexPair>& sorted) {
  const std::size_t bin_count = bin_begins_.size() - 1;
  bin_begins_[0] = 0;
  for (std::size_t bin = 0; bin < bin_count; ++bin) {
    bin_begins_[bin + 1] = bin_begins_[bin];
    for (const PairBins& bins : bins_) bin_begins_[bin + 1] += bins.count(bin);
  }
  sorted.resize(bin_begins_[bin_count]);
  runs_.resize(parallel.worker_count());
  parallel.for_ranges(bin_count, 1, [&](std::size_t begin, std::size_t end, std::uint32_t worker) {
    for (std::size_t bin = begin; bin < end; ++bin)
      sort_bin(bin, may_repeat, runs_[worker],
               {sorted.data() + bin_begins_[bin], bin_begins_[bin + 1] - bin_begins_[bin]});
  });
  if (may_repeat) sorted.erase(std::unique(sorted.begin(), sorted.end()), sorted.end());
}

void PairSorter::sort(std::span<const PairBuffer> parts, std::size_t slot_count, bool may_repeat,
                      const Parallel& parallel, std::vector<IndexPair>& sorted) {
  std::size_t total = 0;
  for (const PairBuffer& part : parts) total += part.size();
  if (total >= slot_count / 16) {
    const auto bins = start(parts.size(), slot_count);
    parallel.for_ranges(parts.size(), 1, [&](std::size_t begin, std::size_t end, std::uint32_t) {
      for (std::size_t part = begin; part < end; ++part)
        for (std::size_t i = 0; i < parts[part].size(); ++i) bins[part].push(parts[part].data()[i]);
    });
    return finish(may_repeat, parallel, sorted);
  }
  sorted.resize(total);
  auto out = sorted.begin();
  for (const PairBuffer& part : parts) out = std::copy_n(part.data(), part.size(), out);
  std::sort(sorted.begin(), sorted.end());
  if (may_repeat) sorted.erase(std::unique(sorted.begin(), sorted.end()), sorted.end());
}

void PairSorter::sort_bin(std::size_t bin, bool may_repeat, Runs& runs, std::span<IndexPair> sorted) const {
  if (sorted.empty()) return;
  const auto first_slot = static_cast<std::uint32_t>(bin << shift_);
  std::vector<std::uint32_t>& end = runs.end;
  // While they are filled the begin of a run stands where at last its end does.
  end.assign(std::min(std::size_t{1} << shift_, slot_count_ - first_slot) + 1, 0);
  std::uint32_t* const next = end.data() + 1;
  const auto for_each_pair = [&](auto&& visit) {
    for (const PairBins& bins : bins_)
      bins.for_each_chunk(bin, [&](std::span<const IndexPair> pairs) {
        for (const IndexPair pair : pairs) visit(pair.a - first_slot, pair.b);
      });
  };
  for_each_pair([&](std::uint32_t a, std::uint32_t) { ++next[a]; });
  std::uint32_t begin = 0;
  for (std::size_t a = 0; a + 1 < end.size(); ++a) begin += std::exchange(next[a], begin);
  if (runs.a.size() < sorted.size() + kMaxLanes) {
    runs.a.resize(sorted.size() + sorted.size() / 2 + kMaxLanes);
    runs.b.resize(runs.a.size());
  }
  runs.marks.resize(slot_count_ / 64 + 1, 0);
  std::uint32_t* const run_a = runs.a.data();
  std::uint32_t* const run_b = runs.b.data();
  for_each_pair([&](std::uint32_t a, std::uint32_t b) {
    const std::uint32_t place = next[a]++;
    run_a[place] = a;
    run_b[place] = b;
  });
  sort_runs({run_a, sorted.size()}, {run_b, sorted.size()}, end, first_slot, may_repeat, runs.marks, sorted);
}

void keep_overlapping_spheres(std::span<const BoundingSphere> spheres, std::size_t first, PairBuffer& pairs) {
  IndexPair* const begin = pairs.data() + first;
  IndexPair* const end = pairs.data() + pairs.size();
  IndexPair* const kept =
      std::remove_if(begin, end, [&](IndexPair pair) { return !overlap(spheres[pair.a], spheres[pair.b]); });
  pairs.truncate(static_cast<std::size_t>(kept - pairs.data()));
}

}  // namespace supple
