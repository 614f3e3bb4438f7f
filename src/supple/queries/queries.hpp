#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "contact/distance/distance_batch.hpp"
#include "core/lock.hpp"
#include "core/stop_signal.hpp"
#include "octree/morton_curve.hpp"
#include "queries/containment_cells.hpp"
#include "queries/object_queries.hpp"
#include "queries/pairs/nearest_pair.hpp"
#include "supple/queries.hpp"
#include "world/world.hpp"

namespace supple {

/// What queries read of a slot that has an object. It must be refitted.
QueriedObject queried_object(const World& world, std::uint32_t slot);

/// The queries of `Scene`, which documents them. Several threads may call them at the same time as long as
/// nothing changes the world: each call takes memory of its own, which later calls use again. The first call
/// after a change refits what has moved.
class Queries {
 public:
  explicit Queries(World& world) : world_(world) {}

  void closest(std::span<const Vec3d> points, std::span<std::optional<ClosestPoint>> results,
               const ClosestOptions& options) const;
  void cast(std::span<const Ray> rays, std::span<std::optional<RayHit>> results,
            const CastOptions& options) const;
  std::vector<ListedRayHit> cast_all(std::span<const Ray> rays, const QueryFilter& filter,
                                     const CallLimits& limits) const;
  void inside(std::span<const Vec3d> points, std::span<Containment> results, const QueryFilter& filter,
              const CallLimits& limits) const;
  /// For boxes and spheres.
  template <class Region>
  std::vector<Overlap> overlaps(std::span<const Region> regions, const QueryFilter& filter,
                                const CallLimits& limits) const;
  std::optional<ProximityPair> distance(ObjectId a, ObjectId b, const CallLimits& limits) const;
  std::vector<ProximityPair> distances(double max_distance, const CallLimits& limits) const;
  bool any_contact(ObjectId a, ObjectId b, const CallLimits& limits) const;
  /// The object is removed: `distance` no longer starts at its last answers.
  void forget(ObjectId id);

 private:
  /// The memory of one worker.
  struct Worker {
    ObjectQueries queries;
    NearestPairSearch pair_search;
    DistanceBatch distances;
    OpenPoints open;
    std::vector<CurvePlace> memory;  // of sorts
    std::vector<ListedRayHit> hits;
    std::vector<Overlap> overlaps;
  };
  /// The memory of one call.
  struct Call {
    std::vector<Worker> workers;
    std::vector<QueriedObject> objects;
    std::vector<CurvePlace> order;
    std::vector<Vec3d> origins;  // of rays
    ContainmentCells cells;
  };
  /// Takes the memory of an earlier call, or new memory, and gives it back.
  class Lease {
   public:
    explicit Lease(const Queries& queries);
    ~Lease();
    Lease(const Lease&) = delete;
    Lease& operator=(const Lease&) = delete;
    Call& operator*() const { return *call_; }
    Call* operator->() const { return call_.get(); }

   private:
    const Queries& queries_;
    std::unique_ptr<Call> call_;
  };
  /// Two objects that may be near, their nearest features, and triangles that have these, by the user's
  /// numbers.
  struct NearObjects {
    ObjectPair pair;
    std::optional<TrianglePair> guess{};
    std::optional<ProximityPair> found{};
    TrianglePair triangles{};
  };

  /// Refits what has moved. The caller holds the mutex.
  void refit() const;
  template <class Item, class Find>
  std::vector<Item> find_all(std::size_t count, std::vector<Item> Worker::*list, const QueryFilter& filter,
                             const char* call, const CallLimits& limits, const Find& find) const;
  /// Lists the objects that the filter lets through. The caller holds the mutex.
  void list_objects(const QueryFilter& filter, const char* call, Call& use) const;
  /// Calls `answer(worker, part)` with all queries, at most `DistanceBatch::capacity` at a time.
  template <class Answer>
  void answer(std::span<const Vec3d> places, const StopSignal& stop, Call& use, const Answer& answer) const;
  void find_inside(const QueriedObject& object, std::span<const Vec3d> points, const StopSignal& stop,
                   std::span<Containment> results, Call& use) const;
  std::vector<NearObjects> near_objects(double max_distance) const;
  bool are_far(const ObjectPair& pair) const;
  void prepare(NearObjects& near) const;
  void find(NearObjects& near, double max_distance, const StopSignal& stop, NearestPairSearch& search) const;

  World& world_;
  mutable Mutex mutex_;  // for the refit of the world, and for what follows
  mutable std::vector<std::unique_ptr<Call>> idle_;
  mutable std::size_t made_ = 0;  // calls, idle or not
  /// Triangles with the nearest features of pairs of objects, the user's numbers.
  mutable std::map<ObjectPair, TrianglePair> nearest_triangles_;
};

}  // namespace supple
