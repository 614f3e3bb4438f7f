#include "contest/contestant.hpp"

#include <hwy/targets.h>
#include <time.h>

#include <algorithm>

#include "supple/error.hpp"

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

namespace {
std::string embree_limit;
}  // namespace

void limit_instruction_set([[maybe_unused]] const std::string& name) {
#if HWY_ARCH_X86
  struct Set {
    const char *name, *of_embree;
    std::int64_t target;
  };
  for (const Set& set :
       {Set{"avx512", "avx512", HWY_AVX3}, {"avx2", "avx2", HWY_AVX2}, {"sse4", "sse4.2", HWY_SSE4}}) {
    if (name != set.name || (hwy::SupportedTargets() & set.target) == 0) continue;
    hwy::SetSupportedTargetsForTest(set.target);
    embree_limit = set.of_embree;
    return;
  }
#endif
  throw Error("this machine has no instruction set named '" + name + "'; choose avx512, avx2 or sse4");
}

const std::string& embree_instruction_set() {
  return embree_limit;
}

double cpu_milliseconds() {
  return milliseconds_of(CLOCK_PROCESS_CPUTIME_ID);
}

double wall_milliseconds() {
  return milliseconds_of(CLOCK_MONOTONIC);
}

}  // namespace supple::benchmarks
