#include <algorithm>
#include <cmath>
#include <string>

#include "core/error.hpp"
#include "geometry/vector.hpp"
#include "scene/scene_implementation.hpp"
#include "supple/topology.hpp"

namespace supple {

void Scene::Implementation::list_queried_objects(const QueryFilter& seen, const char* call) {
  if (seen.object) object(*seen.object, call);
  refit_for_queries();
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
          found.box(),
          found.has_inert_faces(),
          found.needs_fine_boxes() ? found.fine_boxes() : nullptr};
}

/// The next search for pairs still sees which objects have moved.
void Scene::Implementation::refit_for_queries() {
  const StepStats stats = result.stats;
  refit_objects(Question{}.shapes());
  result.stats = stats;
  for (const Slot& slot : slots_) {
    if (slot.object != nullptr && slot.object->needs_fine_boxes()) slot.object->update_fine_boxes();
  }
}

/// `places` are those of the queries. Neighbours follow each other, because a search is fast where the one
/// before it was near.
template <class Answer>
void Scene::Implementation::answer_queries(std::span<const Vec3d> places, const StopSignal& stop,
                                           const Answer& answer) {
  constexpr std::size_t grain = 64;
  order_of_queries_.resize(places.size());
  for (std::uint32_t i = 0; i < places.size(); ++i) order_of_queries_[i].triangle = i;
  sort_along_curve(order_of_queries_, places);
  queries_of_workers_.resize(parallel.worker_count());
  parallel.for_ranges(places.size(), grain, [&](std::size_t begin, std::size_t end, std::uint32_t worker) {
    ObjectQueries& queries = queries_of_workers_[worker];
    queries.start(stop);
    for (std::size_t k = begin; k < end && !stop.stop_requested(); ++k)
      answer(queries, order_of_queries_[k].triangle);
  });
}

namespace {

TriangleMesh surface_of(const SceneObject& object) {
  TriangleMesh mesh;
  for (std::uint32_t v = 0; v < object.octree().vertex_count(); ++v)
    mesh.positions.push_back(object.placement().position(v));
  for (std::uint32_t t = 0; t < object.face_count(); ++t)
    mesh.triangles.push_back(object.octree().user_triangle(t));
  return mesh;
}

double squared_gap(const Aabb& a, const Aabb& b) {
  double square = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double gap = std::max({double{a.min[axis]} - b.max[axis], double{b.min[axis]} - a.max[axis], 0.0});
    square += gap * gap;
  }
  return square;
}

/// Whether an object is far from something in another box.
bool is_far_from(const Aabb& box, const Aabb& other) {
  return is_far(box, std::sqrt(squared_gap(box, other)), far_ratio);
}

/// Whether an object is far from a corner of another box.
bool has_far_part(const Aabb& box, const Aabb& other) {
  Vec3d farthest;
  for (int axis = 0; axis < 3; ++axis)
    farthest[axis] =
        std::max({double{box.min[axis]} - other.min[axis], double{other.max[axis]} - box.max[axis], 0.0});
  return !box.empty() && !other.empty() && is_far(box, scaled_norm(farthest), far_ratio);
}

/// Whether two boxes may be within `distance` of each other.
bool may_be_within(const Aabb& a, const Aabb& b, double distance) {
  const double square = squared_gap(a, b);
  return square * (1 - 0x1p-50) <= distance * distance * (1 + 0x1p-50) + 0x1p-1060;
}

/// The bits of what queries read: `add(bits, i)` adds the numbers of query i.
template <class Add>
CoordinateBits bits_of_queries(const char* kind, std::size_t count, const Add& add) {
  CoordinateBits bits(kind, "", "the largest distance");
  for (std::size_t i = 0; i < count; ++i) add(bits, static_cast<std::uint32_t>(i));
  return bits;
}
CoordinateBits bits_of_points(std::span<const Vec3d> points) {
  return bits_of_queries("point", points.size(),
                         [&](CoordinateBits& bits, std::uint32_t i) { bits.add(points[i], i); });
}
CoordinateBits bits_of_rays(std::span<const Ray> rays) {
  return bits_of_queries("ray", rays.size(), [&](CoordinateBits& bits, std::uint32_t i) {
    bits.add(rays[i].origin, i);
    bits.add(rays[i].direction, i);
  });
}
CoordinateBits bits_of_regions(std::span<const QueryBox> boxes) {
  return bits_of_queries("box", boxes.size(), [&](CoordinateBits& bits, std::uint32_t i) {
    bits.add(boxes[i].min, i);
    bits.add(boxes[i].max, i);
  });
}
CoordinateBits bits_of_regions(std::span<const QuerySphere> spheres) {
  return bits_of_queries("sphere", spheres.size(), [&](CoordinateBits& bits, std::uint32_t i) {
    bits.add(spheres[i].center, i);
    bits.add({spheres[i].radius, 0, 0}, i);
  });
}

}  // namespace

void check_distance(double distance, const char* call) {
  if (distance >= 0) return;
  fail(std::string(call) + ": max_distance is " + std::to_string(distance) + "; it must be 0 or more");
}

void check_counts(std::size_t queries, std::size_t results, const char* call) {
  if (queries == results) return;
  fail(std::string(call) + ": " + std::to_string(results) + " results for " + std::to_string(queries) +
       " queries; give one for each");
}

void Scene::Implementation::check_closed(const QueryFilter& seen, const char* call) const {
  if (seen.object) object(*seen.object, call);
  for (const Slot& slot : slots_) {
    if (slot.object == nullptr || (slot.object->options.group & seen.mask) == 0) continue;
    if (seen.object && slots_[seen.object->index].object != slot.object) continue;
    const auto edge = slot.object->open_edge();
    if (!edge) continue;
    const TriangleMesh surface = surface_of(*slot.object);
    fail(std::string(call) + ": the surface of " + slot.object->options.name + " is " +
         describe_surface(compute_topology(surface)) + ": the edge of vertices " +
         std::to_string((*edge)[0]) + " and " + std::to_string((*edge)[1]) +
         " has an odd number of triangles; " + advice_for_open_surface(surface) +
         ", or leave this object out");
  }
}

void Scene::Implementation::closest(std::span<const Vec3d> points,
                                    std::span<std::optional<ClosestPoint>> results,
                                    const ClosestOptions& query) {
  check_counts(points.size(), results.size(), "closest");
  check_distance(query.max_distance, "closest");
  if (query.signed_distance) check_closed(query.filter, "closest");
  list_queried_objects(query.filter, "closest");
  if (has_exact_limit()) {
    CoordinateBits bits = bits_of_points(points);
    bits.add({query.max_distance, 0, 0}, CoordinateBits::no_point);
    check_exact_bits(bits, "closest");
  }
  Aabb around;
  for (const Vec3d& p : points) {
    if (is_finite(p)) extend(around, p);
  }
  for (QueriedObject& object : queried_objects_) {
    if (has_far_part(object.box, around)) object.fine_boxes = updated_fine_boxes(object.id);
  }
  const StopSignal stop = stop_of(query.limits);
  answer_queries(points, stop, [&](ObjectQueries& queries, std::size_t i) {
    results[i] = queries.closest(queried_objects_, points[i], query.max_distance);
    if (query.signed_distance && results[i] && queries.is_inside_nearest(queried_objects_, points[i]))
      results[i]->distance = -results[i]->distance;
  });
  if (stop.stop_requested()) std::fill(results.begin(), results.end(), std::nullopt);
}

void Scene::Implementation::cast(std::span<const Ray> rays, std::span<std::optional<RayHit>> results,
                                 const CastOptions& query) {
  check_counts(rays.size(), results.size(), "cast");
  list_queried_objects(query.filter, "cast");
  if (has_exact_limit()) check_exact_bits(bits_of_rays(rays), "cast");
  origins_.clear();
  for (const Ray& ray : rays) origins_.push_back(ray.origin);
  const StopSignal stop = stop_of(query.limits);
  answer_queries(origins_, stop, [&](ObjectQueries& queries, std::size_t i) {
    results[i] = queries.cast(queried_objects_, rays[i], query.count_hits);
  });
  if (stop.stop_requested()) std::fill(results.begin(), results.end(), std::nullopt);
}

std::span<const ListedRayHit> Scene::Implementation::cast_all(std::span<const Ray> rays,
                                                              const QueryFilter& seen,
                                                              const CallLimits& limits) {
  constexpr std::size_t grain = 64;
  list_queried_objects(seen, "cast_all");
  if (has_exact_limit()) check_exact_bits(bits_of_rays(rays), "cast_all");
  const StopSignal stop = stop_of(limits);
  queries_of_workers_.resize(parallel.worker_count());
  hits_of_workers_.resize(parallel.worker_count());
  hits_of_rays_.resize(rays.size());
  for (std::vector<ListedRayHit>& found : hits_of_workers_) found.clear();
  parallel.for_ranges(rays.size(), grain, [&](std::size_t begin, std::size_t end, std::uint32_t worker) {
    queries_of_workers_[worker].start(stop);
    std::vector<ListedRayHit>& found = hits_of_workers_[worker];
    for (std::size_t i = begin; i < end && !stop.stop_requested(); ++i) {
      const std::size_t first = found.size();
      queries_of_workers_[worker].cast_all(queried_objects_, rays[i], static_cast<std::uint32_t>(i), found);
      hits_of_rays_[i] = {worker, first, found.size() - first};
    }
  });
  hits_.clear();
  if (stop.stop_requested()) return hits_;
  for (const auto& [worker, first, count] : hits_of_rays_) {
    const auto begin = hits_of_workers_[worker].begin() + static_cast<std::ptrdiff_t>(first);
    hits_.insert(hits_.end(), begin, begin + static_cast<std::ptrdiff_t>(count));
  }
  return hits_;
}

void Scene::Implementation::inside(std::span<const Vec3d> points, std::span<Containment> results,
                                   const QueryFilter& seen, const CallLimits& limits) {
  check_counts(points.size(), results.size(), "inside");
  check_closed(seen, "inside");
  list_queried_objects(seen, "inside");
  if (has_exact_limit()) check_exact_bits(bits_of_points(points), "inside");
  const StopSignal stop = stop_of(limits);
  queries_of_workers_.resize(parallel.worker_count());
  std::fill(results.begin(), results.end(), Containment::outside);
  for (const QueriedObject& object : queried_objects_) find_inside(object, points, stop, results);
  if (stop.stop_requested()) std::fill(results.begin(), results.end(), Containment::outside);
}

/// Raises the results of the points in the box of the object.
void Scene::Implementation::find_inside(const QueriedObject& object, std::span<const Vec3d> points,
                                        const StopSignal& stop, std::span<Containment> results) {
  constexpr std::size_t grain = 4096;
  const auto in_box = [&](const Vec3d& point) {
    bool is_in = true;
    for (int axis = 0; axis < 3; ++axis)
      is_in &= object.box.min[axis] <= point[axis] && point[axis] <= object.box.max[axis];
    return is_in;
  };
  const auto count = static_cast<std::size_t>(std::count_if(points.begin(), points.end(), in_box));
  if (count == 0) return;
  queries_of_workers_.front().start(stop);
  const bool has_cells = containment_cells_.build(object, count, queries_of_workers_.front());
  order_of_workers_.resize(parallel.worker_count());
  parallel.for_ranges(points.size(), grain, [&](std::size_t begin, std::size_t end, std::uint32_t worker) {
    std::vector<CurvePlace>& open = order_of_workers_[worker];
    open.clear();
    for (std::size_t i = begin; i < end; ++i) {
      if (results[i] == Containment::inside || !in_box(points[i])) continue;
      const auto side = has_cells ? containment_cells_.side_of(points[i]) : std::nullopt;
      if (side) {
        results[i] = std::max(results[i], *side);
      } else {
        open.push_back({0, static_cast<std::uint32_t>(i)});
      }
    }
    sort_along_curve(open, points);
    ObjectQueries& queries = queries_of_workers_[worker];
    queries.start(stop);
    for (const CurvePlace& place : open) {
      if (stop.stop_requested()) return;
      Containment& answer = results[place.triangle];
      answer = std::max(answer, queries.inside(0, object, points[place.triangle]));
    }
  });
}

template <class Region>
std::span<const Overlap> Scene::Implementation::overlaps(std::span<const Region> regions,
                                                         const QueryFilter& seen, const CallLimits& limits) {
  constexpr std::size_t grain = 16;
  list_queried_objects(seen, "overlaps");
  if (has_exact_limit()) check_exact_bits(bits_of_regions(regions), "overlaps");
  const StopSignal stop = stop_of(limits);
  queries_of_workers_.resize(parallel.worker_count());
  overlaps_of_workers_.resize(parallel.worker_count());
  for (std::vector<Overlap>& found : overlaps_of_workers_) found.clear();
  parallel.for_ranges(regions.size(), grain, [&](std::size_t begin, std::size_t end, std::uint32_t worker) {
    queries_of_workers_[worker].start(stop);
    for (std::size_t i = begin; i < end && !stop.stop_requested(); ++i)
      queries_of_workers_[worker].overlaps(queried_objects_, regions[i], static_cast<std::uint32_t>(i),
                                           overlaps_of_workers_[worker]);
  });
  overlaps_.clear();
  if (stop.stop_requested()) return overlaps_;
  for (const std::vector<Overlap>& found : overlaps_of_workers_)
    overlaps_.insert(overlaps_.end(), found.begin(), found.end());
  std::sort(overlaps_.begin(), overlaps_.end());
  return overlaps_;
}
template std::span<const Overlap> Scene::Implementation::overlaps(std::span<const QueryBox> regions,
                                                                  const QueryFilter& seen,
                                                                  const CallLimits& limits);
template std::span<const Overlap> Scene::Implementation::overlaps(std::span<const QuerySphere> regions,
                                                                  const QueryFilter& seen,
                                                                  const CallLimits& limits);

ObjectPair Scene::Implementation::two_objects(ObjectId a, ObjectId b, const char* call) const {
  object(a, call);
  object(b, call);
  if (a == b) fail(std::string(call) + ": both objects are " + object(a, call).options.name + "; give two");
  return a < b ? ObjectPair{a, b} : ObjectPair{b, a};
}

/// Whether the boxes of the octrees of two objects are too rough for their distance.
bool Scene::Implementation::are_far(const ObjectPair& pair) const {
  const Aabb &a = slots_[pair.a.index].object->box(), &b = slots_[pair.b.index].object->box();
  return !a.empty() && !b.empty() && is_far_from(a, b) && is_far_from(b, a);
}

const QueryBox* Scene::Implementation::updated_fine_boxes(ObjectId id) {
  SceneObject& found = *slots_[id.index].object;
  found.update_fine_boxes();
  return found.fine_boxes();
}

/// Call it before `nearest_of`, which several threads may call.
void Scene::Implementation::prepare_nearest(const ObjectPair& pair) {
  if (!are_far(pair)) return;
  updated_fine_boxes(pair.a);
  updated_fine_boxes(pair.b);
}

/// Sets `triangles` to those of the result, by the user's numbers. The search starts at those of the last
/// one.
std::optional<ProximityPair> Scene::Implementation::nearest_of(const ObjectPair& pair, double max_distance,
                                                               const StopSignal& stop,
                                                               NearestPairSearch& search,
                                                               TrianglePair& triangles) const {
  const SceneObject &a = *slots_[pair.a.index].object, &b = *slots_[pair.b.index].object;
  std::optional<TrianglePair> guess;
  const auto is_inert = [](const SceneObject& object, std::uint32_t triangle) {
    const std::uint8_t* const inert = object.resting_view().arrays.inert;
    return inert != nullptr && inert[triangle] != 0;
  };
  if (const auto known = nearest_triangles_.find(pair); known != nearest_triangles_.end()) {
    const TrianglePair last{a.octree().octree_triangle(known->second.a),
                            b.octree().octree_triangle(known->second.b)};
    if (!is_inert(a, last.a) && !is_inert(b, last.b)) guess = last;
  }
  QueriedObject of_a = queried_object(pair.a.index), of_b = queried_object(pair.b.index);
  if (are_far(pair)) {
    of_a.fine_boxes = a.fine_boxes();
    of_b.fine_boxes = b.fine_boxes();
  }
  const auto found = search.nearest(of_a, of_b, max_distance, guess, stop);
  if (found) {
    triangles = {a.octree().triangle_ids()[search.triangles().a],
                 b.octree().triangle_ids()[search.triangles().b]};
  }
  return found;
}

std::optional<ProximityPair> Scene::Implementation::distance(ObjectId a, ObjectId b,
                                                             const CallLimits& limits) {
  const ObjectPair pair = two_objects(a, b, "distance");
  refit_for_queries();
  check_exact_bits({&pair, 1}, "distance");
  prepare_nearest(pair);
  pair_searches_.resize(parallel.worker_count());
  TrianglePair triangles;
  const StopSignal stop = stop_of(limits);
  const auto found = nearest_of(pair, any_distance, stop, pair_searches_.front(), triangles);
  if (stop.stop_requested()) return {};
  if (found) nearest_triangles_[pair] = triangles;
  return found;
}

bool Scene::Implementation::any_contact(ObjectId a, ObjectId b, const CallLimits& limits) {
  const ObjectPair pair = two_objects(a, b, "any_contact");
  refit_for_queries();
  check_exact_bits({&pair, 1}, "any_contact");
  pair_searches_.resize(parallel.worker_count());
  const StopSignal stop = stop_of(limits);
  const bool found =
      pair_searches_.front().any_contact(queried_object(pair.a.index), queried_object(pair.b.index), stop);
  return found && !stop.stop_requested();
}

/// Lists the pairs of objects whose boxes are within the distance, in canonical order.
void Scene::Implementation::list_near_objects(double max_distance) {
  near_objects_.clear();
  by_box_.clear();
  for (std::uint32_t index = 0; index < slots_.size(); ++index) {
    if (slots_[index].object != nullptr && !slots_[index].object->box().empty()) by_box_.push_back(index);
  }
  const auto box_of = [&](std::uint32_t index) -> const Aabb& { return slots_[index].object->box(); };
  std::sort(by_box_.begin(), by_box_.end(), [&](std::uint32_t p, std::uint32_t q) {
    return std::pair(box_of(p).min.x, p) < std::pair(box_of(q).min.x, q);
  });
  for (std::size_t i = 0; i < by_box_.size(); ++i) {
    const double last = double{box_of(by_box_[i]).max.x} + max_distance,
                 end = last + 0x1p-50 * std::fabs(last);
    for (std::size_t k = i + 1; k < by_box_.size() && !(box_of(by_box_[k]).min.x > end); ++k) {
      const auto [a, b] = std::minmax(by_box_[i], by_box_[k]);
      if (may_be_within(box_of(a), box_of(b), max_distance) && may_pair({a, b}))
        near_objects_.push_back({{id_of(a), id_of(b)}, {}, {}});
    }
  }
  std::sort(near_objects_.begin(), near_objects_.end(),
            [](const NearObjects& p, const NearObjects& q) { return p.pair < q.pair; });
}

std::span<const ProximityPair> Scene::Implementation::distances(double max_distance,
                                                                const CallLimits& limits) {
  check_distance(max_distance, "distances");
  refit_for_queries();
  list_near_objects(max_distance);
  if (has_exact_limit()) {
    std::vector<ObjectPair> pairs;
    for (const NearObjects& near : near_objects_) pairs.push_back(near.pair);
    check_exact_bits(pairs, "distances");
  }
  const StopSignal stop = stop_of(limits);
  for (const NearObjects& near : near_objects_) prepare_nearest(near.pair);
  pair_searches_.resize(parallel.worker_count());
  parallel.for_ranges(near_objects_.size(), 1, [&](std::size_t begin, std::size_t end, std::uint32_t worker) {
    for (std::size_t i = begin; i < end && !stop.stop_requested(); ++i) {
      NearObjects& near = near_objects_[i];
      near.found = nearest_of(near.pair, max_distance, stop, pair_searches_[worker], near.triangles);
    }
  });
  distances_.clear();
  if (stop.stop_requested()) return distances_;
  for (const NearObjects& near : near_objects_) {
    if (!near.found) continue;
    distances_.push_back(*near.found);
    nearest_triangles_[near.pair] = near.triangles;
  }
  return distances_;
}

}  // namespace supple
