// Operators new and delete that count allocations and can refuse them. They are in a separate file: if they
// were inlined into the code under test, compilers would warn about mismatched new and free.

#include "allocation_count.hpp"

#include <atomic>
#include <cstddef>
#include <cstdlib>
#include <limits>
#include <new>

namespace {

std::atomic<std::uint64_t> allocations = 0;
std::atomic<std::int64_t> live = 0;
std::atomic<std::int64_t> until_refused = 0;  // the allocation that makes it 0 is refused
std::atomic<std::size_t> refused_size = std::numeric_limits<std::size_t>::max();

void* counted_allocation(std::size_t size, std::size_t alignment) {
  allocations.fetch_add(1, std::memory_order_relaxed);
  if (size >= refused_size.load(std::memory_order_relaxed)) throw std::bad_alloc();
  if (until_refused.fetch_sub(1, std::memory_order_relaxed) == 1) throw std::bad_alloc();
  void* const memory = alignment <= alignof(std::max_align_t)
                           ? std::malloc(size)
                           : std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
  if (memory == nullptr) throw std::bad_alloc();
  live.fetch_add(1, std::memory_order_relaxed);
  return memory;
}

void counted_free(void* memory) {
  if (memory != nullptr) live.fetch_sub(1, std::memory_order_relaxed);
  std::free(memory);
}

}  // namespace

void* operator new(std::size_t size) {
  return counted_allocation(size, 1);
}
void* operator new[](std::size_t size) {
  return counted_allocation(size, 1);
}
void* operator new(std::size_t size, std::align_val_t alignment) {
  return counted_allocation(size, static_cast<std::size_t>(alignment));
}
void* operator new[](std::size_t size, std::align_val_t alignment) {
  return counted_allocation(size, static_cast<std::size_t>(alignment));
}
void operator delete(void* memory) noexcept {
  counted_free(memory);
}
void operator delete[](void* memory) noexcept {
  counted_free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
  counted_free(memory);
}
void operator delete[](void* memory, std::size_t) noexcept {
  counted_free(memory);
}
void operator delete(void* memory, std::align_val_t) noexcept {
  counted_free(memory);
}
void operator delete[](void* memory, std::align_val_t) noexcept {
  counted_free(memory);
}
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
  counted_free(memory);
}
void operator delete[](void* memory, std::size_t, std::align_val_t) noexcept {
  counted_free(memory);
}

namespace supple {

std::uint64_t allocation_count() {
  return allocations.load();
}

std::int64_t live_allocation_count() {
  return live.load();
}

void refuse_allocations_from(std::size_t bytes) {
  refused_size = bytes;
}

void refuse_allocation(std::int64_t n) {
  until_refused = n;
}

std::int64_t allow_allocations() {
  return until_refused.exchange(0);
}

}  // namespace supple
