// Refits the objects that have moved, and rebuilds degraded octrees.

#include <algorithm>
#include <atomic>

#include "geometry/aabb.hpp"
#include "world/world.hpp"

namespace supple {

/// Calls `function(object, parallel)` for all objects. Small objects share the workers; an object that is a
/// large part of the work gets all of them, one such object after the other. `size(object)` returns a number
/// of triangles.
template <class Size, class Function>
void World::for_each_object(std::span<const std::uint32_t> slots, const Size& size,
                            const Function& function) {
  constexpr std::size_t least_large = 16384;  // triangles
  constexpr std::size_t shares_of_worker = 4;
  std::size_t total = 0;
  for (const std::uint32_t slot : slots) total += size(*slots_[slot].object);
  const std::size_t large = std::max(least_large, total / (shares_of_worker * parallel.worker_count()));
  small_.clear();
  for (const std::uint32_t slot : slots) {
    WorldObject& object = *slots_[slot].object;
    if (size(object) >= large) {
      function(object, parallel);
    } else {
      small_.push_back(slot);
    }
  }
  parallel.for_ranges(small_.size(), 1, [&](std::size_t begin, std::size_t end, std::uint32_t) {
    for (std::size_t i = begin; i < end; ++i) function(*slots_[small_[i]].object, serial_);
  });
}

World::Work World::refit(const SearchedShapes& shapes) {
  versions_.resize(slots_.size(), 0);
  stale_.clear();
  Work work;
  for (std::uint32_t slot = 0; slot < slots_.size(); ++slot) {
    const WorldObject* const object = slots_[slot].object.get();
    if (object == nullptr) continue;
    if (object->has_moved()) versions_[slot] = ++last_version_;
    if (!object->is_stale(shapes)) continue;
    stale_.push_back(slot);
    if (object->needs_refit(shapes)) ++work.objects;
  }
  const auto triangles_to_refit = [&](const WorldObject& object) {
    return object.needs_refit(shapes) ? object.octree().triangles().size() : std::size_t{0};
  };
  for_each_object(stale_, triangles_to_refit,
                  [&](WorldObject& object, const Parallel& workers) { object.update(shapes, workers); });
  for (const std::uint32_t slot : stale_) work.triangles += slots_[slot].object->refitted_triangles();
  return work;
}

/// Counts the queries of each octree. Jobs of objects that did not move search nothing. A query of another
/// object counts by the share of the octree that it meets: the surface of the box that both objects share.
void World::count_queries(std::span<const ContactJob> jobs, std::span<const Aabb> boxes) {
  queries_.assign(slots_.size(), 0);
  for (const ContactJob& job : jobs) {
    if (std::max(versions_[job.a], versions_[job.b]) <= counted_version_) continue;
    if (job.a == job.b) {
      queries_[job.a] += RebuildPolicy::queries_of_self;
    } else {
      const double shared_surface = half_surface(shared_box(boxes[job.a], boxes[job.b]));
      for (const std::uint32_t index : {job.a, job.b}) {
        if (shared_surface > 0) queries_[index] += shared_surface / half_surface(boxes[index]);
      }
    }
  }
}

World::Work World::rebuild_degraded(std::span<const ContactJob> jobs, std::span<const Aabb> boxes) {
  const Work work = rebuild_those_that_pay(jobs, boxes);
  counted_version_ = last_version_;
  return work;
}

World::Work World::rebuild_those_that_pay(std::span<const ContactJob> jobs, std::span<const Aabb> boxes) {
  constexpr std::uint64_t most_triangles = 65536;  // a step, but at least one object
  degraded_.clear();
  for (std::uint32_t index = 0; index < slots_.size(); ++index) {
    const WorldObject* const object = slots_[index].object.get();
    if (object != nullptr && object->rebuild_policy().is_degraded()) degraded_.push_back(index);
  }
  if (degraded_.empty()) return {};
  count_queries(jobs, boxes);
  std::size_t total = 0;
  std::erase_if(degraded_, [&](std::uint32_t index) {
    WorldObject& object = *slots_[index].object;
    if (!(queries_[index] > 0) || !object.rebuild_policy().count_queries(queries_[index])) return true;
    const std::size_t triangles = object.octree().triangles().size();
    if (total > 0 && total + triangles > most_triangles) return true;
    total += triangles;
    return false;
  });
  std::atomic<std::uint64_t> objects = 0, triangles = 0;
  const auto triangle_count = [](const WorldObject& object) { return object.octree().triangles().size(); };
  for_each_object(degraded_, triangle_count, [&](WorldObject& object, const Parallel& workers) {
    if (!object.rebuild(workers)) return;
    ++objects;
    triangles += triangle_count(object);
  });
  return {objects, triangles};
}

}  // namespace supple
