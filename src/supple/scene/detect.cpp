#include <algorithm>
#include <limits>
#include <vector>

#include "core/error.hpp"
#include "core/float_rounding.hpp"
#include "core/timer.hpp"
#include "geometry/aabb.hpp"
#include "scene/scene_implementation.hpp"

namespace supple {

namespace {

// Volumes of two objects that come within the separation of each other overlap when each grows by half of it.
// The growth and its sums are rounded up by more than they can lose.

double growth(double separation) {
  return separation > 0 ? separation * (0.5 + 0x1p-20) + std::numeric_limits<float>::min() : 0;
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

const DetectResult& Scene::Implementation::detect() {
  result.stats = {};
  Timer total, stage;
  refit_objects();
  result.stats.refit_seconds = stage.lap();
  find_object_pairs();
  result.stats.broad_phase_seconds = stage.lap();
  plan_jobs();
  stage.lap();
  rebuild_degraded();
  result.stats.rebuild_seconds = stage.lap();
  if (is_continuous()) {
    find_impacts();
  } else {
    find_contacts();
  }
  stage.lap();
  report_non_finite();
  publish();
  result.stats.sort_and_events_seconds += stage.lap();
  result.stats.total_seconds = total.lap();
  return result;
}

/// Calls `function(object, parallel)`, side by side. An object that is a large part of the work would keep
/// its worker while the others wait: such objects take all workers, one after the other. `work` says how many
/// triangles an object takes.
template <class Work, class Function>
void Scene::Implementation::for_each_object(std::span<const std::uint32_t> indices, const Work& work,
                                            const Function& function) {
  constexpr std::size_t least_large = 16384;  // triangles; fewer are not worth splitting
  constexpr std::size_t shares_of_worker = 8;
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

void Scene::Implementation::refit_objects() {
  const double growth_of_volumes = is_continuous() ? growth(options.impact.min_separation) : 0;
  boxes_.resize(slots_.size());
  spheres_.resize(slots_.size());
  versions_.resize(slots_.size(), 0);
  changed_.resize(slots_.size(), 0);
  stale_.clear();
  last_version_before_ = last_version_;
  for (std::uint32_t index = 0; index < slots_.size(); ++index) {
    const SceneObject* const object = slots_[index].object.get();
    if (object == nullptr || !object->is_stale()) continue;
    changed_[index] = 1;
    versions_[index] = ++last_version_;
    stale_.push_back(index);
    if (!object->needs_refit()) continue;
    ++result.stats.objects_refitted;
    result.stats.triangles_refitted += object->octree().triangles().size();
  }
  const auto triangles_to_refit = [](const SceneObject& object) {
    return object.needs_refit() ? object.octree().triangles().size() : std::size_t{0};
  };
  for_each_object(stale_, triangles_to_refit,
                  [](SceneObject& object, const Parallel& workers) { object.update(workers); });
  changed_slots_.clear();
  for (std::uint32_t index = 0; index < slots_.size(); ++index) {
    if (changed_[index] == 0) continue;
    changed_slots_.push_back(index);
    const SceneObject* const object = slots_[index].object.get();
    boxes_[index] = object != nullptr ? grown(object->box(), growth_of_volumes) : Aabb{};
    spheres_[index] = object != nullptr ? grown(object->sphere(), growth_of_volumes) : BoundingSphere{};
  }
}

void Scene::Implementation::find_object_pairs() {
  ObjectVolumes volumes;
  volumes.dirty = changed_slots_;
  if (options.bounding_volume == BoundingVolume::sphere) {
    volumes.spheres = spheres_;
  } else {
    volumes.boxes = boxes_;
  }
  const std::span<const IndexPair> overlapping = pair_finder.find_pairs(volumes, parallel);
  std::fill(changed_.begin(), changed_.end(), std::uint8_t{0});
  result.stats.broad_phase_method = pair_finder.stats().method;
  result.stats.object_pairs_tested = pair_finder.stats().object_pairs_tested;
  object_pairs_.clear();
  for (const IndexPair& pair : overlapping) {
    if (may_pair(pair)) object_pairs_.push_back({id_of(pair.a), id_of(pair.b)});
  }
  result.stats.object_pairs = object_pairs_.size();
}

bool Scene::Implementation::may_pair(const IndexPair& pair) const {
  const ObjectOptions& a = slots_[pair.a].object->options;
  const ObjectOptions& b = slots_[pair.b].object->options;
  if (a.is_static && b.is_static) return false;
  if ((a.group & b.mask) == 0 || (b.group & a.mask) == 0) return false;
  return !filter || filter(id_of(pair.a), id_of(pair.b));
}

/// Objects against themselves and each other, in canonical order.
void Scene::Implementation::plan_jobs() {
  jobs_.clear();
  auto pair = object_pairs_.begin();
  for (std::uint32_t index = 0; index < slots_.size(); ++index) {
    const SceneObject* const object = slots_[index].object.get();
    if (object == nullptr) continue;
    if (object->options.self_collision) jobs_.push_back({index, index});
    for (; pair != object_pairs_.end() && pair->a.index == index; ++pair)
      jobs_.push_back({index, pair->b.index});
  }
}

/// Of each octree, but those whose outcome is known as nothing moved. Another object asks for as much of an
/// octree as the surface of what their boxes share.
void Scene::Implementation::count_queries() {
  queries_.assign(slots_.size(), 0);
  for (const ContactJob& job : jobs_) {
    if (std::max(versions_[job.a], versions_[job.b]) <= last_version_before_) continue;
    if (job.a == job.b) {
      queries_[job.a] += SceneObject::queries_of_self;
    } else {
      const double asked_for = half_surface(shared_box(boxes_[job.a], boxes_[job.b]));
      for (const std::uint32_t index : {job.a, job.b}) {
        if (asked_for > 0) queries_[index] += asked_for / half_surface(boxes_[index]);
      }
    }
  }
}

/// Those for which it pays, some in a step: the others wait.
void Scene::Implementation::rebuild_degraded() {
  constexpr std::uint64_t most_triangles = 65536;  // a step, but at least one object
  degraded_.clear();
  for (std::uint32_t index = 0; index < slots_.size(); ++index) {
    const SceneObject* const object = slots_[index].object.get();
    if (object != nullptr && object->is_degraded()) degraded_.push_back(index);
  }
  if (degraded_.empty()) return;
  count_queries();
  std::size_t chosen = 0;
  std::uint64_t triangles = 0;
  for (const std::uint32_t index : degraded_) {
    SceneObject& object = *slots_[index].object;
    if (!(queries_[index] > 0) || !object.count_queries(queries_[index])) continue;
    if (triangles > 0 && triangles + object.degraded_triangles() > most_triangles) continue;
    triangles += object.degraded_triangles();
    degraded_[chosen++] = index;
    result.stats.subtrees_rebuilt -= object.subtrees_rebuilt();
    result.stats.triangles_rebuilt -= object.triangles_rebuilt();
  }
  degraded_.resize(chosen);
  const auto all_triangles = [](const SceneObject& object) { return object.octree().triangles().size(); };
  for_each_object(degraded_, all_triangles,
                  [](SceneObject& object, const Parallel& workers) { object.rebuild(workers); });
  for (const std::uint32_t index : degraded_) {
    result.stats.subtrees_rebuilt += slots_[index].object->subtrees_rebuilt();
    result.stats.triangles_rebuilt += slots_[index].object->triangles_rebuilt();
  }
}

void Scene::Implementation::find_contacts() {
  contact_objects_.clear();
  for (std::uint32_t index = 0; index < slots_.size(); ++index) {
    const SceneObject* const object = slots_[index].object.get();
    contact_objects_.emplace_back();
    if (object == nullptr) continue;
    contact_objects_.back() = {id_of(index), object->view(), object->octree().triangle_ids(),
                               object->octree().vertex_count(), versions_[index]};
  }
  contact_pass_.run(jobs_, contact_objects_, options, parallel, result.stats);
}

void Scene::Implementation::list_moving_objects() {
  moving_objects_.clear();
  for (std::uint32_t index = 0; index < slots_.size(); ++index) {
    const SceneObject* const object = slots_[index].object.get();
    moving_objects_.emplace_back();
    if (object == nullptr) continue;
    moving_objects_.back() = {id_of(index),   object->moving_view(),           &object->start(),
                              &object->end(), object->octree().triangle_ids(), object->octree().vertex_ids()};
  }
}

void Scene::Implementation::find_impacts() {
  list_moving_objects();
  impact_pass_.run(jobs_, moving_objects_, options.impact, parallel, result.stats);
}

std::optional<ContinuousContact> Scene::Implementation::earliest_impact(const char* call) {
  if (!is_continuous()) {
    fail(std::string(call) +
         ": the scene does not look for continuous contacts; make it with SceneOptions::contacts continuous");
  }
  const StepStats stats = result.stats;
  refit_objects();
  find_object_pairs();
  plan_jobs();
  rebuild_degraded();
  list_moving_objects();
  result.stats = stats;
  result.object_pairs = {};  // they were of another call
  mark_changed();
  return impact_pass_.find_earliest(jobs_, moving_objects_, options.impact, parallel);
}

void Scene::Implementation::report_non_finite() {
  non_finite_.clear();
  for (std::uint32_t index = 0; index < slots_.size(); ++index) {
    const SceneObject* const object = slots_[index].object.get();
    if (object == nullptr) continue;
    for (const std::uint32_t vertex : object->non_finite_vertices()) {
      non_finite_.push_back(
          {id_of(index), vertex, object->non_finite_position(object->octree().octree_vertex(vertex))});
    }
  }
}

void Scene::Implementation::publish() {
  touching_pairs_.clear();
  result.groups = is_continuous() ? impact_pass_.groups() : contact_pass_.groups();
  for (const ContactGroup& group : result.groups) {
    if (group.a != group.b) touching_pairs_.push_back({group.a, group.b});
  }
  volume_pairs_.update(object_pairs_);
  contact_pairs_.update(touching_pairs_);
  result.step = step_++;
  result.object_pairs = object_pairs_;
  result.continuous_contacts = impact_pass_.contacts();
  result.contacts = contact_pass_.contacts();
  result.contact_points = contact_pass_.contact_points();
  result.colliding_vertex_groups = contact_pass_.colliding_vertex_groups();
  result.colliding_vertices = contact_pass_.colliding_vertices();
  result.non_finite_vertices = non_finite_;
  result.volume_events = volume_pairs_.events();
  result.contact_events = contact_pairs_.events();
  detected_ = true;
}

}  // namespace supple
