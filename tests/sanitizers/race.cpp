// Runs work on several threads like the library. With an argument, the threads race on one variable.
#include <cstdio>
#include <vector>

#include "core/parallel.hpp"

int main(int argument_count, char**) {
  const bool racy = argument_count > 1;
  const supple::Parallel parallel(4);
  std::vector<std::vector<int>> scratch(parallel.worker_count());
  int shared = 0;
  for (int round = 0; round < 100; ++round) {
    const std::vector<int> in(10000, round);
    std::vector<int> out(in.size());
    parallel.for_ranges(in.size(), 64, [&](std::size_t begin, std::size_t end, std::uint32_t worker) {
      scratch[worker].clear();
      for (std::size_t i = begin; i < end; ++i) {
        out[i] = in[i] + 1;
        scratch[worker].push_back(out[i]);
      }
      if (racy) shared = shared + 1;
    });
    for (const int value : out) {
      if (value != round + 1) return 1;
    }
  }
  std::printf("%d\n", shared);
}
