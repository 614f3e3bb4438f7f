#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <version>

#ifdef __cpp_lib_jthread
#include <stop_token>
#endif

#include "supple/contact.hpp"
#include "supple/types.hpp"

namespace supple {

/// The two elements that limit a step, named as in `ContinuousContact`.
struct LimitingPair {
  ObjectId object_a, object_b;  ///< equal for two elements of one object
  ElementPairKind kind = ElementPairKind::vertex_face;
  std::array<std::uint32_t, 2> element_a{}, element_b{};

  constexpr bool operator==(const LimitingPair&) const = default;
};

/// The safe part of a step.
struct SafeStep {
  double step = 1;  ///< 0 to 1
  /// The pair that ends it; of several at the same time the first in canonical order. Nothing for the whole
  /// step.
  std::optional<LimitingPair> limit;
  /// `StepLimits` ended the call before its search was complete. `step` is then 0, although there may be a
  /// larger one.
  bool stopped = false;

  constexpr bool operator==(const SafeStep&) const = default;
};

/// Limits of one search for a step. A call that they end says what it has proven; see `SafeStep::stopped`.
/// The next call gives the same answer as without the ended one.
struct StepLimits {
#ifdef __cpp_lib_jthread
  /// Any thread can stop the call: it ends within milliseconds.
  std::stop_token stop{};
#endif
  /// The call ends within milliseconds after so many seconds, ≥ 0. The time does not include the refit of the
  /// objects that moved.
  double seconds = std::numeric_limits<double>::infinity();
};

/// The safe part of the step of one object; see `Scene::collision_free_steps`.
struct ObjectStep {
  ObjectId object;
  /// The first of the objects that move by the same part.
  ObjectId island;
  SafeStep safe;

  constexpr bool operator==(const ObjectStep&) const = default;
};

}  // namespace supple
