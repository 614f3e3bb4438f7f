#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "queries/object_queries.hpp"
#include "queries/pairs/proximity_pair.hpp"
#include "queries/support_plane.hpp"

namespace supple {

/// The part of a triangle that is in the plane of its object.
struct TriangleLevel {
  bool is_in_feature = true;  ///< no more than the nearest feature
  /// The name of that feature, or the largest name where a part of it is missing.
  std::array<std::uint32_t, 2> name{};
  std::uint32_t least_vertex = std::numeric_limits<std::uint32_t>::max();
};

/// The depths of the corners of a triangle behind the plane of its object.
struct TriangleDepths {
  TrianglePoints points;
  Triangle vertices;
  std::uint32_t id = 0;
  std::array<double, 3> depths{};
  std::uint8_t in_feature = 0;  ///< bit i: corner i is where a vertex of the nearest feature is
  TriangleLevel level;          ///< of all corners

  /// The least depth of the corners in a set of bits.
  double least(unsigned corners) const {
    double result = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < 3; ++i) {
      if ((corners >> i & 1) != 0) result = std::min(result, depths[i]);
    }
    return result;
  }
  QueryBox box(unsigned corners) const {
    QueryBox result = no_box();
    for (std::size_t i = 0; i < 3; ++i) {
      if ((corners >> i & 1) != 0) extend(result, points[i], points[i]);
    }
    return result;
  }
};

/// Says what is not nearer than the nearest features of two objects so far, and, among what is as near, what
/// does not come before them in the order of pairs. So it needs no exact decision for the many elements that
/// share the nearest features.
class NearestBound {
 public:
  enum Side : std::size_t { a, b };
  static constexpr unsigned all_corners = 7;

  void clear() { is_set_ = false; }
  /// `best` has a distance above 0; `triangles` have its features, in octree order.
  void set(const QueriedObject& object_a, const QueriedObject& object_b, const ProximityPair& best,
           TrianglePair triangles);
  bool is_set() const { return is_set_; }
  /// Increases with each `set`.
  std::uint64_t version() const { return version_; }

  TriangleDepths depths(Side side, const QueriedObject& object, std::uint32_t triangle) const;
  double depth(Side side, const QueryBox& box) const { return planes_[side].depth(box); }
  const SupportPlane& plane(Side side) const { return planes_[side]; }
  /// Whether what is in the two boxes of these depths is farther apart.
  bool are_apart(const QueryBox& box_a, double depth_a, const QueryBox& box_b, double depth_b) const {
    return are_farther(planes_[a], box_a, depth_a, planes_[b], box_b, depth_b, distance_);
  }
  /// Whether these parts of two triangles, as sets of corners, do not give a better pair.
  bool excludes(const TriangleDepths& of_a, unsigned corners_a, const TriangleDepths& of_b,
                unsigned corners_b) const {
    const double least_a = of_a.least(corners_a), least_b = of_b.least(corners_b);
    if (least_a + least_b > 0) return true;
    if (least_a >= 0 && least_b >= 0 &&
        excludes_equal(corners_a == all_corners ? of_a.level : level_of(a, of_a, corners_a),
                       corners_b == all_corners ? of_b.level : level_of(b, of_b, corners_b)))
      return true;
    return are_apart(of_a.box(corners_a), least_a, of_b.box(corners_b), least_b);
  }

  /// Both parts are not in front of their planes, so they are as near as the nearest features only where both
  /// are in the planes and one is exactly across from the other. In both features, that is the place where
  /// their nearest points are. Levels may be the least of several: not in the feature where one is not, and
  /// the least name and vertex.
  bool excludes_equal(const TriangleLevel& level_a, const TriangleLevel& level_b) const;

 private:
  TriangleLevel level_of(Side side, const TriangleDepths& triangle, unsigned corners) const;

  bool is_set_ = false;
  std::uint64_t version_ = 0;
  std::array<SupportPlane, 2> planes_;
  std::array<FeatureVertices, 2> features_;
  PairName name_;
  double distance_ = 0;
};

}  // namespace supple
