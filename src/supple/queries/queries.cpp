#include "queries/queries.hpp"

#include <hwy/cache_control.h>

#include <algorithm>
#include <utility>

#include "geometry/vector.hpp"
#include "queries/check_queries.hpp"

namespace supple {
namespace {

/// Whether an object is far from a corner of another box.
bool has_far_part(const Aabb& box, const Aabb& other) {
  Vec3d farthest;
  for (int axis = 0; axis < 3; ++axis)
    farthest[axis] =
        std::max({double{box.min[axis]} - other.min[axis], double{other.max[axis]} - box.max[axis], 0.0});
  return !box.empty() && !other.empty() && is_far(box, scaled_norm(farthest), far_ratio);
}

/// Ascending by ray. The hits of a ray stay in their order: one worker has found all of them.
std::vector<ListedRayHit> sorted_by_ray(const std::vector<ListedRayHit>& hits) {
  std::vector<std::pair<std::uint32_t, std::size_t>> places;
  places.reserve(hits.size());
  for (std::size_t i = 0; i < hits.size(); ++i) places.emplace_back(hits[i].query, i);
  std::sort(places.begin(), places.end());
  std::vector<ListedRayHit> sorted;
  sorted.reserve(hits.size());
  for (const auto& [query, place] : places) sorted.push_back(hits[place]);
  return sorted;
}

}  // namespace

QueriedObject queried_object(const World& world, std::uint32_t slot) {
  const WorldObject& found = world[slot];
  return {world.id_of(slot),
          found.resting_view(),
          &found.placement().end(),
          found.octree().triangles(),
          found.octree().triangle_ids(),
          found.box(),
          found.has_inert_faces(),
          found.needs_fine_boxes() ? found.fine_boxes() : nullptr};
}

Queries::Lease::Lease(const Queries& queries) : queries_(queries) {
  const Lock lock(queries_.mutex_);
  if (queries_.idle_.empty()) {
    queries_.idle_.reserve(queries_.made_ + 1);
    call_ = std::make_unique<Call>();
    ++queries_.made_;
  } else {
    call_ = std::move(queries_.idle_.back());
    queries_.idle_.pop_back();
  }
}

Queries::Lease::~Lease() {
  const Lock lock(queries_.mutex_);
  queries_.idle_.push_back(std::move(call_));  // there is room
}

/// The next search for pairs still sees which objects have moved.
void Queries::refit() const {
  world_.refit(shapes_of_queries);
  for (std::uint32_t slot = 0; slot < world_.slot_count(); ++slot) {
    WorldObject* const object = world_.at(slot);
    if (object != nullptr && object->needs_fine_boxes()) object->update_fine_boxes();
  }
}

void Queries::list_objects(const QueryFilter& filter, const char* call, Call& use) const {
  if (filter.object) world_.object(*filter.object, call);
  refit();
  use.objects.clear();
  use.workers.resize(world_.parallel.worker_count());
  for (std::uint32_t slot = 0; slot < world_.slot_count(); ++slot) {
    const WorldObject* const object = world_.at(slot);
    if (object != nullptr && sees(filter, world_.id_of(slot), object->options))
      use.objects.push_back(queried_object(world_, slot));
  }
}

/// `places` are those of the queries. Neighbours follow each other, because a search is fast where the one
/// before it was near.
template <class Answer>
void Queries::answer(std::span<const Vec3d> places, const StopSignal& stop, Call& use,
                     const Answer& answer) const {
  constexpr std::size_t grain = DistanceBatch::capacity;
  use.order.resize(places.size());
  for (std::uint32_t i = 0; i < places.size(); ++i) use.order[i].triangle = i;
  sort_along_curve(use.order, places, use.workers.front().memory);
  world_.parallel.for_ranges(
      places.size(), grain, [&](std::size_t begin, std::size_t end, std::uint32_t worker) {
        use.workers[worker].queries.start(stop);
        for (; begin < end && !stop.stop_requested(); begin += grain)
          answer(use.workers[worker], std::span(use.order).subspan(begin, std::min(grain, end - begin)));
      });
}

void Queries::closest(std::span<const Vec3d> points, std::span<std::optional<ClosestPoint>> results,
                      const ClosestOptions& options) const {
  check_counts(points.size(), results.size(), "closest");
  check_distance(options.max_distance, "closest");
  Aabb around;
  for (const Vec3d& p : points) {
    if (is_finite(p)) extend(around, p);
  }
  const Lease use(*this);
  {
    const Lock lock(mutex_);
    list_objects(options.filter, "closest", *use);
    if (options.signed_distance) check_closed(world_, options.filter, "closest");
    for (QueriedObject& object : use->objects) {
      if (!has_far_part(object.box, around)) continue;
      WorldObject& far = world_[object.id.index];
      far.update_fine_boxes();
      object.fine_boxes = far.fine_boxes();
    }
  }
  const StopSignal stop = stop_of(options.limits);
  answer(points, stop, *use, [&](Worker& worker, std::span<const CurvePlace> part) {
    std::array<FoundFeatures, DistanceBatch::capacity> found;
    std::array<ElementDistance, DistanceBatch::capacity> distances;
    std::array<ClosestPoint*, DistanceBatch::capacity> places;
    // Points and results are far apart in memory: none waits for another one here.
    std::array<Vec3d, DistanceBatch::capacity> gathered;
    std::array<std::optional<ClosestPoint>, DistanceBatch::capacity> answers;
    for (std::size_t k = 0; k < part.size(); ++k) gathered[k] = points[part[k].triangle];
    std::size_t count = 0;
    std::array<std::optional<FoundTriangle>, DistanceBatch::capacity> triangles;
    for (std::size_t k = 0; k < part.size(); k += PointPacket::capacity)
      worker.queries.nearest(use->objects,
                             std::span(gathered).subspan(k, std::min(PointPacket::capacity, part.size() - k)),
                             options.max_distance, std::span(triangles).subspan(k));
    for (std::size_t k = 0; k < part.size(); ++k) {
      const auto& nearest = triangles[k];
      if (!nearest) continue;
      const QueriedObject& object = use->objects[nearest->object];
      const bool is_inside =
          options.signed_distance &&
          worker.queries.inside(nearest->object, object, gathered[k]) == Containment::inside;
      answers[k] = {object.id, nearest->id, {}, is_inside ? -1.0 : 1.0, {}, {}, {}};
      found[count] = {nearest->elements(), {}};
      places[count++] = &*answers[k];
    }
    worker.distances.find(std::span(found).first(count), distances);
    for (std::size_t k = 0; k < count; ++k) {
      const ElementDistance& d = distances[k];
      *places[k] = {places[k]->object, places[k]->triangle, d.on_b,  places[k]->distance * d.distance,
                    d.barycentric_b,   d.point_b,           d.normal};
    }
    for (std::size_t k = 0; k < part.size(); ++k) results[part[k].triangle] = answers[k];
  });
  if (stop.stop_requested()) std::fill(results.begin(), results.end(), std::nullopt);
}

void Queries::cast(std::span<const Ray> rays, std::span<std::optional<RayHit>> results,
                   const CastOptions& options) const {
  check_counts(rays.size(), results.size(), "cast");
  const Lease use(*this);
  {
    const Lock lock(mutex_);
    list_objects(options.filter, "cast", *use);
  }
  use->origins.clear();
  for (const Ray& ray : rays) use->origins.push_back(ray.origin);
  const StopSignal stop = stop_of(options.limits);
  answer(use->origins, stop, *use, [&](Worker& worker, std::span<const CurvePlace> part) {
    for (const auto& [code, i] : part)
      results[i] = worker.queries.cast(use->objects, rays[i], options.count_hits);
  });
  if (stop.stop_requested()) std::fill(results.begin(), results.end(), std::nullopt);
}

/// Calls `find(queries, objects, i, list)` for all i below `count`. It appends to the list of a worker.
/// Returns all lists in one, empty after a stop.
template <class Item, class Find>
std::vector<Item> Queries::find_all(std::size_t count, std::vector<Item> Worker::*list,
                                    const QueryFilter& filter, const char* call, const CallLimits& limits,
                                    const Find& find) const {
  constexpr std::size_t grain = 16;
  const Lease use(*this);
  {
    const Lock lock(mutex_);
    list_objects(filter, call, *use);
  }
  const StopSignal stop = stop_of(limits);
  for (Worker& worker : use->workers) (worker.*list).clear();
  world_.parallel.for_ranges(count, grain, [&](std::size_t begin, std::size_t end, std::uint32_t w) {
    Worker& worker = use->workers[w];
    worker.queries.start(stop);
    for (std::size_t i = begin; i < end && !stop.stop_requested(); ++i)
      find(worker.queries, use->objects, static_cast<std::uint32_t>(i), worker.*list);
  });
  std::vector<Item> all;
  if (stop.stop_requested()) return all;
  for (const Worker& worker : use->workers)
    all.insert(all.end(), (worker.*list).begin(), (worker.*list).end());
  return all;
}

std::vector<ListedRayHit> Queries::cast_all(std::span<const Ray> rays, const QueryFilter& filter,
                                            const CallLimits& limits) const {
  return sorted_by_ray(find_all(rays.size(), &Worker::hits, filter, "cast_all", limits,
                                [&](ObjectQueries& queries, const auto& objects, std::uint32_t i,
                                    auto& found) { queries.cast_all(objects, rays[i], i, found); }));
}

void Queries::inside(std::span<const Vec3d> points, std::span<Containment> results, const QueryFilter& filter,
                     const CallLimits& limits) const {
  check_counts(points.size(), results.size(), "inside");
  const Lease use(*this);
  {
    const Lock lock(mutex_);
    list_objects(filter, "inside", *use);
    check_closed(world_, filter, "inside");
  }
  const StopSignal stop = stop_of(limits);
  std::fill(results.begin(), results.end(), Containment::outside);
  for (const QueriedObject& object : use->objects) find_inside(object, points, stop, results, *use);
  if (stop.stop_requested()) std::fill(results.begin(), results.end(), Containment::outside);
}

/// Raises the results of the points in the box of the object.
void Queries::find_inside(const QueriedObject& object, std::span<const Vec3d> points, const StopSignal& stop,
                          std::span<Containment> results, Call& use) const {
  use.workers.front().queries.start(stop);
  const bool has_cells = use.cells.build(object, points, use.workers.front().queries);
  world_.parallel.for_ranges(
      points.size(), 1 << 16, [&](std::size_t begin, std::size_t end, std::uint32_t w) {
        ObjectQueries& queries = use.workers[w].queries;
        OpenPoints& open = use.workers[w].open;
        open.clear();
        for (std::size_t count = 0; begin < end && !stop.stop_requested(); begin += count) {
          count = std::min(CellGrid::block, end - begin);
          if (has_cells) {
            use.cells.raise(points.subspan(begin, count), begin, results.subspan(begin, count), open);
            continue;
          }
          for (std::size_t i = begin; i < begin + count; ++i) {
            if (contains(object.box, points[i])) open.add(0, points[i], i);
          }
        }
        if (has_cells)
          sort_by_code(open.order, use.workers[w].memory);
        else
          sort_along_curve(open.order, open.points, use.workers[w].memory);
        queries.start(stop);
        constexpr std::size_t ahead = 8;
        for (std::size_t k = 0; k < open.order.size() && !stop.stop_requested(); ++k) {
          hwy::Prefetch(&open.points[open.order[std::min(k + ahead, open.order.size() - 1)].triangle]);
          const std::uint32_t i = open.order[k].triangle;
          open.sides[i] = has_cells ? use.cells.side_of(open.points[i], object, queries)
                                    : queries.inside(0, object, open.points[i]);
        }
        for (std::size_t i = 0; i < open.numbers.size(); ++i)
          results[open.numbers[i]] = std::max(results[open.numbers[i]], open.sides[i]);
      });
}

template <class Region>
std::vector<Overlap> Queries::overlaps(std::span<const Region> regions, const QueryFilter& filter,
                                       const CallLimits& limits) const {
  std::vector<Overlap> found = find_all(regions.size(), &Worker::overlaps, filter, "overlaps", limits,
                                        [&](ObjectQueries& queries, const auto& objects, std::uint32_t i,
                                            auto& list) { queries.overlaps(objects, regions[i], i, list); });
  std::sort(found.begin(), found.end());
  return found;
}
template std::vector<Overlap> Queries::overlaps(std::span<const QueryBox> regions, const QueryFilter& filter,
                                                const CallLimits& limits) const;
template std::vector<Overlap> Queries::overlaps(std::span<const QuerySphere> regions,
                                                const QueryFilter& filter, const CallLimits& limits) const;

}  // namespace supple
