#include "broad_phase/pair_patch.hpp"

#include <algorithm>
#include <cstring>

namespace supple {
namespace {

std::uint64_t key_of(IndexPair pair) {
  return std::uint64_t{pair.a} << 32 | pair.b;
}

/// Drops both of two that are equal.
void cancel(std::vector<std::uint64_t>& sorted) {
  std::size_t kept = 0;
  for (const std::uint64_t key : sorted) {
    if (kept != 0 && sorted[kept - 1] == key)
      --kept;
    else
      sorted[kept++] = key;
  }
  sorted.resize(kept);
}

/// The first place from `begin` on whose pair is not below the key. The steps grow at first: it is near.
std::size_t find_from(const std::vector<IndexPair>& pairs, std::size_t begin, std::uint64_t key) {
  std::size_t step = 16;
  while (begin + step < pairs.size() && key_of(pairs[begin + step]) < key) {
    begin += step;
    step *= 2;
  }
  const auto first = pairs.begin() + static_cast<std::ptrdiff_t>(begin);
  const auto last = pairs.begin() + static_cast<std::ptrdiff_t>(std::min(begin + step + 1, pairs.size()));
  const auto found = std::partition_point(first, last, [&](IndexPair pair) { return key_of(pair) < key; });
  return static_cast<std::size_t>(found - pairs.begin());
}

}  // namespace

/// Blocks that move down go first to last, those that move up last to first: none is then written over before
/// it has moved itself, as the places that they go to lie in the same order as those that they come from.
void PairPatch::toggle(std::vector<std::uint64_t>& toggled, std::vector<IndexPair>& pairs) {
  std::sort(toggled.begin(), toggled.end());
  cancel(toggled);
  blocks_.clear();
  std::size_t place = 0;
  std::ptrdiff_t shift = 0;
  for (const std::uint64_t key : toggled) {
    place = find_from(pairs, place, key);
    if (!blocks_.empty()) blocks_.back().end = place;
    const bool is_there = place < pairs.size() && key_of(pairs[place]) == key;
    place += is_there;
    shift += is_there ? -1 : 1;
    blocks_.push_back({place, pairs.size(), shift});
  }
  const std::size_t count = pairs.size() + static_cast<std::size_t>(shift);
  if (shift > 0) pairs.resize(count);
  const auto move = [&](const Block& block) {
    std::memmove(pairs.data() + static_cast<std::ptrdiff_t>(block.begin) + block.shift,
                 pairs.data() + block.begin, (block.end - block.begin) * sizeof(IndexPair));
  };
  for (const Block& block : blocks_)
    if (block.shift < 0) move(block);
  for (auto block = blocks_.rbegin(); block != blocks_.rend(); ++block)
    if (block->shift > 0) move(*block);
  shift = 0;
  for (std::size_t i = 0; i < blocks_.size(); ++i) {
    const bool is_new = blocks_[i].shift > shift;
    if (is_new)
      pairs[blocks_[i].begin + static_cast<std::size_t>(shift)] = {
          static_cast<std::uint32_t>(toggled[i] >> 32), static_cast<std::uint32_t>(toggled[i])};
    shift = blocks_[i].shift;
  }
  pairs.resize(count);
}

}  // namespace supple
