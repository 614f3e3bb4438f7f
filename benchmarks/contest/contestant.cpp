#include "contest/contestant.hpp"

#include <time.h>

#include <algorithm>

namespace supple::benchmarks {
namespace {

std::uint64_t mixed(std::uint64_t z) {
  z += 0x9e3779b97f4a7c15u;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

double milliseconds_of(clockid_t clock) {
  timespec time{};
  clock_gettime(clock, &time);
  return 1e3 * static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_nsec);
}

}  // namespace

void PairDigest::add(std::uint64_t a, std::uint64_t b) {
  ++count;
  hash += mixed(mixed(std::min(a, b)) + 3 * std::max(a, b));
}

std::vector<std::array<std::uint32_t, 2>> edges_of(const std::vector<Triangle>& triangles) {
  std::vector<std::array<std::uint32_t, 2>> edges;
  for (const Triangle& t : triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t a = t[i], b = t[(i + 1) % 3];
      edges.push_back({std::min(a, b), std::max(a, b)});
    }
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  return edges;
}

PairDigest ClothContestant::pairs() const {
  PairDigest digest;
  for (const ElementPair& pair : candidates()) {
    const std::uint64_t kind = pair.is_edge_edge ? 0 : 1;
    digest.add(pair.a, pair.b + (kind << 32));
  }
  return digest;
}

double cpu_milliseconds() {
  return milliseconds_of(CLOCK_PROCESS_CPUTIME_ID);
}

double wall_milliseconds() {
  return milliseconds_of(CLOCK_MONOTONIC);
}

}  // namespace supple::benchmarks
