#include "core/error.hpp"
#include "core/kept_lists.hpp"
#include "core/stop_signal.hpp"
#include "core/timer.hpp"
#include "scene/scene_implementation.hpp"
#include "supple/option_descriptions.hpp"

namespace supple {
Scene::Implementation::Implementation(const SceneOptions& options) : world(options) {}

ImpactSearchOptions Scene::Implementation::impact_options() const {
  const SceneOptions& options = world.options;
  return {options.impact, options.element_kinds, options.continuous_listing};
}

Question Scene::Implementation::question_of(const DetectRequest& request) const {
  const Question question = supple::question_of(request, world.options);
  if (question.has_penetration()) check_vertex_groups();
  return question;
}

/// Penetrations and curves need all intersections.
void Scene::Implementation::check_vertex_groups() const {
  for (std::uint32_t slot = 0; slot < world.slot_count(); ++slot) {
    const WorldObject* const object = world.at(slot);
    if (object == nullptr || object->vertex_groups().empty()) continue;
    fail("detect: penetration needs all intersections, but " + object->options.name +
         " has vertex groups; remove them with set_vertex_groups");
  }
}

const DetectResult& Scene::Implementation::detect(const DetectRequest& request) {
  const Question question = question_of(request);
  const StopSignal stop = stop_of(request);
  events_.start(question);
  result = {};
  result.step = step_;
  result.stopped = true;  // until the end
  detected_at_ = 0;
  Timer total;
  if (!detection.run(question, request.max_contacts, stop, result.stats)) return result;
  Timer stage;
  DetectResult found = result;
  found.stopped = false;
  detection.list(found);
  events_.prepare(world, question, found);
  // From here on, nothing may run out of memory.
  events_.publish(found);
  found.stats.sort_and_events_seconds += stage.lap() - found.stats.manifold_seconds;
  found.stats.total_seconds = total.lap();
  result = found;
  ++step_;
  detected_at_ = world.changes();
  return result;
}

const DetectResult& Scene::Implementation::search(const DetectRequest& request, const PairFilter& only) {
  Question question = question_of(request);
  question.only = only;
  if (request.manifolds.value_or(false))
    fail("search: manifolds have ids that last from step to step, so only detect makes them");
  if (!search_) search_.emplace(world);
  found_by_search_ = {};
  found_by_search_.stopped = true;  // until the end
  Timer total;
  DetectResult found;
  if (!search_->run(question, request.max_contacts, stop_of(request), found_by_search_.stats))
    return found_by_search_;
  found.stats = found_by_search_.stats;
  search_->list(found);
  found.stats.total_seconds = total.lap();
  found_by_search_ = found;
  return found_by_search_;
}

std::shared_ptr<const void> Scene::Implementation::keep_result() {
  const auto kept = std::make_shared<KeptLists>();
  const auto keep_all = [&] {
    detection.visit_lists([&](auto& list) { kept->keep(list); });
    events_.keep(*kept);
  };
  keep_all();
  kept->swap();
  keep_all();
  result = {};
  detected_at_ = 0;
  return kept;
}

void Scene::Implementation::remove(ObjectId id) {
  world.object(id, "remove");
  events_.prepare_release();
  world.remove(id);
  queries.forget(id);
  events_.release(id);
}

}  // namespace supple
