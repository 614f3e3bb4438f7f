#pragma once

#include <cstdint>
#include <span>

#include "broad_phase/box_lanes.hpp"

namespace supple {

/// Sorts runs of pairs with equal a by b. `a` and `b` hold the pairs, runs one behind the other, a without
/// `first_slot`; `b` is readable `kMaxLanes` past its end and may be put in another order. Run a is
/// [run_ends[a], run_ends[a + 1]).
/// Only where `may_repeat` says so is a b in a run several times. Every b is below 64 times the number of
/// `marks`, which are zero before and after.
void sort_runs(std::span<const std::uint32_t> a, std::span<std::uint32_t> b,
               std::span<const std::uint32_t> run_ends, std::uint32_t first_slot, bool may_repeat,
               std::span<std::uint64_t> marks, std::span<IndexPair> sorted);

}  // namespace supple
