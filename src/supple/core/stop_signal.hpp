#pragma once

#include <version>

#ifdef __cpp_lib_jthread
#include <stop_token>
#endif

namespace supple {

#ifdef __cpp_lib_jthread
using StopSignal = std::stop_token;
#else
/// Without threads, no call can be stopped.
struct StopSignal {
  bool stop_requested() const { return false; }
};
#endif

/// The stop of a request, or of limits.
template <class Limits>
StopSignal stop_of([[maybe_unused]] const Limits& limits) {
#ifdef __cpp_lib_jthread
  return limits.stop;
#else
  return {};
#endif
}

}  // namespace supple
