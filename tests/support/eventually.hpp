#pragma once

#include <chrono>
#include <thread>

namespace supple {

/// Waits for a condition. Returns false if it does not hold within a minute, long enough on any machine.
template <class Condition>
bool eventually(Condition condition) {
  const auto limit = std::chrono::steady_clock::now() + std::chrono::minutes(1);
  while (!condition()) {
    if (std::chrono::steady_clock::now() > limit) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return true;
}

}  // namespace supple
