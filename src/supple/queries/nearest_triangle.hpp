#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <tuple>
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
  /// After a request to stop, it decides nothing more. The candidates are triangles that may be the nearest,
  /// among them all within `limit`, where that is less than the distance.
  NearestTriangle(std::span<const QueriedObject> objects, const Vec3d& point, double max_distance,
                  const StopSignal& stop, std::vector<NearTriangle>& candidates, PointsBlock& block,
                  double limit = std::numeric_limits<double>::infinity())
      : objects_(objects),
        point_(point),
        max_distance_(max_distance),
        stop_(stop),
        candidates_(candidates),
        block_(block) {
    set_limit(std::min(limit, max_distance));
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
    bound_distances({&point_, 1}, {objects_[index].view.arrays, objects_[index].view.translation},
                    std::span(list).first(count), lower.data(), upper.data());
    const double least = *std::min_element(upper.begin(), upper.begin() + static_cast<std::ptrdiff_t>(count));
    if (least < limit_) set_limit(least);
    for (std::size_t i = 0; i < count; ++i) {
      if (lower[i] <= limit_) candidates_.push_back({lower[i], index, list[i].a});
    }
    // Many candidates: the bounds of distances are too rough here, so that only a plane helps.
    if (candidates_.size() > most_candidates) find_plane();
  }

  /// Sets a plane through the nearest point so far, if there is one.
  void find_plane() {
    decide();
    if (found_ && !has_plane_) set_planes();
  }

  /// Decides between the triangles that were kept. After the last call, the nearest one has no features.
  void decide(bool is_last = false) {
    std::erase_if(candidates_, [&](const NearTriangle& candidate) { return candidate.distance > limit_; });
    // Some triangle is within a limit that has decreased.
    if (is_last && candidates_.size() == 1 && !found_ && limit_ < max_distance_) {
      found_ = triangle_of(candidates_.front().object, candidates_.front().triangle);
      return candidates_.clear();
    }
    std::array<FeatureCode, PointsBlock::capacity> codes;
    for (std::size_t first = 0; first < candidates_.size(); first += codes.size()) {
      const auto part = std::span(candidates_).subspan(first);
      const std::size_t count = std::min(part.size(), codes.size());
      for (std::size_t i = 0; i < count; ++i) {
        const TrianglePoints corners = objects_[part[i].object].corners(part[i].triangle);
        block_.set(0, i, point_);
        for (std::size_t k = 0; k < 3; ++k) block_.set(k + 1, i, corners[k]);
      }
      // Looser than the limit, which is often so tight that vector kernels cannot decide.
      classify(block_, count, false, std::min(max_distance_, limit_ * (1 + 0x1p-20)), codes.data());
      for (std::size_t i = 0; i < count && !stop_.stop_requested(); ++i) {
        if (codes[i] != FeatureCode::apart && part[i].distance <= limit_)
          decide(part[i].object, part[i].triangle, codes[i]);
      }
    }
    candidates_.clear();
  }
  void decide(std::uint32_t index, std::uint32_t t, FeatureCode code) {
    if (found_ && found_->object == index && found_->triangle == t) return;
    const FoundTriangle other = triangle_of(index, t);
    const auto comes_later = [&] {
      return std::tie(found_->object, found_->id) < std::tie(other.object, other.id);
    };
    if (has_plane_ && (is_behind(other.corners) || (depth_of(other.corners) >= 0 && comes_later()))) return;
    ++decided_;
    const auto features = code == FeatureCode::unknown
                              ? closest_features_within(other.elements(), limit_, used_exact_)
                              : std::optional(features_of_code(code, false));
    if (!features) return;
    const FeatureName feature =
        name_of(features_of_elements(*features, 1)[1], objects_[index].triangles[t], other.id);
    if (found_) {
      const bool is_same_feature = found_->object == index && feature_ == feature;
      const int side =
          is_same_feature ? 0 : compare_distances(other.elements(), found_->elements(), used_exact_);
      if (side > 0 || (side == 0 && comes_later())) return;
    }
    found_ = other;
    features_ = *features;
    feature_ = feature;
    // Where there are no bounds, or vector kernels cannot decide, a plane helps.
    if (has_plane_ || code == FeatureCode::unknown || limit_ == max_distance_) set_planes();
  }

  /// How many triangles it decided exactly.
  std::uint64_t decided() const { return decided_; }
  /// How many distances it bounded.
  std::uint64_t bounded() const { return bounded_; }
  const std::optional<FoundTriangle>& found() const { return found_; }

  /// The corners are those of a triangle that the search will consider.
  void limit_to(const TrianglePoints& corners) {
    for (const Vec3d& corner : corners) {
      const Vec3d way = corner - point_;
      const double distance = std::sqrt(way.x * way.x + way.y * way.y + way.z * way.z);
      // Squares may underflow.
      if (const double limit = distance * (1 + 0x1p-40) + 0x1p-500; limit < limit_) set_limit(limit);
    }
  }

 private:
  FoundTriangle triangle_of(std::uint32_t index, std::uint32_t t) const {
    return {point_, objects_[index].corners(t), index, t, objects_[index].triangle_ids[t]};
  }
  bool is_behind(const QueryBox& box, double depth) const {
    return are_farther(planes_[0], {point_, point_}, 0, planes_[1], box, depth, distance_ * (1 + 0x1p-48));
  }
  bool is_behind(const TrianglePoints& corners) const {
    return is_behind(box_around(corners), depth_of(corners));
  }
  double depth_of(const TrianglePoints& corners) const {
    return std::min(
        {planes_[1].depth(corners[0]), planes_[1].depth(corners[1]), planes_[1].depth(corners[2])});
  }
  void set_planes() {
    const ElementDistance found = distance_of(found_->elements(), features_, used_exact_);
    const std::size_t first = found.on_b.kind == FeatureKind::face ? 0 : found.on_b.index;
    const auto& weights = found.barycentric_b;
    const std::size_t second = (first + 1) % 3, third = (first + 2) % 3;
    const TrianglePoints& corners = found_->corners;
    const FeatureVertices on_triangle{{corners[first], corners[second], corners[third]},
                                      static_cast<std::size_t>(found.on_b.kind) + 1};
    planes_ = support_planes({{point_}, 1}, {1, 0, 0}, on_triangle,
                             {weights[first], weights[second], weights[third]}, found.normal);
    distance_ = found.distance;
    has_plane_ = distance_ > 0;
    set_limit(std::min(limit_, distance_ * (1 + 0x1p-36) + 0x1p-1060));
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
  PointsBlock& block_;
  std::optional<FoundTriangle> found_;
  std::array<SupportPlane, 2> planes_;  // of the point and of the triangle
  double distance_ = 0;                 // of the two
  bool has_plane_ = false;
  ClosestFeatures features_;  // of the two, and their name
  FeatureName feature_;
  bool used_exact_ = false;
  std::uint64_t decided_ = 0, bounded_ = 0;
};

}  // namespace supple
