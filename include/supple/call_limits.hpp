#pragma once

#include <version>

#ifdef __cpp_lib_jthread
#include <stop_token>
#endif

namespace supple {

/// Limits of one query, or of one call of `verify`. `DetectRequest` has those of `detect`.
struct CallLimits {
#ifdef __cpp_lib_jthread
  /// Any thread can stop the call: it ends within milliseconds. All answers are then empty: no result,
  /// `Containment::outside`, false, or an empty list. Where the token has a request after the call, the
  /// answers are not those of the query. The next call gives the same answers as without the stopped one.
  std::stop_token stop{};
#endif
};

}  // namespace supple
