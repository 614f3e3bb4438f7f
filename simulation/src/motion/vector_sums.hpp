#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "core/parallel.hpp"

namespace supple {

/// Sums are of chunks of this size, and then of these in order, so that they are the same for any number of
/// threads.
constexpr std::size_t chunk_size = 512;

constexpr std::size_t chunk_count(std::size_t count) {
  return (count + chunk_size - 1) / chunk_size;
}

/// Calls `visit(begin, end)` with each chunk of [0, count).
template <class Visit>
void for_chunks(std::size_t count, const Parallel& parallel, Visit visit) {
  parallel.for_ranges(chunk_count(count), 1, [&](std::size_t first, std::size_t last, std::uint32_t) {
    for (std::size_t chunk = first; chunk < last; ++chunk) {
      visit(chunk * chunk_size, std::min((chunk + 1) * chunk_size, count));
    }
  });
}

/// The sum of `sum(begin, end)` of the chunks of [0, count); `of_chunks` has room for one number each.
template <class Sum>
double sum_of_chunks(std::size_t count, const Parallel& parallel, std::span<double> of_chunks, Sum sum) {
  for_chunks(count, parallel,
             [&](std::size_t begin, std::size_t end) { of_chunks[begin / chunk_size] = sum(begin, end); });
  double total = 0;
  for (std::size_t chunk = 0; chunk < chunk_count(count); ++chunk) total += of_chunks[chunk];
  return total;
}

}  // namespace supple
