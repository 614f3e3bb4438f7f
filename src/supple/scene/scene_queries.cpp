// The queries of a scene.

#include "scene/scene_implementation.hpp"

namespace supple {

void Scene::closest(std::span<const Vec3d> points, std::span<std::optional<ClosestPoint>> results,
                    const ClosestOptions& options) const {
  implementation_->queries.closest(points, results, options);
}
void Scene::cast(std::span<const Ray> rays, std::span<std::optional<RayHit>> results,
                 const CastOptions& options) const {
  implementation_->queries.cast(rays, results, options);
}
std::vector<ListedRayHit> Scene::cast_all(std::span<const Ray> rays, const QueryFilter& filter,
                                          const CallLimits& limits) const {
  return implementation_->queries.cast_all(rays, filter, limits);
}
void Scene::inside(std::span<const Vec3d> points, std::span<Containment> results, const QueryFilter& filter,
                   const CallLimits& limits) const {
  implementation_->queries.inside(points, results, filter, limits);
}
std::vector<Overlap> Scene::overlaps(std::span<const QueryBox> boxes, const QueryFilter& filter,
                                     const CallLimits& limits) const {
  return implementation_->queries.overlaps(boxes, filter, limits);
}
std::vector<Overlap> Scene::overlaps(std::span<const QuerySphere> spheres, const QueryFilter& filter,
                                     const CallLimits& limits) const {
  return implementation_->queries.overlaps(spheres, filter, limits);
}
std::optional<ProximityPair> Scene::distance(ObjectId a, ObjectId b, const CallLimits& limits) const {
  return implementation_->queries.distance(a, b, limits);
}
std::vector<ProximityPair> Scene::distances(double max_distance, const CallLimits& limits) const {
  return implementation_->queries.distances(max_distance, limits);
}
bool Scene::any_contact(ObjectId a, ObjectId b, const CallLimits& limits) const {
  return implementation_->queries.any_contact(a, b, limits);
}

}  // namespace supple
