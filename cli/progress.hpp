#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <string_view>

namespace supple::cli {

/// A line on the terminal that says how far a command has come, for whatever takes over a second. Silent when
/// standard error is no terminal.
class Progress {
 public:
  /// What `total` counts, e.g. `step`: its rate is shown too. Empty when it is not for people's eyes.
  Progress(std::uint64_t total, bool enabled, std::string_view noun = {});
  /// Removes the line, so that what follows starts clean.
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// `what` says it in words: `frame 3 of 10`.
  void update(std::uint64_t done, std::string_view what);

 private:
  using Clock = std::chrono::steady_clock;

  /// `, 12.3 steps/s, 0:05 left`.
  std::string pace(std::uint64_t done, Clock::time_point now);

  std::uint64_t total_;
  bool enabled_;
  std::string noun_;
  bool shown_ = false;
  Clock::time_point next_;
  Clock::time_point last_;  ///< when `last_done_` were done
  std::uint64_t last_done_ = 0;
  double rate_ = 0;  ///< a second, of the last seconds; 0 when not known yet
};

}  // namespace supple::cli
