// Compares the results of the degenerate scenes with the golden hashes, for machines and instruction sets on
// which the unit tests do not run. Prints one line. Exits with 1 if they differ, and with 77 if this machine
// does not support the instruction set.

#include <hwy/targets.h>

#include <cinttypes>
#include <cstdio>
#include <cstdlib>

#include "support/golden_scenes.hpp"

static_assert(HWY_TARGETS == SUPPLE_TARGET, "the options choose another instruction set, or several");

#if defined(__wasm__)
// Debian's C++ library for WebAssembly has no exceptions, and its C library lacks the stack guard that
// compiled functions need.
extern "C" {
extern std::uintptr_t __stack_chk_guard;
std::uintptr_t __stack_chk_guard = 1;
void __stack_chk_fail();
void __stack_chk_fail() {
  std::abort();
}
void* __cxa_allocate_exception(std::size_t) {
  std::abort();
}
void __cxa_throw(void*, void*, void (*)(void*)) {
  std::abort();
}
}
#endif

namespace {

bool machine_has_it() {
#if defined(__AVX512F__)
  return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw");
#elif defined(__AVX2__)
  return __builtin_cpu_supports("avx2");
#elif defined(__SSE4_2__)
  return __builtin_cpu_supports("sse4.2");
#else
  return true;
#endif
}

}  // namespace

int main() {
  const char* const name = hwy::TargetName(HWY_STATIC_TARGET);
  if (!machine_has_it()) {
    std::printf("%s: compiled, not run: this machine does not have it\n", name);
    return 77;
  }
  const std::uint64_t contacts = supple::hash_of_all_families(1);
  const std::uint64_t continuous = supple::continuous_hash_of_all_families(1);
  const std::uint64_t proximity = supple::proximity_hash_of_all_families(1);
  const std::uint64_t queries = supple::query_hash_of_all_families(1);
  const std::uint64_t penetrations = supple::penetration_hash_of_boxes(1);
  const bool equal = contacts == supple::golden_hash && continuous == supple::golden_continuous_hash &&
                     proximity == supple::golden_proximity_hash && queries == supple::golden_query_hash &&
                     penetrations == supple::golden_penetration_hash;
  std::printf("%s: %" PRIu64 " %" PRIu64 " %" PRIu64 " %" PRIu64 " %" PRIu64 " %s\n", name, contacts,
              continuous, proximity, queries, penetrations, equal ? "as everywhere" : "DIFFERENT");
  return equal ? 0 : 1;
}
