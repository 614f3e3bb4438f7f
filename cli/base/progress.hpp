#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <string_view>

namespace supple::cli {

/// A progress line on the terminal for commands that take longer than a second. Silent when standard error is
/// not a terminal.
class Progress {
 public:
  /// `noun` is the unit of `total`, such as `step`; the line then also shows the rate. Empty: no rate.
  Progress(std::uint64_t total, bool enabled, std::string_view noun = {});
  /// Removes the line, so that later output starts on an empty line.
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// `what` is the progress in words: `frame 3 of 10`.
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
  double rate_ = 0;  ///< per second, over the last seconds; 0 when unknown
};

}  // namespace supple::cli
