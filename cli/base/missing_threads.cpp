#include "base/missing_threads.hpp"

#include <fmt/format.h>

#include <cstdio>

#include "supple/threads.hpp"

namespace supple::cli {

void warn_of_missing_threads(std::uint32_t threads) {
  warn_of_missing_threads(threads != 0 ? threads : usable_cores(), available_threads(threads));
}

void warn_of_missing_threads(std::uint32_t wanted, std::uint32_t available) {
  if (available >= wanted) return;
  fmt::print(
      stderr,
      "supple: warning: the system has too few processes or too little memory left for {} threads, so {} "
      "work; raise its limits (ulimit -u, ulimit -v), or give --threads {}\n",
      wanted, available, available);
}

}  // namespace supple::cli
