#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "contact/distance/element_distance.hpp"
#include "contact/intersection/triangle_bounds.hpp"
#include "core/float_rounding.hpp"
#include "core/stop_signal.hpp"
#include "queries/box_faces.hpp"
#include "queries/feature_name.hpp"
#include "queries/object_queries.hpp"
#include "queries/support_plane.hpp"

namespace supple {

inline ElementPoints point_and_triangle(const Vec3d& point, const TrianglePoints& corners) {
  return {{point, corners[0], corners[1], corners[2]}, 1, 3};
}

/// The nearest triangle of a point so far.
class NearestTriangle {
 public:
  /// After a request to stop, it decides nothing more.
  NearestTriangle(std::span<const QueriedObject> objects, const Vec3d& point, double max_distance,
                  const StopSignal& stop, std::vector<NearTriangle>& candidates)
      : objects_(objects), point_(point), max_distance_(max_distance), stop_(stop), candidates_(candidates) {
    candidates_.clear();
    set_limit(max_distance);
  }

  /// Triangles farther away than this are not of interest.
  double limit() const { return limit_; }
  /// Its square, rounded up by more than a squared distance in single precision can lose.
  float squared_limit() const { return squared_limit_; }
  /// Whether there is a plane through the nearest point so far, and what is certainly farther away by it.
  bool has_plane() const { return has_plane_; }
  bool is_behind(const QueryBox& box) const { return is_behind(box, planes_[1].depth(box)); }

  /// Triangles in octree order from `begin` on, one for each bit. Keeps those that may be the nearest.
  void consider(std::uint32_t index, std::uint32_t begin, std::uint64_t triangles) {
    std::array<TrianglePair, leaf_block> list;
    std::array<double, leaf_block> lower, upper;
    std::size_t count = 0;
    for (std::uint64_t left = triangles; left != 0; left &= left - 1) {
      const std::uint32_t t = begin + static_cast<std::uint32_t>(std::countr_zero(left));
      if (!has_plane_ || !is_behind(objects_[index].corners(t))) list[count++] = {t, 0};
    }
    if (count == 0) return;
    bounded_ += count;
    bound_distances(point_, {objects_[index].view.arrays, objects_[index].view.translation},
                    std::span(list).first(count), lower.data(), upper.data());
    const double least = *std::min_element(upper.begin(), upper.begin() + static_cast<std::ptrdiff_t>(count));
    if (least < limit_) set_limit(least);
    for (std::size_t i = 0; i < count; ++i) {
      if (lower[i] <= limit_) candidates_.push_back({lower[i], index, list[i].a});
    }
    // Many candidates: the bounds of distances are too rough here, so that only a plane helps.
    if (candidates_.size() > most_candidates) decide();
  }

  /// Decides between the triangles that were kept. The nearest one first, which discards most of the others.
  void decide() {
    if (candidates_.empty()) return;
    std::swap(candidates_.front(), *std::min_element(candidates_.begin(), candidates_.end(),
                                                     [](const NearTriangle& p, const NearTriangle& q) {
                                                       return p.distance < q.distance;
                                                     }));
    for (const NearTriangle& candidate : candidates_) {
      if (stop_.stop_requested()) break;
      if (candidate.distance <= limit_) decide(candidate.object, candidate.triangle);
    }
    candidates_.clear();
  }
  void decide(std::uint32_t index, std::uint32_t t) {
    if (found_ && index_ == index && triangle_ == t) return;
    const QueriedObject& object = objects_[index];
    const TrianglePoints corners = object.corners(t);
    const std::uint32_t id = object.triangle_ids[t];
    if (has_plane_ && is_behind(corners)) return;
    // It is not nearer, and comes later.
    if (has_plane_ && depth_of(corners) >= 0 && std::tie(index_, id_) < std::tie(index, id)) return;
    ++decided_;
    const ElementPoints elements = point_and_triangle(point_, corners);
    const auto found = distance_within(elements, limit_, used_exact_);
    if (!found) return;
    const FeatureName feature = name_of(found->on_b, object.triangles[t], id);
    if (found_) {
      const bool is_same_feature = index_ == index && feature_ == feature;
      const int side = is_same_feature
                           ? 0
                           : compare_distances(elements, point_and_triangle(point_, corners_), used_exact_);
      if (side > 0 || (side == 0 && std::tie(index_, id_) < std::tie(index, id))) return;
    }
    found_ = found;
    corners_ = corners;
    index_ = index;
    triangle_ = t;
    id_ = id;
    feature_ = feature;
    has_plane_ = found->distance > 0;
    set_planes();
    set_limit(std::min(max_distance_, found->distance * (1 + 0x1p-36) + 0x1p-1060));
  }

  /// How many triangles it decided exactly.
  std::uint64_t decided() const { return decided_; }
  /// How many distances it bounded.
  std::uint64_t bounded() const { return bounded_; }
  std::uint32_t object() const { return index_; }
  /// In octree order.
  std::uint32_t triangle() const { return triangle_; }

  std::optional<ClosestPoint> result() const {
    if (!found_) return {};
    return ClosestPoint{
        objects_[index_].id, id_,           found_->on_b, found_->distance, found_->barycentric_b,
        found_->point_b,     found_->normal};
  }

 private:
  bool is_behind(const QueryBox& box, double depth) const {
    return are_farther(planes_[0], {point_, point_}, 0, planes_[1], box, depth,
                       found_->distance * (1 + 0x1p-48));
  }
  bool is_behind(const TrianglePoints& corners) const {
    return is_behind(box_of(corners), depth_of(corners));
  }
  double depth_of(const TrianglePoints& corners) const {
    return std::min(
        {planes_[1].depth(corners[0]), planes_[1].depth(corners[1]), planes_[1].depth(corners[2])});
  }
  void set_planes() {
    const std::size_t first = found_->on_b.kind == FeatureKind::face ? 0 : found_->on_b.index;
    const auto& weights = found_->barycentric_b;
    const std::size_t second = (first + 1) % 3, third = (first + 2) % 3;
    const FeatureVertices on_triangle{{corners_[first], corners_[second], corners_[third]},
                                      static_cast<std::size_t>(found_->on_b.kind) + 1};
    planes_ = support_planes({{point_}, 1}, {1, 0, 0}, on_triangle,
                             {weights[first], weights[second], weights[third]}, found_->normal);
  }
  void set_limit(double limit) {
    limit_ = limit;
    squared_limit_ = round_up(limit * limit * (1 + 0x1p-18) + 0x1p-120);
  }

  std::span<const QueriedObject> objects_;
  Vec3d point_;
  double max_distance_, limit_ = 0;
  float squared_limit_ = 0;
  static constexpr std::size_t most_candidates = 256;
  const StopSignal& stop_;
  std::vector<NearTriangle>& candidates_;
  std::optional<ElementDistance> found_;
  std::array<SupportPlane, 2> planes_;  // of the point and of the triangle
  bool has_plane_ = false;
  TrianglePoints corners_;
  std::uint32_t index_ = 0, triangle_ = 0, id_ = 0;
  FeatureName feature_;
  bool used_exact_ = false;
  std::uint64_t decided_ = 0, bounded_ = 0;
};

}  // namespace supple
