#pragma once

#include <algorithm>
#include <cstddef>
#include <span>

#include "core/parallel.hpp"

namespace supple {

/// Sums are computed over chunks of this size, and the chunk sums are added in order. So they are the same
/// for any number of threads.
constexpr std::size_t chunk_size = 512;

constexpr std::size_t chunk_count(std::size_t count) {
  return (count + chunk_size - 1) / chunk_size;
}

/// Calls `visit(begin, end)` for each chunk of [0, count).
template <class Visit>
void for_chunks(std::size_t count, const Parallel& parallel, Visit visit) {
  parallel.for_ranges(chunk_count(count), 1, [&](std::size_t first, std::size_t last, std::uint32_t) {
    for (std::size_t chunk = first; chunk < last; ++chunk) {
      visit(chunk * chunk_size, std::min((chunk + 1) * chunk_size, count));
    }
  });
}

/// Adds `sum(begin, end)` over all chunks of [0, count). `of_chunks` has room for one number per chunk.
template <class Sum>
double sum_of_chunks(std::size_t count, const Parallel& parallel, std::span<double> of_chunks, Sum sum) {
  for_chunks(count, parallel,
             [&](std::size_t begin, std::size_t end) { of_chunks[begin / chunk_size] = sum(begin, end); });
  double total = 0;
  for (std::size_t chunk = 0; chunk < chunk_count(count); ++chunk) total += of_chunks[chunk];
  return total;
}

}  // namespace supple
