#include "work.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace supple::experiments {

void Work::done(std::uint64_t steps, const std::string& what) {
  done_ = std::min(done_ + steps, total_);
  const double elapsed = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  const double part = static_cast<double>(done_) / static_cast<double>(std::max<std::uint64_t>(total_, 1));
  const std::string left = part > 0 ? fmt::format(", {} left", duration(elapsed / part - elapsed)) : "";
  progress_.update(done_, what + left);
}

double least(const std::vector<double>& seconds) {
  return seconds.empty() ? 0 : *std::min_element(seconds.begin(), seconds.end());
}

std::string duration(double seconds) {
  const auto whole = static_cast<std::uint64_t>(std::ceil(std::max(seconds, 0.0)));
  if (whole < 60) return fmt::format("{} s", whole);
  if (whole < 3600) return fmt::format("{} min {} s", whole / 60, whole % 60);
  return fmt::format("{} h {} min", whole / 3600, whole % 3600 / 60);
}

}  // namespace supple::experiments
