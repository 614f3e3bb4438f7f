#pragma once

#include <optional>

#include "contact/relative_motion.hpp"
#include "supple/continuous.hpp"

namespace supple {

/// `first_impact` for motions whose coordinates are known to be finite and options that are known to be
/// valid. `relative` is `relative_motion(motion)`. `used_exact` is set when floating point could not decide,
/// and otherwise left alone.
template <class Motion>
std::optional<Impact> first_impact_of_finite(const Motion& motion, const RelativeMotion& relative,
                                             const ImpactOptions& options, bool& used_exact);

}  // namespace supple
