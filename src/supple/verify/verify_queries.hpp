#pragma once

#include <optional>
#include <span>
#include <vector>

#include "supple/queries.hpp"
#include "verify/brute_force_queries.hpp"
#include "world/world.hpp"

namespace supple {

/// Compares answers of queries with exact brute force; see the functions of `Scene` with these names after
/// `verify_`.
class QueryVerifier {
 public:
  explicit QueryVerifier(const World& world) : world_(world) {}

  std::vector<WrongAnswer> closest(std::span<const Vec3d> points,
                                   std::span<const std::optional<ClosestPoint>> results,
                                   const ClosestOptions& query) const;
  std::vector<WrongAnswer> cast(std::span<const Ray> rays, std::span<const std::optional<RayHit>> results,
                                const CastOptions& query) const;
  std::vector<WrongAnswer> cast_all(std::span<const Ray> rays, std::span<const ListedRayHit> hits,
                                    const QueryFilter& seen) const;
  /// For boxes and spheres.
  template <class Region>
  std::vector<WrongAnswer> overlaps(std::span<const Region> regions, std::span<const Overlap> overlaps,
                                    const QueryFilter& seen) const;
  std::vector<WrongAnswer> inside(std::span<const Vec3d> points, std::span<const Containment> results,
                                  const QueryFilter& seen) const;
  std::vector<WrongAnswer> distance(ObjectId a, ObjectId b, const std::optional<ProximityPair>& found) const;
  std::vector<WrongAnswer> distances(double max_distance, std::span<const ProximityPair> found) const;
  std::vector<WrongAnswer> any_contact(ObjectId a, ObjectId b, bool found) const;

 private:
  /// Both answers in words when they differ. `found` is null when nothing was found.
  std::optional<WrongAnswer> wrong_distance(const ObjectPair& pair, double max_distance,
                                            const ProximityPair* found) const;

  const World& world_;
};

}  // namespace supple
