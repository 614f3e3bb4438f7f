#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>

#if !defined(SUPPLE_SERIAL)
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>
#include <tbb/task_arena.h>
#endif

namespace supple {

/// The one door to threads. Work handed in must not depend on how it is split or on which worker runs it.
/// Compiled with SUPPLE_SERIAL it runs everything on the calling thread.
class Parallel {
 public:
  /// `threads` = 0 takes one for each core.
  explicit Parallel(std::uint32_t threads);

  /// Workers that may run at once; `worker` below is less than this.
  std::uint32_t worker_count() const { return worker_count_; }

  /// Calls `body(begin, end, worker)` on ranges that cover [0, count), each of at least about `grain` items.
  /// Two calls with the same `worker` never run at the same time, so it may index scratch memory.
  template <class Body>
  void for_ranges(std::size_t count, std::size_t grain, Body&& body) const {
    if (count == 0) return;
#if !defined(SUPPLE_SERIAL)
    if (worker_count_ > 1 && count > grain) {
      arena_->execute([&] {
        tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, grain), [&](const auto& range) {
          body(range.begin(), range.end(),
               static_cast<std::uint32_t>(tbb::this_task_arena::current_thread_index()));
        });
      });
      return;
    }
#else
    (void)grain;
#endif
    body(std::size_t{0}, count, std::uint32_t{0});
  }

  /// True when `body(begin, end)` is true for every range; all ranges are run.
  template <class Body>
  bool all_of_ranges(std::size_t count, std::size_t grain, Body&& body) const {
    std::atomic<bool> all = true;
    for_ranges(count, grain, [&](std::size_t begin, std::size_t end, std::uint32_t) {
      if (!body(begin, end)) all.store(false, std::memory_order_relaxed);
    });
    return all.load();
  }

  /// Sorts in place. No two items may be equivalent, so that the result does not depend on the order of work.
  template <class Iterator, class Less>
  void sort(Iterator first, Iterator last, const Less& less) const {
#if !defined(SUPPLE_SERIAL)
    if (worker_count_ > 1 && last - first > 4096) {
      arena_->execute([&] { tbb::parallel_sort(first, last, less); });
      return;
    }
#endif
    std::sort(first, last, less);
  }

 private:
  std::uint32_t worker_count_ = 1;
#if !defined(SUPPLE_SERIAL)
  std::unique_ptr<tbb::task_arena> arena_;
#endif
};

}  // namespace supple
