#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

#include "progress.hpp"

namespace supple::experiments {

/// How far an experiment is, in steps that take about equally long, and how long the rest will take.
class Work {
 public:
  Work(std::uint64_t total, bool shown) : total_(total), progress_(total, shown) {}

  void done(std::uint64_t steps, const std::string& what);

 private:
  std::uint64_t total_, done_ = 0;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  cli::Progress progress_;
};

/// Seconds by the wall clock that a call takes.
template <class Call>
double seconds_of(Call&& call) {
  const auto start = std::chrono::steady_clock::now();
  call();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// The least of the times of the same work, 0 of none: whatever else the machine does only adds.
double least(const std::vector<double>& seconds);

/// `2 min 10 s`
std::string duration(double seconds);

}  // namespace supple::experiments
