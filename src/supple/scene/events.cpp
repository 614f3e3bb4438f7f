#include "scene/events.hpp"

#include <algorithm>
#include <vector>

#include "core/sort_once.hpp"
#include "core/timer.hpp"

namespace supple {

void Events::start(const Question& question) {
  if (question.manifolds && !manifolds_) manifolds_ = manifold_methods("manifolds").manifold_maker();
}

void Events::prepare(World& world, const Question& question, DetectResult& found) {
  list_pairs(found);
  if (manifolds_) {
    Timer timer;
    const bool lists_all_pairs = question.impact.kinds == ElementKinds::all && !found.truncated;
    manifolds_->find(question.manifolds ? found : DetectResult{}, world, lists_all_pairs);
    found.stats.manifold_seconds = timer.lap();
  }
  for (std::size_t i = 0; i < pairs_.size(); ++i) events_[i].prepare(pairs_[i]);
  events_[of_volumes].prepare(found.object_pairs);
}

void Events::publish(DetectResult& found) {
  for (std::size_t i = 0; i < pairs_.size(); ++i) events_[i].update(pairs_[i]);
  events_[of_volumes].update(found.object_pairs);
  if (manifolds_) manifolds_->publish(found);
  for (const ContactKindInfo& kind : contact_kinds)
    found.*kind.events = events_[place_of_events(kind)].events();
  found.narrow_phase_events = events_[of_leaves].events();
  found.volume_events = events_[of_volumes].events();
}

void Events::keep(KeptLists& kept) {
  for (PairCache& pairs : events_) pairs.visit_lists([&](auto& list) { kept.keep(list); });
  if (manifolds_) manifolds_->keep(kept);
}

void Events::prepare_release() {
  for (PairCache& pairs : events_) pairs.prepare_release();
}

void Events::release(ObjectId id) {
  for (PairCache& pairs : events_) pairs.release(id);
}

/// Lists the pairs of different objects, each once, ascending.
void Events::list_pairs(const DetectResult& found) {
  for (std::vector<ObjectPair>& pairs : pairs_) pairs.clear();
  const auto add_groups = [](const auto& groups, std::vector<ObjectPair>& pairs) {
    const bool is_first = pairs.empty();
    for (const auto& group : groups) {
      if (group.a != group.b) pairs.push_back({group.a, group.b});
    }
    if (!is_first) sort_once(pairs);
  };
  for (const ContactKindInfo& kind : contact_kinds) {
    if (kind.groups != nullptr) add_groups(found.*kind.groups, pairs_[place_of_events(kind)]);
  }
  add_groups(found.colliding_vertex_groups, pairs_[of_leaves]);
  // Objects one of which has a vertex inside the other, or a part, whose vertices are inside.
  std::vector<ObjectPair>& deep = pairs_[place_of_events(info_of(ContactKinds::penetration))];
  for (const PenetrationGroup& group : found.penetration_groups) {
    if (group.penetration_count > 0) deep.push_back({std::min(group.a, group.b), std::max(group.a, group.b)});
  }
  sort_once(deep);
}

}  // namespace supple
