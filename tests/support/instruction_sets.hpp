#pragma once

#include <hwy/targets.h>

#include <cstdint>

namespace supple {

/// Calls `function(name)` once for each instruction set of this machine that the kernels are compiled for;
/// they choose it for the duration of the call.
template <class Function>
void for_each_target(Function function) {
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    function(hwy::TargetName(target));
  }
  hwy::SetSupportedTargetsForTest(0);
}

}  // namespace supple
