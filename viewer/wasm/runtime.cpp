// Runtime functions that Debian's WebAssembly libraries leave to the program, which has no exceptions.

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <exception>
#include <new>

#include "page.hpp"

// The stack protector that compiled library functions use.
extern "C" {
extern std::uintptr_t __stack_chk_guard;
std::uintptr_t __stack_chk_guard = 1;
[[noreturn]] void __stack_chk_fail();
void __stack_chk_fail() {
  std::abort();
}
}

namespace {

void* allocate(std::size_t size, std::size_t alignment) {
  void* const memory = alignment <= alignof(std::max_align_t)
                           ? std::malloc(size)
                           : std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
  if (memory == nullptr)
    supple::viewer::fail_in_page("there is not enough memory for that; show fewer or smaller objects");
  return memory;
}

}  // namespace

void* operator new(std::size_t size) {
  return allocate(size, 1);
}
void* operator new(std::size_t size, std::align_val_t alignment) {
  return allocate(size, static_cast<std::size_t>(alignment));
}

namespace boost {
struct source_location;
[[noreturn]] void throw_exception(const std::exception& error);
[[noreturn]] void throw_exception(const std::exception& error, const source_location&);

void throw_exception(const std::exception& error) {
  supple::viewer::fail_in_page(error.what());
}
void throw_exception(const std::exception& error, const source_location&) {
  supple::viewer::fail_in_page(error.what());
}
}  // namespace boost
