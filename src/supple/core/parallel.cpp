#include "core/parallel.hpp"

#if !defined(SUPPLE_SERIAL)
#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <optional>
#include <vector>

// oneTBB is not built with the thread sanitizer, so the sanitizer would report each transfer of work as a
// race. Therefore this file is not instrumented either. It tells the sanitizer the order: the caller's
// earlier work comes before the ranges, the ranges of one worker follow each other, and all ranges come
// before the caller's later work. Races between ranges are still reported.
#if defined(SUPPLE_THREAD_SANITIZER)
#include <sanitizer/tsan_interface.h>
#define SUPPLE_HAPPENS_BEFORE(address) __tsan_release(address)
#define SUPPLE_HAPPENS_AFTER(address) __tsan_acquire(address)
#else
#define SUPPLE_HAPPENS_BEFORE(address) (void)(address)
#define SUPPLE_HAPPENS_AFTER(address) (void)(address)
#endif
#endif

namespace supple {

#if defined(SUPPLE_SERIAL)

struct Parallel::Threads {};

Parallel::Parallel(std::uint32_t) {}

void Parallel::run(std::size_t count, std::size_t, void* callable, RangeFunction function) const {
  function(callable, 0, count, 0);
}

#else

struct Parallel::Threads {
  explicit Threads(int count) : arena(count), worker_tokens(static_cast<std::size_t>(count)) {
    // More threads than cores are unusual but allowed. Without this, oneTBB prints a warning on standard
    // error.
    if (count > tbb::this_task_arena::max_concurrency())
      more_than_cores.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(count));
  }

  std::optional<tbb::global_control> more_than_cores;
  tbb::task_arena arena;
  // Only their addresses matter: they identify the transfers of work for the thread sanitizer.
  char fork_token = 0, join_token = 0;
  std::vector<char> worker_tokens;
};

Parallel::Parallel(std::uint32_t threads) {
  worker_count_ =
      threads != 0 ? threads : static_cast<std::uint32_t>(tbb::this_task_arena::max_concurrency());
  if (worker_count_ > 1) threads_ = std::make_unique<Threads>(static_cast<int>(worker_count_));
}

void Parallel::run(std::size_t count, std::size_t grain, void* callable, RangeFunction function) const {
  Threads& threads = *threads_;
  SUPPLE_HAPPENS_BEFORE(&threads.fork_token);
  threads.arena.execute([&] {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, grain), [&](const auto& range) {
      const auto worker = static_cast<std::uint32_t>(tbb::this_task_arena::current_thread_index());
      SUPPLE_HAPPENS_AFTER(&threads.fork_token);
      SUPPLE_HAPPENS_AFTER(&threads.worker_tokens[worker]);
      function(callable, range.begin(), range.end(), worker);
      SUPPLE_HAPPENS_BEFORE(&threads.worker_tokens[worker]);
      SUPPLE_HAPPENS_BEFORE(&threads.join_token);
    });
  });
  SUPPLE_HAPPENS_AFTER(&threads.join_token);
}

#endif

Parallel::~Parallel() = default;
Parallel::Parallel(Parallel&&) noexcept = default;
Parallel& Parallel::operator=(Parallel&&) noexcept = default;

}  // namespace supple
