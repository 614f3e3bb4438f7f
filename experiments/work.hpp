#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>

#include "base/progress.hpp"
#include "supple/result.hpp"
#include "supple/scene.hpp"

namespace supple::experiments {

/// The progress of an experiment, in steps that take about the same time.
class Work {
 public:
  Work(std::uint64_t total, bool shown) : total_(total), progress_(total, shown) {}

  void done(std::uint64_t steps, const std::string& what);

 private:
  std::uint64_t total_, done_ = 0;
  cli::Progress progress_;
};

/// Seconds of the processor that this thread has used. All experiments measure one thread by this clock, so
/// that other work of the machine changes times little.
double processor_seconds();

/// Processor seconds of a call.
template <class Call>
double seconds_of(Call&& call) {
  const double start = processor_seconds();
  call();
  return processor_seconds() - start;
}

/// Processor seconds of a detection with one thread, and its result. The stages share them as they share the
/// times in the statistics, which are those of the wall clock.
struct TimedDetection {
  explicit TimedDetection(Scene& scene);

  const DetectResult* result = nullptr;
  double refit = 0, broad = 0, narrow = 0, exact = 0, total = 0;
};

/// Calls `task(index)` for each index below `count`, in this order, several at a time: with `threads`
/// threads; none or 0: one per core. Stops after a call that returns false or throws, and rethrows.
void in_parallel(std::size_t count, std::optional<std::uint32_t> threads,
                 const std::function<bool(std::size_t)>& task);

}  // namespace supple::experiments
