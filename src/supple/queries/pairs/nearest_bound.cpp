#include "queries/pairs/nearest_bound.hpp"

namespace supple {
namespace {

FeatureVertices vertices_of(const QueriedObject& object, FeatureKind kind,
                            const std::array<std::uint32_t, 2>& name, std::uint32_t triangle) {
  const TrianglePoints corners = object.corners(triangle);
  if (kind == FeatureKind::face) return {corners, 3};
  FeatureVertices result;
  result.count = kind == FeatureKind::edge ? 2 : 1;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t end = 0; end < result.count; ++end) {
      if (object.triangles[triangle][i] == name[end]) result.points[end] = corners[i];
    }
  }
  return result;
}

}  // namespace

void NearestBound::set(const QueriedObject& object_a, const QueriedObject& object_b,
                       const ProximityPair& best, TrianglePair triangles) {
  is_set_ = true;
  ++version_;
  name_ = {best.kind_a, best.kind_b, best.element_a, best.element_b};
  features_ = {vertices_of(object_a, best.kind_a, best.element_a, triangles.a),
               vertices_of(object_b, best.kind_b, best.element_b, triangles.b)};
  planes_ = support_planes(features_[a], best.barycentric_a, features_[b], best.barycentric_b, best.normal);
  distance_ = best.distance * (1 + 0x1p-48);
}

TriangleDepths NearestBound::depths(Side side, const QueriedObject& object, std::uint32_t triangle) const {
  TriangleDepths result;
  result.points = object.corners(triangle);
  result.vertices = object.triangles[triangle];
  result.id = object.triangle_ids[triangle];
  const std::span<const Vec3d> feature = features_[side].all();
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3d& p = result.points[i];
    if (std::find(feature.begin(), feature.end(), p) != feature.end()) {
      result.in_feature = static_cast<std::uint8_t>(result.in_feature | 1u << i);
    } else {
      result.depths[i] = planes_[side].depth(p);
    }
  }
  result.level = level_of(side, result, all_corners);
  return result;
}

bool NearestBound::excludes_equal(const TriangleLevel& level_a, const TriangleLevel& level_b) const {
  PairName least{FeatureKind::vertex,
                 FeatureKind::vertex,
                 {level_a.least_vertex, level_a.least_vertex},
                 {level_b.least_vertex, level_b.least_vertex}};
  if (level_a.is_in_feature && level_b.is_in_feature)
    least = {name_.kind_a, name_.kind_b, level_a.name, level_b.name};
  return !(least < name_);
}

TriangleLevel NearestBound::level_of(Side side, const TriangleDepths& triangle, unsigned corners) const {
  constexpr std::uint32_t largest = std::numeric_limits<std::uint32_t>::max();
  TriangleLevel level;
  level.name = {largest, 0};
  std::size_t count = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    if ((corners >> i & 1) == 0 || triangle.depths[i] > 0) continue;
    ++count;
    const std::uint32_t vertex = triangle.vertices[i];
    level.least_vertex = std::min(level.least_vertex, vertex);
    level.name = {std::min(level.name[0], vertex), std::max(level.name[1], vertex)};
    level.is_in_feature = level.is_in_feature && (triangle.in_feature >> i & 1) != 0;
    for (std::size_t k = 0; k < i; ++k) {
      // In a triangle without area, corners may be at one place.
      const bool is_level = (corners >> k & 1) != 0 && !(triangle.depths[k] > 0);
      if (is_level && triangle.points[k] == triangle.points[i]) level.is_in_feature = false;
    }
  }
  if (count == 3) level.name = {triangle.id, triangle.id};
  if (count < features_[side].count) level.name = {largest, largest};
  return level;
}

}  // namespace supple
