#include "answers/impact/step_search.hpp"

#include "octree/volumes/way_boxes.hpp"

namespace supple {

void StepSearch::prepare(const Question& question) {
  world_.refit(question.shapes());
  pairs_.find(question,
              question.safe_step ? std::span<const VertexWays>(ways_) : std::span<const VertexWays>());
  world_.rebuild_degraded(pairs_.jobs(), pairs_.boxes());
  list_moving_objects(world_, MovingShape::Part::way, objects_);
}

std::optional<ContinuousContact> StepSearch::earliest_impact(const ImpactSearchOptions& options) {
  prepare({.contacts = ContactKinds::continuous, .impact = options});
  return pass_.find_earliest(pairs_.jobs(), objects_, options, world_.parallel);
}

void StepSearch::prepare_safe_step(const ImpactSearchOptions& options, const StepOptions& step) {
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

SafeStep StepSearch::safe_step(const ImpactSearchOptions& options, const StepOptions& step,
                               const FirstOfAll& first_of_all) {
  prepare_safe_step(options, step);
  return pass_.find_safe_step(pairs_.jobs(), objects_, options, step, first_of_all, world_.parallel);
}

std::span<const ObjectStep> StepSearch::safe_steps(const ImpactSearchOptions& options,
                                                   const StepOptions& step) {
  prepare_safe_step(options, step);
  steps_ = pass_.find_safe_steps(pairs_.jobs(), objects_, options, step, world_.parallel);
  std::erase_if(steps_, [&](const ObjectStep& found) { return !world_.contains(found.object); });
  return steps_;
}

}  // namespace supple
