// Distances of objects, and whether they intersect.

#include <algorithm>
#include <cmath>

#include "broad_phase/pair_finder.hpp"
#include "geometry/aabb.hpp"
#include "geometry/vector.hpp"
#include "queries/check_queries.hpp"
#include "queries/queries.hpp"

namespace supple {
namespace {

/// Whether an object is far from something in another box.
bool is_far_from(const Aabb& box, const Aabb& other) {
  return is_far(box, std::sqrt(squared_gap(box, other)), far_ratio);
}

/// With the edges and points of no triangle, as triangles without area. `inert` is memory for their search.
QueriedObject with_extra_elements(QueriedObject queried, const WorldObject& object,
                                  std::vector<std::uint8_t>& inert) {
  if (!object.has_extra_elements()) return queried;
  const bool are_finite = object.near().non_finite_vertices().empty();
  if (!are_finite) mark_inert(object.octree(), object.placement().end(), ~std::uint32_t{0}, inert);
  queried.view.arrays.inert = are_finite ? nullptr : inert.data();
  queried.view.boxes = object.near().node_boxes();
  queried.fine_boxes = nullptr;
  return queried;
}

/// Whether two boxes may be within `distance` of each other.
bool may_be_within(const Aabb& a, const Aabb& b, double distance) {
  const double square = squared_gap(a, b);
  return square * (1 - 0x1p-50) <= distance * distance * (1 + 0x1p-50) + 0x1p-1060;
}

}  // namespace

/// Whether the boxes of the octrees of two objects are too rough for their distance.
bool Queries::are_far(const ObjectPair& pair) const {
  const Aabb &a = world_[pair.a.index].box(), &b = world_[pair.b.index].box();
  return !a.empty() && !b.empty() && is_far_from(a, b) && is_far_from(b, a);
}

/// Call it before `find`. The caller holds the mutex.
void Queries::prepare(NearObjects& near) const {
  WorldObject &a = world_[near.pair.a.index], &b = world_[near.pair.b.index];
  if (are_far(near.pair)) {
    a.update_fine_boxes();
    b.update_fine_boxes();
  }
  if (const auto known = nearest_triangles_.find(near.pair); known != nearest_triangles_.end() &&
                                                             a.octree().has_triangle(known->second.a) &&
                                                             b.octree().has_triangle(known->second.b)) {
    const auto is_inert = [](const WorldObject& object, std::uint32_t triangle) {
      const std::uint8_t* const inert = object.resting_view().arrays.inert;
      return inert != nullptr && inert[triangle] != 0;
    };
    const TrianglePair last{a.octree().octree_triangle(known->second.a),
                            b.octree().octree_triangle(known->second.b)};
    if (!is_inert(a, last.a) && !is_inert(b, last.b)) near.guess = last;
  }
}

/// The search starts at the triangles of the last one.
void Queries::find(NearObjects& near, double max_distance, const StopSignal& stop,
                   NearestPairSearch& search) const {
  const WorldObject &a = world_[near.pair.a.index], &b = world_[near.pair.b.index];
  QueriedObject of_a = queried_object(world_, near.pair.a.index),
                of_b = queried_object(world_, near.pair.b.index);
  if (are_far(near.pair)) {
    of_a.fine_boxes = a.fine_boxes();
    of_b.fine_boxes = b.fine_boxes();
  }
  std::vector<std::uint8_t> inert_a, inert_b;
  near.found = search.nearest(with_extra_elements(of_a, a, inert_a), with_extra_elements(of_b, b, inert_b),
                              max_distance, near.guess, stop);
  if (near.found) {
    near.triangles = {a.octree().triangle_ids()[search.triangles().a],
                      b.octree().triangle_ids()[search.triangles().b]};
  }
}

std::optional<ProximityPair> Queries::distance(ObjectId a, ObjectId b, const CallLimits& limits) const {
  NearObjects near{.pair = world_.two_objects(a, b, "distance")};
  const Lease use(*this);
  use->workers.resize(world_.parallel.worker_count());
  {
    const Lock lock(mutex_);
    refit();
    prepare(near);
  }
  const StopSignal stop = stop_of(limits);
  find(near, any_distance, stop, use->workers.front().pair_search);
  if (stop.stop_requested()) return {};
  if (near.found) {
    const Lock lock(mutex_);
    nearest_triangles_[near.pair] = near.triangles;
  }
  return near.found;
}

bool Queries::any_contact(ObjectId a, ObjectId b, const CallLimits& limits) const {
  const ObjectPair pair = world_.two_objects(a, b, "any_contact");
  const Lease use(*this);
  use->workers.resize(world_.parallel.worker_count());
  {
    const Lock lock(mutex_);
    refit();
  }
  const StopSignal stop = stop_of(limits);
  const bool found = use->workers.front().pair_search.any_contact(queried_object(world_, pair.a.index),
                                                                  queried_object(world_, pair.b.index), stop);
  return found && !stop.stop_requested();
}

/// The pairs of objects whose boxes are within the distance, in canonical order.
std::vector<Queries::NearObjects> Queries::near_objects(double max_distance) const {
  std::vector<Aabb> boxes(world_.slot_count());
  // Rounded sums keep the order of exact ones, so these overlap where two boxes are within the distance.
  for (std::uint32_t slot = 0; slot < boxes.size(); ++slot) {
    if (world_.at(slot) != nullptr) boxes[slot] = grown(world_[slot].box(), max_distance / 2);
  }
  std::vector<NearObjects> near;
  PairFinder finder(BroadPhaseMethod::automatic, BoundingVolume::aabb, {});
  for (const IndexPair& pair : finder.find_pairs({.boxes = boxes}, world_.parallel)) {
    if (may_be_within(world_[pair.a].box(), world_[pair.b].box(), max_distance) && world_.may_pair(pair))
      near.push_back({.pair = {world_.id_of(pair.a), world_.id_of(pair.b)}});
  }
  return near;
}

std::vector<ProximityPair> Queries::distances(double max_distance, const CallLimits& limits) const {
  check_distance(max_distance, "distances");
  const Lease use(*this);
  use->workers.resize(world_.parallel.worker_count());
  {
    const Lock lock(mutex_);
    refit();
  }
  std::vector<NearObjects> near = near_objects(max_distance);  // calls the filter, so without the lock
  {
    const Lock lock(mutex_);
    for (NearObjects& objects : near) prepare(objects);
  }
  const StopSignal stop = stop_of(limits);
  world_.parallel.for_ranges(near.size(), 1, [&](std::size_t begin, std::size_t end, std::uint32_t worker) {
    for (std::size_t i = begin; i < end && !stop.stop_requested(); ++i)
      find(near[i], max_distance, stop, use->workers[worker].pair_search);
  });
  std::vector<ProximityPair> found;
  if (stop.stop_requested()) return found;
  const Lock lock(mutex_);
  for (const NearObjects& objects : near) {
    if (!objects.found) continue;
    found.push_back(*objects.found);
    nearest_triangles_[objects.pair] = objects.triangles;
  }
  return found;
}

void Queries::forget(ObjectId id) {
  std::erase_if(nearest_triangles_,
                [&](const auto& known) { return known.first.a == id || known.first.b == id; });
}

}  // namespace supple
