#include <algorithm>
#include <string>

#include "core/error.hpp"
#include "scene/scene_implementation.hpp"

namespace supple {

void Scene::Implementation::list_queried_objects(const QueryFilter& seen, const char* call) {
  if (seen.object) object(*seen.object, call);
  // Keeps the broad phase up to date, as `earliest_impact` does.
  const StepStats stats = result.stats;
  refit_objects({});
  find_object_pairs(impact_jobs_);
  result.stats = stats;
  queried_objects_.clear();
  for (std::uint32_t index = 0; index < slots_.size(); ++index) {
    const SceneObject* const found = slots_[index].object.get();
    if (found == nullptr || (seen.object && seen.object->index != index)) continue;
    if ((found->options.group & seen.mask) == 0) continue;
    queried_objects_.push_back(queried_object(index));
  }
}

QueriedObject Scene::Implementation::queried_object(std::uint32_t index) const {
  const SceneObject& found = *slots_[index].object;
  return {id_of(index),
          found.resting_view(),
          &found.placement().end(),
          found.octree().triangles(),
          found.octree().triangle_ids(),
          found.box()};
}

template <class Answer>
void Scene::Implementation::answer_queries(const QueryFilter& seen, std::size_t count, const char* call,
                                           const Answer& answer) {
  constexpr std::size_t grain = 64;
  list_queried_objects(seen, call);
  queries_of_workers_.resize(parallel.worker_count());
  parallel.for_ranges(count, grain, [&](std::size_t begin, std::size_t end, std::uint32_t worker) {
    ObjectQueries& queries = queries_of_workers_[worker];
    queries.start();
    for (std::size_t i = begin; i < end; ++i) answer(queries, i);
  });
}

namespace {

void check_counts(std::size_t queries, std::size_t results, const char* call) {
  if (queries == results) return;
  fail(std::string(call) + ": " + std::to_string(results) + " results for " + std::to_string(queries) +
       " queries; give one for each");
}

}  // namespace

void Scene::Implementation::closest(std::span<const Vec3d> points,
                                    std::span<std::optional<ClosestPoint>> results,
                                    const ClosestOptions& query) {
  check_counts(points.size(), results.size(), "closest");
  if (!(query.max_distance >= 0))
    fail("closest: max_distance is " + std::to_string(query.max_distance) + "; it must be 0 or more");
  answer_queries(query.filter, points.size(), "closest", [&](ObjectQueries& queries, std::size_t i) {
    results[i] = queries.closest(queried_objects_, points[i], query.max_distance);
  });
}

void Scene::Implementation::cast(std::span<const Ray> rays, std::span<std::optional<RayHit>> results,
                                 const CastOptions& query) {
  check_counts(rays.size(), results.size(), "cast");
  answer_queries(query.filter, rays.size(), "cast", [&](ObjectQueries& queries, std::size_t i) {
    results[i] = queries.cast(queried_objects_, rays[i], query.count_hits);
  });
}

void Scene::Implementation::inside(std::span<const Vec3d> points, std::span<Containment> results,
                                   const QueryFilter& seen) {
  check_counts(points.size(), results.size(), "inside");
  if (seen.object) object(*seen.object, "inside");
  for (const Slot& slot : slots_) {
    if (slot.object == nullptr || (slot.object->options.group & seen.mask) == 0) continue;
    if (seen.object && slots_[seen.object->index].object != slot.object) continue;
    const auto edge = slot.object->open_edge();
    if (!edge) continue;
    fail("inside: the surface of " + slot.object->options.name + " is open: the edge of vertices " +
         std::to_string((*edge)[0]) + " and " + std::to_string((*edge)[1]) +
         " has an odd number of triangles; close the holes, or leave this object out");
  }
  answer_queries(seen, points.size(), "inside", [&](ObjectQueries& queries, std::size_t i) {
    results[i] = queries.inside(queried_objects_, points[i]);
  });
}

}  // namespace supple
