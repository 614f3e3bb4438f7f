#include "core/parallel.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <stdexcept>
#include <thread>
#include <vector>

#include "supple/threads.hpp"

#if defined(__linux__)
#include <sys/resource.h>
#endif

namespace supple::parallel_test {

class ParallelFor : public testing::TestWithParam<std::uint32_t> {};

TEST_P(ParallelFor, CoversEveryItemOnce) {
  const Parallel parallel(GetParam());
  for (const std::size_t count : {0u, 1u, 63u, 64u, 65u, 100000u}) {
    std::vector<std::uint8_t> visits(count);
    parallel.for_ranges(count, 64, [&](std::size_t begin, std::size_t end, std::uint32_t worker) {
      EXPECT_LT(worker, parallel.worker_count());
      for (std::size_t i = begin; i < end; ++i) ++visits[i];
    });
    EXPECT_EQ(std::vector<std::uint8_t>(count, 1), visits);
  }
}

TEST_P(ParallelFor, OneWorkerNeverRunsTwiceAtOnce) {
  const Parallel parallel(GetParam());
  std::vector<std::atomic<int>> busy(parallel.worker_count());
  std::atomic<bool> overlap = false;
  parallel.for_ranges(20000, 1, [&](std::size_t, std::size_t, std::uint32_t worker) {
    if (busy[worker].fetch_add(1) != 0) overlap = true;
    std::this_thread::yield();
    busy[worker].fetch_sub(1);
  });
  EXPECT_FALSE(overlap);
}

TEST_P(ParallelFor, ExceptionsReachTheCaller) {
  const Parallel parallel(GetParam());
  const auto throw_late = [](std::size_t, std::size_t end, std::uint32_t) {
    if (end == 10000) throw std::runtime_error("last range");
  };
  EXPECT_THROW(parallel.for_ranges(10000, 16, throw_late), std::runtime_error);
}

TEST_P(ParallelFor, MoreThreadsThanCoresPrintNothing) {
  testing::internal::CaptureStderr();
  const Parallel parallel(GetParam());
  parallel.for_ranges(10000, 1, [](std::size_t, std::size_t, std::uint32_t) {});
  EXPECT_EQ("", testing::internal::GetCapturedStderr());
}

INSTANTIATE_TEST_SUITE_P(Threads, ParallelFor, testing::Values(0u, 1u, 2u, 4u, 64u));

TEST(AvailableThreads, AreAsManyAsAskedFor) {
  EXPECT_EQ(available_threads(1), 1u);
  EXPECT_EQ(available_threads(5), 5u);
  EXPECT_EQ(available_threads(2), 2u);
  EXPECT_GE(available_threads(0), 1u);
}

// Sanitizers reserve more address space than any such limit.
#if defined(__linux__) && !defined(SUPPLE_SANITIZED)
/// Requests more threads than the address space allows. Exits with 0 when those that exist do all work.
[[noreturn]] void work_with_too_few_threads() {
  rlimit limit{};
  getrlimit(RLIMIT_AS, &limit);
  limit.rlim_cur = rlim_t{3} << 30;
  setrlimit(RLIMIT_AS, &limit);
  for (const std::uint32_t asked_for : {100u, 200u, 3u}) {
    const Parallel parallel(asked_for);
    std::vector<std::uint8_t> visits(10000);
    parallel.for_ranges(visits.size(), 10, [&](std::size_t begin, std::size_t end, std::uint32_t) {
      for (std::size_t i = begin; i < end; ++i) ++visits[i];
    });
    const bool is_done = std::ranges::all_of(visits, [](std::uint8_t count) { return count == 1; });
    if (!is_done || parallel.worker_count() < 2 || (asked_for > 3 && parallel.worker_count() > 40))
      std::_Exit(1);
  }
  std::_Exit(0);
}

TEST(AvailableThreadsDeathTest, AreFewerWhenTheSystemRefusesThem) {
  EXPECT_EXIT(work_with_too_few_threads(), testing::ExitedWithCode(0), "");
}
#endif

}  // namespace supple::parallel_test
