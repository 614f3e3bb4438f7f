#include "base/progress.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>

namespace supple::cli {
namespace {

/// `0:05`, `2:03:04`, `11 days`.
std::string clock_text(double seconds) {
  if (!(seconds < 360000)) return fmt::format("{:.0f} days", seconds / 86400);
  const auto whole = static_cast<std::uint64_t>(std::ceil(seconds));
  const std::uint64_t hours = whole / 3600, minutes = whole / 60 % 60;
  return hours > 0 ? fmt::format("{}:{:02}:{:02}", hours, minutes, whole % 60)
                   : fmt::format("{}:{:02}", minutes, whole % 60);
}

std::string rate_text(double rate) {
  return rate >= 100 ? fmt::format("{:.0f}", rate) : fmt::format("{:.3g}", rate);
}

}  // namespace

Progress::Progress(std::uint64_t total, bool enabled, std::string_view noun)
    : total_(total),
      enabled_(enabled && isatty(STDERR_FILENO) != 0),
      noun_(noun),
      next_(Clock::now() + std::chrono::seconds(1)),
      last_(Clock::now()) {}

Progress::~Progress() {
  if (shown_) fmt::print(stderr, "\r\033[K");
}

void Progress::update(std::uint64_t done, std::string_view what) {
  if (!enabled_) return;
  const Clock::time_point now = Clock::now();
  if (now < next_) return;
  constexpr std::uint64_t width = 20;  // the line stays within 80 columns
  const auto filled =
      static_cast<std::uint64_t>(static_cast<double>(done) / static_cast<double>(total_) * width);
  fmt::print(stderr, "\r[{}{}] {}{}\033[K", std::string(filled, '#'), std::string(width - filled, '.'), what,
             pace(done, now));
  shown_ = true;
  next_ = now + std::chrono::milliseconds(100);
}

std::string Progress::pace(std::uint64_t done, Clock::time_point now) {
  const double seconds = std::chrono::duration<double>(now - last_).count();
  const double rate = static_cast<double>(done - last_done_) / seconds;
  // Uses only the last seconds, so that the rate follows a run that becomes slower.
  const double forgotten = rate_ == 0 ? 1 : std::min(1.0, seconds / 3);
  rate_ += (rate - rate_) * forgotten;
  last_ = now;
  last_done_ = done;
  if (!(rate_ > 0)) return "";
  const std::string left = clock_text(static_cast<double>(total_ - done) / rate_);
  return noun_.empty() ? fmt::format(", {} left", left)
                       : fmt::format(", {} {}s/s, {} left", rate_text(rate_), noun_, left);
}

}  // namespace supple::cli
