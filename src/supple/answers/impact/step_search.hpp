#pragma once

#include <optional>
#include <span>
#include <vector>

#include "answers/impact/impact_pass.hpp"
#include "answers/moving_objects.hpp"
#include "answers/object_pairs.hpp"
#include "octree/volumes/moving_boxes.hpp"
#include "world/world.hpp"

namespace supple {

/// Throws an error that names `call` when a limit is out of its range.
void check_limits(const StepLimits& limits, const char* call);

/// Searches of a world for the earliest impact and for safe steps. It keeps its memory between searches.
class StepSearch {
 public:
  /// Islands are those of boxes for all volumes.
  explicit StepSearch(World& world) : world_(world), pairs_(world, BoundingVolume::aabb) {}

  std::optional<ContinuousContact> earliest_impact(const ImpactSearchOptions& options,
                                                   const StepLimits& limits);
  /// The longest step without `step`.
  SafeStep safe_step(const ImpactSearchOptions& options, const std::optional<StepOptions>& step,
                     const StepLimits& limits, const FirstOfAll& first_of_all = {});
  /// Ascending by object. The span is valid until the next call.
  std::span<const ObjectStep> safe_steps(const ImpactSearchOptions& options, const StepOptions& step,
                                         const StepLimits& limits);
  /// What the last call tested.
  const StepStats& work() const { return pass_.work(); }

 private:
  void prepare(const Question& question);
  void prepare_step(const ImpactSearchOptions& options, const std::optional<StepOptions>& step);
  PassInput input(const StepLimits& limits) const;

  World& world_;
  ObjectPairs pairs_;
  ImpactPass pass_;
  // By slot.
  std::vector<MovingObject> objects_;
  std::vector<VertexWays> ways_;
  std::vector<std::vector<ChildBoxes>> ways_of_nodes_;
  std::vector<ObjectStep> steps_;
};

}  // namespace supple
