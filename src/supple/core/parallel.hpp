#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <type_traits>

namespace supple {

/// The only use of threads in the library. The work must not depend on how it is split, nor on which worker
/// runs it. With SUPPLE_SERIAL, everything runs on the calling thread.
class Parallel {
 public:
  /// `threads` = 0 means one per core.
  explicit Parallel(std::uint32_t threads);
  ~Parallel();
  Parallel(Parallel&&) noexcept;
  Parallel& operator=(Parallel&&) noexcept;

  /// The number of workers that may run at the same time; `worker` below is less than this.
  std::uint32_t worker_count() const { return worker_count_; }

  /// Calls `body(begin, end, worker)` for ranges that cover [0, count), each with about `grain` items or
  /// more. Two calls with the same `worker` never run at the same time, so it may index scratch memory.
  template <class Body>
  void for_ranges(std::size_t count, std::size_t grain, Body&& body) const {
    if (count == 0) return;
    if (worker_count_ == 1 || count <= grain) {
      body(std::size_t{0}, count, std::uint32_t{0});
      return;
    }
    using Callable = std::remove_reference_t<Body>;
    run(count, grain, const_cast<void*>(static_cast<const void*>(&body)),
        [](void* callable, std::size_t begin, std::size_t end, std::uint32_t worker) {
          (*static_cast<Callable*>(callable))(begin, end, worker);
        });
  }

  /// Returns true when `body(begin, end)` is true for every range. Runs all ranges.
  template <class Body>
  bool all_of_ranges(std::size_t count, std::size_t grain, Body&& body) const {
    std::atomic<bool> all = true;
    for_ranges(count, grain, [&](std::size_t begin, std::size_t end, std::uint32_t) {
      if (!body(begin, end)) all.store(false, std::memory_order_relaxed);
    });
    return all.load();
  }

 private:
  using RangeFunction = void (*)(void* callable, std::size_t begin, std::size_t end, std::uint32_t worker);
  void run(std::size_t count, std::size_t grain, void* callable, RangeFunction function) const;

  struct Threads;
  std::uint32_t worker_count_ = 1;
  std::unique_ptr<Threads> threads_;
};

}  // namespace supple
