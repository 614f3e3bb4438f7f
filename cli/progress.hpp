#pragma once

#include <chrono>
#include <cstdint>
#include <string_view>

namespace supple::cli {

/// A line on the terminal that says how far a command has come, for whatever takes over a second. Silent when
/// standard error is no terminal.
class Progress {
 public:
  Progress(std::uint64_t total, bool enabled);
  /// Removes the line, so that what follows starts clean.
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// `what` says it in words: `frame 3 of 10`.
  void update(std::uint64_t done, std::string_view what);

 private:
  using Clock = std::chrono::steady_clock;

  std::uint64_t total_;
  bool enabled_;
  bool shown_ = false;
  Clock::time_point next_;
};

}  // namespace supple::cli
