#pragma once

#include <cstdint>

#include "contact/relative_motion.hpp"

namespace supple {

/// What floating point can prove about the first impact of two elements.
struct ImpactSearch {
  enum class Outcome : std::uint8_t {
    apart,     ///< they do not touch within the step
    touching,  ///< they touch, first within the tolerances after `time`; at 0 only when at the start
    unsure,    ///< only exact arithmetic can decide; they do not touch before `time`
  };
  Outcome outcome = Outcome::unsure;
  double time = 0;
};

/// Error bounds prove every outcome, for all finite coordinates. `separation` ≥ 0. Takes about 0.3 µs.
ImpactSearch search_impact(const RelativeMotion& motion, double separation);

RelativePlaces<double> places_at(const RelativeMotion& motion, double time);

}  // namespace supple
