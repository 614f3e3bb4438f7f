// The queries of a scene, and their comparison with brute force.

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
std::vector<WrongAnswer> Scene::verify_closest(std::span<const Vec3d> points,
                                               std::span<const std::optional<ClosestPoint>> results,
                                               const ClosestOptions& options) const {
  return implementation_->query_verifier.closest(points, results, options);
}
std::vector<WrongAnswer> Scene::verify_cast(std::span<const Ray> rays,
                                            std::span<const std::optional<RayHit>> results,
                                            const CastOptions& options) const {
  return implementation_->query_verifier.cast(rays, results, options);
}
std::vector<WrongAnswer> Scene::verify_cast_all(std::span<const Ray> rays, std::span<const ListedRayHit> hits,
                                                const QueryFilter& filter) const {
  return implementation_->query_verifier.cast_all(rays, hits, filter);
}
std::vector<WrongAnswer> Scene::verify_overlaps(std::span<const QueryBox> boxes,
                                                std::span<const Overlap> found,
                                                const QueryFilter& filter) const {
  return implementation_->query_verifier.overlaps(boxes, found, filter);
}
std::vector<WrongAnswer> Scene::verify_overlaps(std::span<const QuerySphere> spheres,
                                                std::span<const Overlap> found,
                                                const QueryFilter& filter) const {
  return implementation_->query_verifier.overlaps(spheres, found, filter);
}
std::vector<WrongAnswer> Scene::verify_inside(std::span<const Vec3d> points,
                                              std::span<const Containment> results,
                                              const QueryFilter& filter) const {
  return implementation_->query_verifier.inside(points, results, filter);
}
std::vector<WrongAnswer> Scene::verify_distance(ObjectId a, ObjectId b,
                                                const std::optional<ProximityPair>& found) const {
  return implementation_->query_verifier.distance(a, b, found);
}
std::vector<WrongAnswer> Scene::verify_distances(double max_distance,
                                                 std::span<const ProximityPair> found) const {
  return implementation_->query_verifier.distances(max_distance, found);
}
std::vector<WrongAnswer> Scene::verify_any_contact(ObjectId a, ObjectId b, bool found) const {
  return implementation_->query_verifier.any_contact(a, b, found);
}

}  // namespace supple
