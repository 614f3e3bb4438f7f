#pragma once

#include <algorithm>
#include <chrono>

namespace supple {

/// Measures seconds by the steady clock since construction or since the last lap. Never negative, also when
/// the clock of a virtual machine goes backwards.
class Timer {
 public:
  double lap() {
    const auto now = std::chrono::steady_clock::now();
    const double seconds = std::chrono::duration<double>(now - start_).count();
    start_ = now;
    return std::max(seconds, 0.0);
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace supple
