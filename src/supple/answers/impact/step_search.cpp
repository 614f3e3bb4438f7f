#include "answers/impact/step_search.hpp"

#include <chrono>
#include <cmath>
#include <limits>
#include <string>

#include "core/error.hpp"
#include "core/float_rounding.hpp"
#include "geometry/aabb.hpp"
#include "geometry/vector.hpp"
#include "octree/refit_bottom_up.hpp"

namespace supple {
namespace {

/// Bounds of the ways, end - start, of the vertices of each child, by node; without vertices that are not
/// finite. O(n).
void set_way_boxes(const ObjectOctree& octree, const SurfaceElements& elements, const VertexBuffer& start,
                   const VertexBuffer& end, std::vector<ChildBoxes>& ways) {
  ways.resize(octree.nodes().size());
  refit_child_boxes(octree.nodes(), ways.data(), [&](const OctreeNode& node, int child) {
    constexpr double far = std::numeric_limits<double>::infinity();
    Vec3d most{-far, -far, -far}, most_back = most;
    for (const Triangle& face : elements.faces().subspan(node.first_triangle[child], node.size(child))) {
      for (const std::uint32_t vertex : face) {
        const Vec3d from = start[vertex], to = end[vertex];
        if (!is_finite(from) || !is_finite(to)) continue;
        most = larger(most, to - from);
        most_back = larger(most_back, from - to);
      }
    }
    Aabb box;
    for (int axis = 0; axis < 3 && most.x > -far; ++axis) {
      // The differences are rounded, too.
      box.min[axis] = round_down(-most_back[axis] - 0x1p-50 * std::fabs(most_back[axis]));
      box.max[axis] = round_up(most[axis] + 0x1p-50 * std::fabs(most[axis]));
    }
    return box;
  });
}

}  // namespace

void check_limits(const StepLimits& limits, const char* call) {
  if (!(limits.seconds >= 0))
    fail(std::string(call) + ": seconds is " + std::to_string(limits.seconds) + "; it must be at least 0");
}

void StepSearch::prepare(const Question& question) {
  world_.refit(question.shapes());
  pairs_.find(question,
              question.safe_step ? std::span<const VertexWays>(ways_) : std::span<const VertexWays>());
  world_.rebuild_degraded(pairs_.jobs(), pairs_.boxes());
  list_moving_objects(world_, MovingShape::Part::way, objects_);
}

/// What the pass reads; the time of the call begins here.
PassInput StepSearch::input(const StepLimits& limits) const {
  PassInput input{
      .jobs = pairs_.jobs(), .versions = {}, .stop = stop_of(limits), .parallel = world_.parallel};
  constexpr double longest = 1e9;  // some decades
  if (limits.seconds < longest) {
    const std::chrono::duration<double> time(limits.seconds);
    input.stop.end_at(StopSignal::Clock::now() +
                      std::chrono::duration_cast<StopSignal::Clock::duration>(time));
  }
  return input;
}

std::optional<ContinuousContact> StepSearch::earliest_impact(const ImpactSearchOptions& options,
                                                             const StepLimits& limits) {
  prepare({.contacts = ContactKinds::continuous, .impact = options});
  return pass_.find_earliest(input(limits), objects_, options);
}

void StepSearch::prepare_step(const ImpactSearchOptions& options, const std::optional<StepOptions>& step) {
  ways_.resize(world_.slot_count());
  ways_of_nodes_.resize(world_.slot_count());
  for (std::uint32_t slot = 0; slot < world_.slot_count(); ++slot) {
    if (world_.at(slot) != nullptr) ways_[slot] = world_[slot].ways(world_.parallel);
  }
  prepare({.contacts = ContactKinds::continuous, .impact = options, .safe_step = step});
  for (std::uint32_t slot = 0; slot < world_.slot_count(); ++slot) {
    const WorldObject* const object = world_.at(slot);
    if (object == nullptr) continue;
    MovingObject& listed = objects_[slot];
    listed.ways = &ways_[slot];
    if (!object->placement().has_motion()) continue;
    set_way_boxes(object->octree(), object->moving().elements(), *listed.start, *listed.end,
                  ways_of_nodes_[slot]);
    listed.view.ways = ways_of_nodes_[slot].data();
  }
}

SafeStep StepSearch::safe_step(const ImpactSearchOptions& options, const std::optional<StepOptions>& step,
                               const StepLimits& limits, const FirstOfAll& first_of_all) {
  prepare_step(options, step);
  return pass_.find_safe_step(input(limits), objects_, options, step, first_of_all);
}

std::span<const ObjectStep> StepSearch::safe_steps(const ImpactSearchOptions& options,
                                                   const StepOptions& step, const StepLimits& limits) {
  prepare_step(options, step);
  steps_ = pass_.find_safe_steps(input(limits), objects_, options, step);
  return steps_;
}

}  // namespace supple
