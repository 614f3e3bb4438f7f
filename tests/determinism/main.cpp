// Compares results with the golden hashes, for machines, compilers and instruction sets with which the unit
// tests do not run. Prints one hash. Exits with 1 if it differs, and with 77 if this machine does not support
// the instruction set.

#include <hwy/targets.h>

#include <cinttypes>
#include <cstdio>
#include <cstdlib>

#include "golden_hashes.hpp"
#include "supple/comparison.hpp"
#include "supple/use_manifolds.hpp"

static_assert(HWY_TARGETS == SUPPLE_TARGET, "the options choose another instruction set, or several");

// Highway's compiled library belongs to this machine. Without optimisation its headers call this function.
namespace hwy {
void Abort(const char*, int, const char*, ...) {
  std::abort();
}
}  // namespace hwy

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
  if (!machine_has_it()) return 77;
  supple::use_comparison_methods();
  supple::use_manifolds();
  const Results results = compute_golden_hashes();
  std::printf("%016" PRIx64 "\n", results.hash);
  return results.hash == results.expected ? 0 : 1;
}
