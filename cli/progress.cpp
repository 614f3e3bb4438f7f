#include "progress.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include <string>

namespace supple::cli {

Progress::Progress(std::uint64_t total, bool enabled)
    : total_(total),
      enabled_(enabled && isatty(STDERR_FILENO) != 0),
      next_(Clock::now() + std::chrono::seconds(1)) {}

Progress::~Progress() {
  if (shown_) fmt::print(stderr, "\r\033[K");
}

void Progress::update(std::uint64_t done, std::string_view what) {
  if (!enabled_ || Clock::now() < next_) return;
  constexpr std::uint64_t width = 40;
  const std::uint64_t filled = done * width / total_;
  fmt::print(stderr, "\r[{}{}] {}\033[K", std::string(filled, '#'), std::string(width - filled, '.'), what);
  shown_ = true;
  next_ = Clock::now() + std::chrono::milliseconds(100);
}

}  // namespace supple::cli
