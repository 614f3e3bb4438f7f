#pragma once

#include <array>
#include <optional>

#include "contact/distance/element_distance.hpp"
#include "contact/impact/impact_search.hpp"
#include "contact/impact/relative_motion.hpp"
#include "supple/continuous.hpp"

namespace supple {

/// The part of the step in which impacts are searched: a little more than up to `max_time`, because a
/// reported time may be early.
float end_of_search(const ImpactOptions& options);

/// A bound of the true times of contacts that are reported, or that end safe steps, at this time or before.
float latest_true_time(double time);

/// The elements at one end of a motion.
ElementPoints element_points(const std::array<Vec3d, 4>& points, bool are_edges);

/// Whether the elements are within `separation` at the start, exactly.
bool are_within(const ElementMotion& motion, double separation);

/// A time up to which the elements stay farther apart than `separation`, early by no more than the
/// tolerances; nothing when they do so within the whole step. Without `exact` it may be earlier, or there may
/// be one when they stay apart.
std::optional<double> first_time_within(const ElementMotion& motion, const RelativeMotion& relative,
                                        double separation, bool exact, bool& used_exact);

/// `first_impact` for finite coordinates and valid options, after the search of `relative`, the relative
/// motion of the elements. Sets `used_exact` when floating point could not decide.
std::optional<Impact> first_impact_after(const ImpactSearch& search, const ElementMotion& motion,
                                         const RelativeMotion& relative, const ImpactOptions& options,
                                         bool& used_exact);

}  // namespace supple
