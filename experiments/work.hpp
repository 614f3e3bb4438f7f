#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/progress.hpp"

namespace supple::experiments {

/// The progress of an experiment, in steps that take about the same time, and the remaining time.
class Work {
 public:
  Work(std::uint64_t total, bool shown) : total_(total), progress_(total, shown) {}

  void done(std::uint64_t steps, const std::string& what);

 private:
  std::uint64_t total_, done_ = 0;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  cli::Progress progress_;
};

/// Wall-clock seconds of a call.
template <class Call>
double seconds_of(Call&& call) {
  const auto start = std::chrono::steady_clock::now();
  call();
  return std::max(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(), 0.0);
}

/// Calls `task(index)` for each index below `count`, in this order, several at a time: with `threads`
/// threads; none or 0: one per core. Stops after a call that returns false or throws, and rethrows.
void in_parallel(std::size_t count, std::optional<std::uint32_t> threads,
                 const std::function<bool(std::size_t)>& task);

/// The minimum of several times of the same work, because other work of the machine only adds time. 0 when
/// there are no times.
double least(const std::vector<double>& seconds);

/// `2 min 10 s`
std::string duration(double seconds);

}  // namespace supple::experiments
