#include "core/parallel.hpp"

#include "supple/threads.hpp"

#if !defined(SUPPLE_SERIAL)
#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <latch>
#include <memory>
#include <mutex>
#include <new>
#include <optional>
#include <semaphore>
#include <system_error>
#include <thread>
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

std::uint32_t available_threads(std::uint32_t) {
  return 1;
}
std::uint32_t usable_cores() {
  return 1;
}

Parallel::Parallel(std::uint32_t) {}

void Parallel::run(std::size_t count, std::size_t, void* callable, RangeFunction function) const {
  function(callable, 0, count, 0);
}

#else

std::uint32_t usable_cores() {
  return static_cast<std::uint32_t>(tbb::this_task_arena::max_concurrency());
}

namespace {

/// Creates up to `count` threads that exist at the same time, and ends them. Returns how many there were.
std::uint32_t count_new_threads(std::uint32_t count) {
  // Beside the stack, the C library may reserve 64 MB for the allocations of a thread.
  const std::size_t size =
      tbb::global_control::active_value(tbb::global_control::thread_stack_size) + (std::size_t{64} << 20);
  std::vector<std::thread> threads;
  threads.reserve(count);
  std::uint32_t complete = 0;
  std::counting_semaphore<> started(0);
  std::latch can_end(1);
  const auto run = [&] {
    const std::unique_ptr<void, decltype(&std::free)> memory(std::malloc(size), &std::free);
    if (memory != nullptr) {
      // A compiler may leave out an allocation that nothing uses.
      *static_cast<volatile char*>(memory.get()) = 0;
      ++complete;
    }
    started.release();
    can_end.wait();
  };
  try {
    while (threads.size() < count && complete == threads.size()) {
      threads.emplace_back(run);
      started.acquire();
    }
  } catch (const std::system_error&) {  // no more threads
  } catch (const std::bad_alloc&) {
  }
  can_end.count_down();
  for (std::thread& thread : threads) thread.join();
  return complete;
}

/// The threads of oneTBB. It creates threads when work comes, and ends the process when it cannot create one.
/// So this tries out first how many can be created, and then makes oneTBB create half as many: the other half
/// leaves room for memory and for other processes.
class ThreadSupply {
 public:
  /// Returns how many threads there are for a caller that asks for `count`, itself included.
  std::uint32_t provide(std::uint32_t count) {
    const std::lock_guard lock(mutex_);
    if (count > most_asked_for_) {
      most_asked_for_ = count;
      const std::uint32_t more = count_new_threads(2 * (count - count_)) / 2;
      if (more != 0) start(count_ + more);
    }
    return std::min(count, count_);
  }

 private:
  void start(std::uint32_t count) {
    // More threads than cores are unusual but allowed. Without this, oneTBB prints a warning on standard
    // error. Of several such controls, the smallest value would count.
    if (count > usable_cores()) more_than_cores_.emplace(tbb::global_control::max_allowed_parallelism, count);
    auto arena = std::make_unique<tbb::task_arena>(static_cast<int>(count));
    // No thread leaves before all are there. oneTBB may give fewer, because of other work or of a limit that
    // the program sets; so this does not wait for them for ever.
    std::atomic<std::uint32_t> missing = count;
    const auto end = std::chrono::steady_clock::now() + std::chrono::milliseconds(100);
    arena->execute([&] {
      tbb::parallel_for(
          std::uint32_t{0}, count,
          [&](std::uint32_t) {
            --missing;
            while (missing != 0 && std::chrono::steady_clock::now() < end) std::this_thread::yield();
          },
          tbb::static_partitioner());
    });
    arena_ = std::move(arena);
    count_ = count;
  }

  std::mutex mutex_;
  std::uint32_t most_asked_for_ = 1;  // what was refused once is not tried again
  std::uint32_t count_ = 1;
  std::optional<tbb::global_control> more_than_cores_;
  std::unique_ptr<tbb::task_arena> arena_;  // without an arena, oneTBB ends its threads
};

}  // namespace

std::uint32_t available_threads(std::uint32_t threads) {
  // Never destroyed: when the process ends, oneTBB's threads may have ended before.
  static ThreadSupply& supply = *new ThreadSupply;
  return supply.provide(threads != 0 ? threads : usable_cores());
}

struct Parallel::Threads {
  explicit Threads(std::uint32_t count) : arena(static_cast<int>(count)), worker_tokens(count) {}

  tbb::task_arena arena;
  // Only their addresses matter: they identify the transfers of work for the thread sanitizer.
  char fork_token = 0, join_token = 0;
  std::vector<char> worker_tokens;
};

Parallel::Parallel(std::uint32_t threads) : worker_count_(available_threads(threads)) {
  if (worker_count_ > 1) threads_ = std::make_unique<Threads>(worker_count_);
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
