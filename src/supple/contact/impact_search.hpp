#pragma once

#include <cstdint>

#include "contact/relative_motion.hpp"

namespace supple {

/// What floating point can prove of the first impact of two elements.
struct ImpactSearch {
  enum class Outcome : std::uint8_t {
    apart,     ///< they do not touch within the step
    touching,  ///< they do, first within `toi_tolerance` after `time`
    unsure,    ///< only exact arithmetic can tell; they do not touch before `time`
  };
  Outcome outcome = Outcome::unsure;
  double time = 0;
};

/// Every outcome is proven by error bounds, for all finite coordinates. About 0.3 µs. `separation` ≥ 0.
ImpactSearch search_impact(const RelativeMotion& motion, double separation);

RelativePlaces<double> places_at(const RelativeMotion& motion, double time);

}  // namespace supple
