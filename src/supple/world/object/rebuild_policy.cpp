#include "world/object/rebuild_policy.hpp"

#include <algorithm>

namespace supple {
namespace {

/// In queries of the octree as built.
constexpr double rebuild_cost = 60;
constexpr double least_degradation = 1.25;
/// Leaves that are patches of the surface stay good for longer than leaves that are parts of space, and more
/// of them cannot touch themselves. So the new octree must be much better.
constexpr double most_remaining_cost = 0.5;
constexpr double most_backoff = 1024;
/// A prime, so that a motion that repeats after a few refits is measured in each of its phases.
constexpr std::uint32_t refits_per_measurement = 7;
/// Used when the cost at the built positions is unknown because they are one point.
constexpr double usual_cost = 16;

}  // namespace

void RebuildPolicy::set_cost_when_built(double cost) {
  cost_ = cost;
  cost_when_built_ = cost > 0 ? cost : usual_cost;
}

bool RebuildPolicy::should_measure() {
  if (!is_enabled_ || (!is_degraded() && --refits_until_measured_ > 0)) return false;
  refits_until_measured_ = refits_per_measurement;
  return true;
}

bool RebuildPolicy::is_degraded() const {
  return is_enabled_ && degradation(cost_) > least_degradation;
}

bool RebuildPolicy::count_queries(double queries) {
  accumulated_extra_cost_ += queries * (degradation(cost_) - 1);
  return accumulated_extra_cost_ >= backoff_ * rebuild_cost;
}

bool RebuildPolicy::accept(double cost) {
  accumulated_extra_cost_ = 0;
  const bool is_better = cost <= most_remaining_cost * cost_;
  backoff_ = is_better ? std::max(backoff_ / 2, 1.0) : std::min(2 * backoff_, most_backoff);
  set_cost_when_built(is_better ? cost : cost_);
  return is_better;
}

}  // namespace supple
