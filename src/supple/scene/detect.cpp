#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "core/error.hpp"
#include "core/sort_once.hpp"
#include "core/timer.hpp"
#include "octree/way_boxes.hpp"
#include "scene/scene_implementation.hpp"
#include "supple/option_descriptions.hpp"

namespace supple {

SearchedShapes Question::shapes() const {
  return {searches_at_rest(), is_continuous(), has_proximity(),
          // Colliding vertices and separations need all overlapping leaves, so nothing may be culled.
          searches_at_rest() && !colliding_vertices, is_continuous() && impact.impact.min_separation == 0};
}

/// Penetrations and curves need all intersections.
void Scene::Implementation::check_penetration(const DetectRequest& request) const {
  if (request.max_contacts != DetectRequest{}.max_contacts)
    fail("detect: penetration needs all intersections; request it without max_contacts");
  for (const Slot& slot : slots_) {
    if (slot.object == nullptr || slot.object->vertex_groups().empty()) continue;
    fail("detect: penetration needs all intersections, but " + slot.object->options.name +
         " has vertex groups; remove them with set_vertex_groups");
  }
}

void Scene::Implementation::check_manifolds() const {
  if (question_.has_penetration() || question_.has_proximity()) return;
  fail("detect: manifolds are made from penetration or proximity; request one of these contacts");
}

const DetectResult& Scene::Implementation::detect(const DetectRequest& request) {
  if (request.impact) check(*request.impact, "DetectRequest::impact");
  question_ = {
      with_included(request.contacts.value_or(options.contacts)),
      {request.impact.value_or(options.impact), request.element_kinds.value_or(options.element_kinds),
       request.continuous_listing.value_or(options.continuous_listing), options.max_exact_bits},
      request.proximity_listing.value_or(options.proximity_listing),
      options.comparison.colliding_vertices,
      request.manifolds.value_or(options.manifolds),
      request.depths.value_or(options.depths)};
  if (request.manifolds.value_or(false)) check_manifolds();
  if (question_.has_penetration()) check_penetration(request);
  const StopSignal stop = stop_of(request);
  result = {};
  result.step = step_;
  result.stopped = true;  // until `publish`
  mark_changed();
  Timer total, stage;
  refit_objects(question_.shapes());
  list_volumes(question_);
  result.stats.refit_seconds = stage.lap();
  find_object_pairs(jobs_);
  result.stats.broad_phase_method = pair_finder.stats().method;
  result.stats.object_pairs_tested = pair_finder.stats().object_pairs_tested;
  result.stats.object_pairs = jobs_.pairs.size();
  result.stats.broad_phase_seconds = stage.lap();
  if (stop.stop_requested()) return result;
  check_exact_bits(jobs_);
  rebuild_degraded(jobs_);
  result.stats.rebuild_seconds = stage.lap();
  if (question_.searches_at_rest() && !find_contacts(request, stop)) return result;
  if (question_.is_continuous() && !find_impacts(request, stop)) return result;
  if (question_.has_proximity() && !find_proximity(request, stop)) return result;
  stage.lap();
  if (question_.has_penetration()) {
    if (!find_penetrations(stop)) return result;
    result.stats.penetration_seconds = stage.lap();
  }
  report_non_finite();
  publish();
  result.stats.sort_and_events_seconds += stage.lap();
  result.stats.total_seconds = total.lap();
  return result;
}

bool Scene::Implementation::find_contacts(const DetectRequest& request, const StopSignal& stop) {
  contact_objects_.clear();
  for (std::uint32_t index = 0; index < slots_.size(); ++index) {
    SceneObject* const object = slots_[index].object.get();
    contact_objects_.emplace_back();
    if (object == nullptr) continue;
    contact_objects_.back() = {id_of(index),
                               object->resting_view(),
                               object->octree().triangle_ids(),
                               object->octree().vertex_count(),
                               object->vertex_groups(),
                               object->neighbours()};
  }
  const ContactSearch search{question_.has_intersections(),
                             options.contact_points || question_.has_penetration(),
                             options.comparison.colliding_vertices};
  return contact_pass_.run(jobs_.jobs, contact_objects_, versions_, search, request.max_contacts, stop,
                           parallel, result.stats);
}

void Scene::Implementation::list_element_objects(MovingShape::Part part) {
  element_objects_.clear();
  for (std::uint32_t index = 0; index < slots_.size(); ++index) {
    const SceneObject* const object = slots_[index].object.get();
    element_objects_.emplace_back();
    if (object == nullptr) continue;
    const bool is_way = part == MovingShape::Part::way;
    const MovingShape& shape = is_way ? object->moving() : object->near();
    MovingObject& listed = element_objects_.back();
    listed.id = id_of(index);
    listed.view = is_way ? object->moving_view() : object->near_view();
    listed.start = &shape.start();
    listed.end = &shape.end();
    listed.triangle_ids = object->octree().triangle_ids();
    listed.vertex_ids = shape.elements().vertex_ids();
    listed.face_count = object->face_count();
    listed.is_point = object->is_point();
    listed.groups = object->vertex_groups();
    listed.margin = object->options.margin;
    listed.min_separation = object->options.min_separation;
  }
}

bool Scene::Implementation::find_impacts(const DetectRequest& request, const StopSignal& stop) {
  list_element_objects(MovingShape::Part::way);
  return impact_pass_.run(jobs_.jobs, element_objects_, versions_, question_.impact, request.max_contacts,
                          stop, parallel, result.stats);
}

bool Scene::Implementation::find_proximity(const DetectRequest& request, const StopSignal& stop) {
  list_element_objects(MovingShape::Part::end);
  return proximity_pass_.run(jobs_.jobs, element_objects_, versions_,
                             {question_.proximity_listing, question_.impact.kinds}, request.max_contacts,
                             stop, parallel, result.stats);
}

bool Scene::Implementation::find_penetrations(const StopSignal& stop) {
  penetrated_objects_.assign(slots_.size(), {});
  for (const auto& [a, b] : jobs_.jobs) {
    for (const std::uint32_t index : {a, b}) {
      if (penetrated_objects_[index].surface.octree != nullptr) continue;
      SceneObject& object = *slots_[index].object;
      penetrated_objects_[index] = {queried_object(index),
                                    {&object.octree(), &object.vertex_triangles(), &object.placement().end(),
                                     object.resting_view().translation},
                                    object.options.solid};
    }
  }
  DetectResult found;
  found.groups = contact_pass_.groups();
  found.contacts = contact_pass_.contacts();
  found.contact_points = contact_pass_.contact_points();
  if (!penetration_pass_.run(jobs_.jobs, penetrated_objects_, versions_, found, question_.depths, stop,
                             parallel))
    return false;
  result.stats.penetrations = penetration_pass_.penetrations().size();
  result.stats.curves = penetration_pass_.curves().curves.size();
  return true;
}

/// Prepares a search on the way that does not change the result of `detect`.
void Scene::Implementation::search_on_the_way(const Question& question) {
  const StepStats stats = result.stats;
  refit_objects(question.shapes());
  list_volumes(question);
  find_object_pairs(impact_jobs_);
  rebuild_degraded(impact_jobs_);
  result.stats = stats;
  list_element_objects(MovingShape::Part::way);
}

std::optional<ContinuousContact> Scene::Implementation::earliest_impact() {
  search_on_the_way({ContactKinds::continuous, impact_options()});
  return impact_pass_.find_earliest(impact_jobs_.jobs, element_objects_, impact_options(), parallel);
}

/// Prepares a search for safe steps.
void Scene::Implementation::prepare_safe_step(const StepOptions& step) {
  ways_.resize(slots_.size());
  ways_of_nodes_.resize(slots_.size());
  for (std::uint32_t index = 0; index < slots_.size(); ++index) {
    if (slots_[index].object != nullptr) ways_[index] = slots_[index].object->ways(parallel);
  }
  Question question{ContactKinds::continuous, impact_options()};
  question.safe_step = step;
  search_on_the_way(question);
  for (std::uint32_t index = 0; index < slots_.size(); ++index) {
    if (slots_[index].object == nullptr) continue;
    MovingObject& listed = element_objects_[index];
    listed.ways = &ways_[index];
    const SceneObject& object = *slots_[index].object;
    if (!object.placement().has_motion()) continue;
    set_way_boxes(object.octree(), object.moving().elements(), *listed.start, *listed.end,
                  ways_of_nodes_[index]);
    listed.view.ways = ways_of_nodes_[index].data();
  }
}

SafeStep Scene::Implementation::collision_free_step(const StepOptions& step) {
  check(step, "collision_free_step");
  prepare_safe_step(step);
  return impact_pass_.find_safe_step(impact_jobs_.jobs, element_objects_, impact_options(), step, parallel);
}

std::span<const ObjectStep> Scene::Implementation::collision_free_steps(const StepOptions& step) {
  check(step, "collision_free_steps");
  prepare_safe_step(step);
  object_steps_ =
      impact_pass_.find_safe_steps(impact_jobs_.jobs, element_objects_, impact_options(), step, parallel);
  std::erase_if(object_steps_, [&](const ObjectStep& found) { return !contains(found.object); });
  return object_steps_;
}

void Scene::Implementation::report_non_finite() {
  non_finite_.clear();
  for (std::uint32_t index = 0; index < slots_.size(); ++index) {
    const SceneObject* const object = slots_[index].object.get();
    if (object == nullptr) continue;
    for (const std::uint32_t vertex : object->non_finite_vertices(question_.shapes()))
      non_finite_.push_back({id_of(index), vertex, object->non_finite_position(vertex)});
  }
}

void Scene::Implementation::find_manifolds(const DetectResult& found) {
  if (!question_.manifolds) return manifold_pass_.find_none();
  manifold_objects_.clear();
  for (const Slot& slot : slots_) {
    manifold_objects_.emplace_back();
    if (slot.object != nullptr)
      manifold_objects_.back() = {&slot.object->octree(), &slot.object->placement()};
  }
  for (const ContactGroup& group : found.proximity_groups) {
    for (const ObjectId id : {group.a, group.b})
      manifold_objects_[id.index].around = &slots_[id.index].object->vertex_triangles();
  }
  manifold_pass_.find(found, manifold_objects_);
}

void Scene::Implementation::publish() {
  DetectResult found = result;
  found.stopped = false;
  if (question_.searches_at_rest()) {
    found.truncated = contact_pass_.is_truncated();
    found.groups = contact_pass_.groups();
    found.contacts = contact_pass_.contacts();
    found.contact_points = contact_pass_.contact_points();
    found.colliding_vertex_groups = contact_pass_.colliding_vertex_groups();
    found.colliding_vertices = contact_pass_.colliding_vertices();
  }
  if (question_.is_continuous()) {
    found.truncated = found.truncated || impact_pass_.is_truncated();
    found.continuous_groups = impact_pass_.groups();
    found.continuous_contacts = impact_pass_.contacts();
  }
  if (question_.has_penetration()) {
    found.penetration_groups = penetration_pass_.groups();
    found.penetrations = penetration_pass_.penetrations();
    found.vertices_on_surface = penetration_pass_.vertices_on_surface();
    found.contained_parts = penetration_pass_.contained_parts();
    const CurveLists& curves = penetration_pass_.curves();
    found.curves = curves.curves;
    found.curve_contacts = curves.contacts;
    found.curve_points = curves.points;
    found.enclosed_vertices = curves.enclosed;
  }
  list_deep_pairs(found);
  near_pairs_.clear();
  if (question_.has_proximity()) {
    found.truncated = found.truncated || proximity_pass_.is_truncated();
    found.proximity_groups = proximity_pass_.groups();
    found.proximity_pairs = proximity_pass_.pairs();
    for (const ContactGroup& group : found.proximity_groups) {
      if (group.a != group.b) near_pairs_.push_back({group.a, group.b});
    }
  }
  list_touching_pairs(found);
  list_untested(found);
  leaf_pairs_.clear();
  for (const CollidingVertices& group : found.colliding_vertex_groups) {
    if (group.a != group.b) leaf_pairs_.push_back({group.a, group.b});
  }
  find_manifolds(found);
  using Update = std::pair<PairCache*, std::span<const ObjectPair>>;
  const std::array updates{Update{&volume_pairs_, jobs_.pairs}, Update{&narrow_phase_pairs_, leaf_pairs_},
                           Update{&contact_pairs_, touching_pairs_}, Update{&near_object_pairs_, near_pairs_},
                           Update{&penetrating_pairs_, deep_pairs_}};
  // From here on, nothing may run out of memory: each pair begins and ends exactly once.
  for (const auto& [cache, pairs] : updates) cache->prepare(pairs);
  for (const auto& [cache, pairs] : updates) cache->update(pairs);
  manifold_pass_.publish();
  ++step_;
  found.manifolds = manifold_pass_.manifolds();
  found.manifold_points = manifold_pass_.points();
  found.ended_manifolds = manifold_pass_.ended();
  found.object_pairs = jobs_.pairs;
  found.non_finite_vertices = non_finite_;
  found.volume_events = volume_pairs_.events();
  found.narrow_phase_events = narrow_phase_pairs_.events();
  found.contact_events = contact_pairs_.events();
  found.proximity_events = near_object_pairs_.events();
  found.penetration_events = penetrating_pairs_.events();
  result = found;
  detected_ = true;
}

/// Pairs of objects one of which has a vertex or a part inside the other, each once, ascending.
void Scene::Implementation::list_deep_pairs(const DetectResult& found) {
  deep_pairs_.clear();
  const auto add = [&](ObjectId a, ObjectId b) { deep_pairs_.push_back({std::min(a, b), std::max(a, b)}); };
  for (const PenetrationGroup& group : found.penetration_groups) {
    if (group.penetration_count > 0) add(group.a, group.b);
  }
  for (const ContainedPart& part : found.contained_parts) add(part.inner, part.outer);
  sort_once(deep_pairs_);
}

/// Pairs of objects that intersect or touch within the step, each once, ascending.
void Scene::Implementation::list_touching_pairs(const DetectResult& found) {
  touching_pairs_.clear();
  for (const auto groups : {found.groups, found.continuous_groups}) {
    for (const ContactGroup& group : groups) {
      if (group.a != group.b) touching_pairs_.push_back({group.a, group.b});
    }
  }
  if (found.groups.empty() || found.continuous_groups.empty()) return;
  sort_once(touching_pairs_);
}

}  // namespace supple
