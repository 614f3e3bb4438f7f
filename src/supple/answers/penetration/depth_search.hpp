#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "contact/distance/distance_kernels.hpp"
#include "contact/distance/element_distance.hpp"
#include "narrow_phase/ordered_descent.hpp"
#include "narrow_phase/recent_leaf_boxes.hpp"
#include "queries/feature_name.hpp"
#include "queries/object_queries.hpp"

namespace supple {

/// A point, its nearest triangle, and the features that hold the closest points.
struct FoundTriangle {
  Vec3d point;
  TrianglePoints corners;
  ClosestFeatures features;
  std::uint32_t triangle = 0, id = 0;  ///< in octree order, and the user's number

  ElementPoints elements() const { return {{point, corners[0], corners[1], corners[2]}, 1, 3}; }
};

/// Computes the distances and closest points of many points at once, which takes less time than one after
/// the other and gives the same bits.
class ClosestPoints {
 public:
  static constexpr std::size_t capacity = PointsBlock::capacity;
  /// At most `capacity` points.
  void compute(std::span<const FoundTriangle> found, std::span<ElementDistance> results);

 private:
  PointsBlock block_{};
  DistanceNumbersBlock numbers_{};
};

/// Finds the nearest triangles of many points in one object. Finds what `ObjectQueries::closest` finds.
/// Vector kernels decide most features, and nothing is computed that the decision does not need. Holds the
/// memory of one worker.
class DepthSearch {
 public:
  /// Call before points in another object, or after it moved.
  void start();
  /// The nearest triangle of a finite point; of several, that with the smallest number. Null when the object
  /// has no finite triangle. Valid until the next call. Starts at the nearest triangle of the point before.
  const FoundTriangle* find(const QueriedObject& object, const Vec3d& point);

 private:
  struct Candidate {
    double lower = 0;  // at most the distance
    std::uint32_t triangle = 0;
  };
  static constexpr std::uint32_t none = ~std::uint32_t{0};

  void consider(std::uint32_t begin, std::uint64_t triangles);
  void decide();
  void decide(const Candidate& candidate, FeatureCode code);
  void set_limit(double limit);

  OrderedDescent descent_;
  RecentLeafBoxes recent_;
  std::vector<Candidate> candidates_;
  PointsBlock block_{};
  std::uint32_t nearest_ = none;  // about the nearest triangle of the last point

  // State of one search.
  const QueriedObject* object_ = nullptr;
  Vec3d point_;
  double limit_ = 0;         // triangles beyond the limit are not of interest
  float squared_limit_ = 0;  // rounded up by more than a squared distance in single precision can lose
  bool is_bounded_ = false, has_found_ = false, used_exact_ = false;
  FoundTriangle found_;
  FeatureName feature_;
};

}  // namespace supple
