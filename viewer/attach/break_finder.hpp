#pragma once

#include <array>
#include <optional>

#include "session/program/program.hpp"

namespace supple::viewer {

/// Throws `Error` when an event can never happen, because its kind of contacts is not detected.
void check(const BreakOptions& breaks, ContactKinds detected);

/// Finds the events that pause a program.
class BreakFinder {
 public:
  /// The first event that begins in the last step of the scene.
  std::optional<Break> find(const Scene& scene, const BreakOptions& breaks);
  /// An event that lasts begins again.
  void forget() { lasts_ = {}; }

 private:
  bool begins(std::size_t event, bool holds);

  std::array<bool, 4> lasts_{};  // in the last step
};

}  // namespace supple::viewer
