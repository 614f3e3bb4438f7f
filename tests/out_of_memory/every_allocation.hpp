#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <cstdlib>
#include <limits>
#include <new>
#include <string>
#include <string_view>

#include "steady_state/allocation_count.hpp"
#include "supple/error.hpp"

namespace supple {

/// Refuses one allocation: the n-th of all calls together.
class Refusal {
 public:
  explicit Refusal(std::int64_t n) : left_(n) {}

  /// Makes the call. Returns whether it failed for lack of memory, by `std::bad_alloc` or, where a library
  /// reports only an error, by `Error`.
  template <class Call>
  bool strikes(const Call& call) {
    bool is_out = false;
    refuse_allocation(left_);
    try {
      call();
    } catch (const std::bad_alloc&) {
      is_out = true;
    } catch (const Error&) {
      is_out = allow_allocations() <= 0;
      if (!is_out) throw;
    }
    left_ = allow_allocations();
    failures_ += is_out;
    return is_out;
  }
  /// Makes the call, and makes it again when it failed.
  template <class Call>
  void repeat(const Call& call) {
    if (strikes(call)) call();
  }
  std::int64_t left() const { return left_; }
  std::int64_t failures() const { return failures_; }

 private:
  std::int64_t left_, failures_ = 0;
};

/// Calls `life(refusal)` once for each of its allocations, which the refusal refuses. A life frees all that
/// it allocates. Takes about 500 allocations, evenly spread (20 under sanitizers), and every one with
/// `SUPPLE_FAULTS=all`; `many` takes 4000.
template <class Life>
void refuse_every_allocation(const Life& life, bool counts_leaks = true) {
  constexpr std::int64_t many = std::numeric_limits<std::int64_t>::max();
  Refusal none(many);
  {
    // This life also fills what the program keeps until its end, such as the stack of traces.
    SCOPED_TRACE("");
    SCOPED_TRACE("");
    SCOPED_TRACE("");
    life(none);
  }
  const std::int64_t allocations = many - none.left();
  const char* const wanted = std::getenv("SUPPLE_FAULTS");
  const bool takes_all = wanted != nullptr && std::string_view(wanted) == "all";
  const bool takes_many = wanted != nullptr && std::string_view(wanted) == "many";
  const std::int64_t few = std::getenv("SUPPLE_SANITIZED") != nullptr ? 20 : takes_many ? 4000 : 500;
  const std::int64_t stride = takes_all ? 1 : allocations / few + 1;
  std::int64_t lives = 0, failures = 0;
  for (std::int64_t n = 1; n <= allocations && !testing::Test::HasFailure(); n += stride, ++lives) {
    const std::int64_t live = live_allocation_count();
    {
      const std::string what =
          "allocation " + std::to_string(n) + " of " + std::to_string(allocations) + " is refused";
      SCOPED_TRACE(what);
      Refusal refusal(n);
      life(refusal);
      failures += refusal.failures();
    }
    if (!counts_leaks) continue;
    EXPECT_EQ(live_allocation_count(), live) << "memory leaks when allocation " << n << " is refused";
  }
  EXPECT_GT(4 * failures, lives) << "many failures must reach the caller";
}

}  // namespace supple
