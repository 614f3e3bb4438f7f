#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "supple/result.hpp"
#include "supple/verify.hpp"

namespace supple::cli {

/// The data of a frame for all reports.
struct Frame {
  std::uint64_t number = 0;
  const DetectResult& result;
  std::optional<VerifyReport> verify{};
  /// Only for simulated frames.
  struct Simulated {
    double time = 0;            ///< s, since the start
    double motion_seconds = 0;  ///< wall-clock time of the motion
  };
  std::optional<Simulated> simulated{};
  /// Objects whose straight paths in a step are not their motion; see half_turns.hpp.
  std::vector<ObjectId> turned{};
};

}  // namespace supple::cli
