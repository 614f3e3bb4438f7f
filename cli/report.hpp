#pragma once

#include <cstdint>
#include <optional>

#include "supple/result.hpp"

namespace supple::cli {

/// What every report is told about a frame.
struct Frame {
  std::uint64_t number = 0;
  const DetectResult& result;
  std::optional<VerifyReport> verify;
};

}  // namespace supple::cli
