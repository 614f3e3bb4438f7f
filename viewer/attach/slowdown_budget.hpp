#pragma once

#include <algorithm>

namespace supple::viewer {

/// Decides when a program can afford a frame: of each second, a share may be spent. Seconds are those of any
/// clock that never goes back.
class SlowdownBudget {
 public:
  SlowdownBudget(double share, double now) : share_(share), last_(now) {}

  bool affords(double now) {
    earn(now);
    return credit_ >= 0;
  }
  /// A frame took from `begin` to `end`. A frame that costs more than there is delays the next one.
  void spend(double begin, double end) {
    earn(begin);
    credit_ -= end - begin;
    last_ = end;
  }
  /// The time from `begin` to `end` does not count.
  void skip(double begin, double end) {
    earn(begin);
    last_ = end;
  }

 private:
  /// What a program saves in this many seconds is kept for a frame that costs much. With more, a burst of
  /// frames could follow a long time without any.
  static constexpr double memory = 1;

  void earn(double now) {
    credit_ = std::min(credit_ + share_ * std::max(now - last_, 0.0), share_ * memory);
    last_ = std::max(now, last_);
  }

  double share_;
  double last_;
  double credit_ = 0;
};

}  // namespace supple::viewer
