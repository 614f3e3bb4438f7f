#include <algorithm>
#include <array>
#include <atomic>
#include <limits>
#include <utility>
#include <vector>

#include "core/error.hpp"
#include "core/float_rounding.hpp"
#include "core/sort_once.hpp"
#include "core/timer.hpp"
#include "geometry/aabb.hpp"
#include "octree/way_boxes.hpp"
#include "scene/scene_implementation.hpp"
#include "supple/option_descriptions.hpp"

namespace supple {

namespace {

// When each volume grows by half the separation, or by its margin, the volumes of two objects overlap if the
// objects come within the separation or the sum of their margins. The growth is rounded up by more than its
// sums can lose.

double growth(double half_separation) {
  return half_separation > 0 ? half_separation * (1 + 0x1p-19) + std::numeric_limits<float>::min() : 0;
}

Aabb grown(const Aabb& box, double by) {
  if (by == 0 || box.empty()) return box;
  Aabb result;
  for (int axis = 0; axis < 3; ++axis) {
    result.min[axis] = round_down(box.min[axis] - by);
    result.max[axis] = round_up(box.max[axis] + by);
  }
  return result;
}

BoundingSphere grown(const BoundingSphere& sphere, double by) {
  if (by == 0 || sphere.empty()) return sphere;
  return {sphere.center, round_up(sphere.radius + by)};
}

}  // namespace

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

/// Calls `function(object, parallel)` for all objects. Small objects share the workers; an object that is a
/// large part of the work gets all of them, one such object after the other. `work(object)` returns a number
/// of triangles.
template <class Work, class Function>
void Scene::Implementation::for_each_object(std::span<const std::uint32_t> indices, const Work& work,
                                            const Function& function) {
  constexpr std::size_t least_large = 16384;  // triangles
  constexpr std::size_t shares_of_worker = 4;
  std::size_t total = 0;
  for (const std::uint32_t index : indices) total += work(*slots_[index].object);
  const std::size_t large = std::max(least_large, total / (shares_of_worker * parallel.worker_count()));
  small_.clear();
  for (const std::uint32_t index : indices) {
    SceneObject& object = *slots_[index].object;
    if (work(object) >= large) {
      function(object, parallel);
    } else {
      small_.push_back(index);
    }
  }
  parallel.for_ranges(small_.size(), 1, [&](std::size_t begin, std::size_t end, std::uint32_t) {
    for (std::size_t i = begin; i < end; ++i) function(*slots_[small_[i]].object, serial);
  });
}

/// The part of an object in the distance at which elements of two objects are of interest.
double Scene::Implementation::half_separation_of(const SceneObject& object, std::uint32_t index,
                                                 const Question& question) const {
  const double separation = question.impact.impact.min_separation / 2 + object.options.min_separation;
  if (!question.safe_step) return separation;
  const VertexWays& ways = ways_[index];
  return separation + kept_share(*question.safe_step) * ways.longest +
         safe_step_rounding * ways.largest_coordinate;
}

void Scene::Implementation::refit_objects(const SearchedShapes& shapes) {
  versions_.resize(slots_.size(), 0);
  changed_.resize(slots_.size(), 0);
  stale_.clear();
  for (std::uint32_t index = 0; index < slots_.size(); ++index) {
    const SceneObject* const object = slots_[index].object.get();
    if (object == nullptr) continue;
    if (object->has_moved()) {
      versions_[index] = ++last_version_;
      changed_[index] = 1;
    }
    if (!object->is_stale(shapes)) continue;
    stale_.push_back(index);
    if (object->needs_refit(shapes)) ++result.stats.objects_refitted;
  }
  const auto triangles_to_refit = [&](const SceneObject& object) {
    return object.needs_refit(shapes) ? object.octree().triangles().size() : std::size_t{0};
  };
  for_each_object(stale_, triangles_to_refit,
                  [&](SceneObject& object, const Parallel& workers) { object.update(shapes, workers); });
  for (const std::uint32_t index : stale_)
    result.stats.triangles_refitted += slots_[index].object->refitted_triangles();
}

/// The boxes and spheres that the broad phase reads, and the slots where they may have changed since its last
/// search.
void Scene::Implementation::list_volumes(const Question& question) {
  const SearchedShapes shapes = question.shapes();
  const bool is_another_search = searched_ != shapes;
  const auto growth_of = [&](const SceneObject& object, std::uint32_t index) {
    return std::max(question.is_continuous() ? growth(half_separation_of(object, index, question)) : 0,
                    question.has_proximity() ? growth(object.options.margin) : 0);
  };
  growths_.resize(slots_.size(), 0);
  boxes_.resize(slots_.size());
  spheres_.resize(slots_.size());
  changed_slots_.clear();
  for (std::uint32_t index = 0; index < slots_.size(); ++index) {
    const SceneObject* const object = slots_[index].object.get();
    const double growth_of_volumes = object != nullptr ? growth_of(*object, index) : 0;
    if (changed_[index] == 0 && !is_another_search && growths_[index] == growth_of_volumes) continue;
    growths_[index] = growth_of_volumes;
    const Aabb box = object != nullptr ? grown(object->box(), growth_of_volumes) : Aabb{};
    const BoundingSphere sphere =
        object != nullptr ? grown(object->sphere(), growth_of_volumes) : BoundingSphere{};
    if (changed_[index] == 0 && box == boxes_[index] && sphere == spheres_[index]) continue;
    changed_[index] = 1;
    changed_slots_.push_back(index);
    boxes_[index] = box;
    spheres_[index] = sphere;
  }
  searched_ = shapes;
}

void Scene::Implementation::find_object_pairs(Jobs& found) {
  ObjectVolumes volumes;
  volumes.dirty = changed_slots_;
  if (options.bounding_volume == BoundingVolume::sphere) {
    volumes.spheres = spheres_;
  } else {
    volumes.boxes = boxes_;
  }
  const std::span<const IndexPair> overlapping = pair_finder.find_pairs(volumes, parallel);
  std::fill(changed_.begin(), changed_.end(), std::uint8_t{0});
  found.pairs.clear();
  for (const IndexPair& pair : overlapping) {
    if (!volumes_apart(pair) && may_pair(pair)) found.pairs.push_back({id_of(pair.a), id_of(pair.b)});
  }
  found.jobs.clear();
  auto pair = found.pairs.begin();
  for (std::uint32_t index = 0; index < slots_.size(); ++index) {
    const SceneObject* const object = slots_[index].object.get();
    if (object == nullptr) continue;
    if (object->options.self_collision) found.jobs.push_back({index, index});
    for (; pair != found.pairs.end() && pair->a.index == index; ++pair)
      found.jobs.push_back({index, pair->b.index});
  }
}

/// Whether the oriented boxes or k-DOPs of two objects are apart whose boxes overlap. They do not enclose the
/// path of an object.
bool Scene::Implementation::volumes_apart(const IndexPair& pair) const {
  if (searched_.moving || searched_.near || !is_tested_after_boxes(options.bounding_volume)) return false;
  return object_volumes_apart(
      pair_of(slots_[pair.a].object->resting_view(), slots_[pair.b].object->resting_view()));
}

bool Scene::Implementation::may_pair_by_groups(const IndexPair& pair) const {
  const ObjectOptions& a = slots_[pair.a].object->options;
  const ObjectOptions& b = slots_[pair.b].object->options;
  if (a.is_static && b.is_static) return false;
  return (a.group & b.mask) != 0 && (b.group & a.mask) != 0;
}

bool Scene::Implementation::may_pair(const IndexPair& pair) const {
  return may_pair_by_groups(pair) && (!filter || filter(id_of(pair.a), id_of(pair.b)));
}

/// Counts the queries of each octree. Jobs of objects that did not move search nothing. A query of another
/// object counts by the share of the octree that it meets: the surface of the box that both objects share.
void Scene::Implementation::count_queries(const Jobs& jobs) {
  queries_.assign(slots_.size(), 0);
  for (const ContactJob& job : jobs.jobs) {
    if (std::max(versions_[job.a], versions_[job.b]) <= counted_version_) continue;
    if (job.a == job.b) {
      queries_[job.a] += RebuildPolicy::queries_of_self;
    } else {
      const double shared_surface = half_surface(shared_box(boxes_[job.a], boxes_[job.b]));
      for (const std::uint32_t index : {job.a, job.b}) {
        if (shared_surface > 0) queries_[index] += shared_surface / half_surface(boxes_[index]);
      }
    }
  }
}

/// Rebuilds degraded octrees where that pays, some in each step: the others wait.
void Scene::Implementation::rebuild_degraded(const Jobs& jobs) {
  rebuild_those_that_pay(jobs);
  counted_version_ = last_version_;
}

void Scene::Implementation::rebuild_those_that_pay(const Jobs& jobs) {
  constexpr std::uint64_t most_triangles = 65536;  // a step, but at least one object
  degraded_.clear();
  for (std::uint32_t index = 0; index < slots_.size(); ++index) {
    const SceneObject* const object = slots_[index].object.get();
    if (object != nullptr && object->rebuild_policy().is_degraded()) degraded_.push_back(index);
  }
  if (degraded_.empty()) return;
  count_queries(jobs);
  std::size_t total = 0;
  std::erase_if(degraded_, [&](std::uint32_t index) {
    SceneObject& object = *slots_[index].object;
    if (!(queries_[index] > 0) || !object.rebuild_policy().count_queries(queries_[index])) return true;
    const std::size_t triangles = object.octree().triangles().size();
    if (total > 0 && total + triangles > most_triangles) return true;
    total += triangles;
    return false;
  });
  std::atomic<std::uint64_t> octrees = 0, triangles = 0;
  const auto triangle_count = [](const SceneObject& object) { return object.octree().triangles().size(); };
  for_each_object(degraded_, triangle_count, [&](SceneObject& object, const Parallel& workers) {
    if (!object.rebuild(workers)) return;
    ++octrees;
    triangles += triangle_count(object);
  });
  result.stats.octrees_rebuilt = octrees;
  result.stats.triangles_rebuilt = triangles;
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
