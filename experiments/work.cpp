#include "work.hpp"

#include <algorithm>
#include <atomic>
#include <ctime>
#include <future>
#include <system_error>
#include <thread>
#include <vector>

#include "base/run_program.hpp"

namespace supple::experiments {

void Work::done(std::uint64_t steps, const std::string& what) {
  done_ = std::min(done_ + steps, total_);
  progress_.update(done_, what);
}

double processor_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

TimedDetection::TimedDetection(Scene& scene) {
  total = seconds_of([&] { result = &scene.detect(); });
  const StepStats& stats = result->stats;
  const double share = stats.total_seconds > 0 ? total / stats.total_seconds : 0;
  refit = share * stats.refit_seconds;
  broad = share * stats.broad_phase_seconds;
  narrow = share * stats.traversal_seconds;
  exact = share * stats.exact_seconds;
}

void in_parallel(std::size_t count, std::optional<std::uint32_t> threads,
                 const std::function<bool(std::size_t)>& task) {
  std::atomic<std::size_t> next = 0;
  const auto work = [&] {
    try {
      for (std::size_t index = next++; index < count; index = next++) {
        if (!task(index)) next = count;
      }
    } catch (...) {
      next = count;
      throw;
    }
  };
  const unsigned given = threads.value_or(0);
  const unsigned wanted = given > 0 ? given : std::max(std::thread::hardware_concurrency(), 1u);
  std::vector<std::future<void>> others;
  try {
    while (others.size() + 1 < std::min<std::size_t>(wanted, count))
      others.push_back(std::async(std::launch::async, work));
  } catch (const std::system_error&) {
    cli::warn_of_missing_threads(wanted, static_cast<unsigned>(others.size()) + 1);
  }
  work();
  for (std::future<void>& other : others) other.get();
}

}  // namespace supple::experiments
