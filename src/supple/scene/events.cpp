#include "scene/events.hpp"

#include <algorithm>
#include <span>

#include "core/sort_once.hpp"
#include "core/timer.hpp"

namespace supple {

void Events::start(const Question& question) {
  if (question.manifolds && !manifolds_) manifolds_ = manifold_methods("manifolds").manifold_maker();
}

void Events::prepare(World& world, const Question& question, DetectResult& found) {
  list_deep_pairs(found);
  list_touching_pairs(found);
  list_pairs_of_groups(found);
  if (manifolds_) {
    Timer timer;
    const bool lists_all_pairs = question.impact.kinds == ElementKinds::all && !found.truncated;
    manifolds_->find(question.manifolds ? found : DetectResult{}, world, lists_all_pairs);
    found.stats.manifold_seconds = timer.lap();
  }
  const std::array<std::span<const ObjectPair>, 5> pairs{found.object_pairs, leaf_pairs_, touching_pairs_,
                                                         near_pairs_, deep_pairs_};
  for (std::size_t i = 0; i < all_.size(); ++i) all_[i]->prepare(pairs[i]);
}

void Events::publish(DetectResult& found) {
  const std::array<std::span<const ObjectPair>, 5> pairs{found.object_pairs, leaf_pairs_, touching_pairs_,
                                                         near_pairs_, deep_pairs_};
  for (std::size_t i = 0; i < all_.size(); ++i) all_[i]->update(pairs[i]);
  if (manifolds_) manifolds_->publish(found);
  found.volume_events = volume_.events();
  found.narrow_phase_events = narrow_phase_.events();
  found.contact_events = contact_.events();
  found.proximity_events = proximity_.events();
  found.penetration_events = penetration_.events();
}

void Events::keep(KeptLists& kept) {
  for (PairCache* const pairs : all_) pairs->visit_lists([&](auto& list) { kept.keep(list); });
  if (manifolds_) manifolds_->keep(kept);
}

void Events::prepare_release() {
  for (PairCache* const pairs : all_) pairs->prepare_release();
}

void Events::release(ObjectId id) {
  for (PairCache* const pairs : all_) pairs->release(id);
}

/// Pairs of objects one of which has a vertex or a part inside the other, each once, ascending.
void Events::list_deep_pairs(const DetectResult& found) {
  deep_pairs_.clear();
  const auto add = [&](ObjectId a, ObjectId b) { deep_pairs_.push_back({std::min(a, b), std::max(a, b)}); };
  for (const PenetrationGroup& group : found.penetration_groups) {
    if (group.penetration_count > 0) add(group.a, group.b);
  }
  for (const ContainedPart& part : found.contained_parts) add(part.inner, part.outer);
  sort_once(deep_pairs_);
}

/// Pairs of objects that intersect or touch within the step, each once, ascending.
void Events::list_touching_pairs(const DetectResult& found) {
  touching_pairs_.clear();
  for (const auto groups : {found.groups, found.continuous_groups}) {
    for (const ContactGroup& group : groups) {
      if (group.a != group.b) touching_pairs_.push_back({group.a, group.b});
    }
  }
  if (found.groups.empty() || found.continuous_groups.empty()) return;
  sort_once(touching_pairs_);
}

/// Pairs of objects within their margins, and pairs with colliding vertices.
void Events::list_pairs_of_groups(const DetectResult& found) {
  near_pairs_.clear();
  for (const ContactGroup& group : found.proximity_groups) {
    if (group.a != group.b) near_pairs_.push_back({group.a, group.b});
  }
  leaf_pairs_.clear();
  for (const CollidingVertices& group : found.colliding_vertex_groups) {
    if (group.a != group.b) leaf_pairs_.push_back({group.a, group.b});
  }
}

}  // namespace supple
