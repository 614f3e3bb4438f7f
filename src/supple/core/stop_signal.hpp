#pragma once

#include <chrono>
#include <utility>
#include <version>

#ifdef __cpp_lib_jthread
#include <stop_token>
#endif

namespace supple {

/// A request to stop a call: by a token, or because its time is over. Without threads, only time can stop it.
class StopSignal {
 public:
  using Clock = std::chrono::steady_clock;

  StopSignal() = default;
#ifdef __cpp_lib_jthread
  StopSignal(std::stop_token token) : token_(std::move(token)) {}
#endif
  void end_at(Clock::time_point end) {
    end_ = end;
  }

  bool stop_requested() const {
#ifdef __cpp_lib_jthread
    if (token_.stop_requested()) return true;
#endif
    return end_ != Clock::time_point::max() && Clock::now() >= end_;
  }

 private:
#ifdef __cpp_lib_jthread
  std::stop_token token_;
#endif
  Clock::time_point end_ = Clock::time_point::max();
};

/// The stop of a request, or of limits.
template <class Limits>
StopSignal stop_of([[maybe_unused]] const Limits& limits) {
#ifdef __cpp_lib_jthread
  return limits.stop;
#else
  return {};
#endif
}

}  // namespace supple
