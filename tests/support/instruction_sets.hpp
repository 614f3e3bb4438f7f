#pragma once

#include <hwy/targets.h>

#include <cstdint>

namespace supple {

/// Calls `function(name)` once per instruction set that is compiled in and supported here. During the call,
/// the kernels use that set.
template <class Function>
void for_each_target(Function function) {
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    function(hwy::TargetName(target));
  }
  hwy::SetSupportedTargetsForTest(0);
}

}  // namespace supple
