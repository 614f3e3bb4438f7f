#pragma once

#include <optional>

#include "contact/impact_search.hpp"
#include "contact/relative_motion.hpp"
#include "supple/continuous.hpp"

namespace supple {

/// `first_impact` for finite coordinates and valid options. Sets `used_exact` when floating point could not
/// decide, and leaves it unchanged otherwise.
std::optional<Impact> first_impact_of_finite(const ElementMotion& motion, const ImpactOptions& options,
                                             bool& used_exact);

/// The same after the search of `relative`, the relative motion of the elements.
std::optional<Impact> first_impact_after(const ImpactSearch& search, const ElementMotion& motion,
                                         const RelativeMotion& relative, const ImpactOptions& options,
                                         bool& used_exact);

}  // namespace supple
