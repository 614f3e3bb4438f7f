#include "work.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <utility>

#include "base/run_program.hpp"

namespace supple::experiments {

void Work::done(std::uint64_t steps, const std::string& what) {
  done_ = std::min(done_ + steps, total_);
  const double elapsed = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  const double part = static_cast<double>(done_) / static_cast<double>(std::max<std::uint64_t>(total_, 1));
  const std::string left = part > 0 ? fmt::format(", {} left", duration(elapsed / part - elapsed)) : "";
  progress_.update(done_, what + left);
}

void in_parallel(std::size_t count, std::optional<std::uint32_t> threads,
                 const std::function<bool(std::size_t)>& task) {
  std::mutex mutex;
  std::size_t next = 0;
  std::exception_ptr fault;
  const auto work = [&] {
    for (;;) {
      std::size_t taken = 0;
      {
        const std::lock_guard lock(mutex);
        if (next >= count) return;
        taken = next++;
      }
      try {
        if (task(taken)) continue;
        const std::lock_guard lock(mutex);
        next = count;
      } catch (...) {
        const std::lock_guard lock(mutex);
        fault = std::current_exception();
        next = count;
      }
    }
  };
  const unsigned given = threads.value_or(0);
  const unsigned wanted = given > 0 ? given : std::max(std::thread::hardware_concurrency(), 1u);
  std::vector<std::thread> others;
  try {
    while (others.size() + 1 < std::min<std::size_t>(wanted, count)) others.emplace_back(work);
  } catch (const std::system_error&) {
    cli::warn_of_missing_threads(wanted, static_cast<unsigned>(others.size()) + 1);
  }
  work();
  for (std::thread& thread : others) thread.join();
  if (fault) std::rethrow_exception(fault);
}

double least(const std::vector<double>& seconds) {
  return seconds.empty() ? 0 : *std::min_element(seconds.begin(), seconds.end());
}

std::string duration(double seconds) {
  const auto whole = static_cast<std::uint64_t>(std::ceil(std::max(seconds, 0.0)));
  if (whole < 60) return fmt::format("{} s", whole);
  if (whole < 3600) return fmt::format("{} min {} s", whole / 60, whole % 60);
  return fmt::format("{} h {} min", whole / 3600, whole % 3600 / 60);
}

}  // namespace supple::experiments
