// What every search does first: refit the objects that have moved, find the pairs of objects whose volumes
// overlap, and rebuild degraded octrees.

#include <algorithm>
#include <atomic>
#include <limits>

#include "core/float_rounding.hpp"
#include "geometry/aabb.hpp"
#include "scene/scene_implementation.hpp"

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

}  // namespace supple
