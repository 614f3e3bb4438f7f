#pragma once

#include "supple/queries.hpp"

namespace supple {

/// The line of a ray, as boxes near a point see it. Its error is small with respect to the boxes, however far
/// away the origin of the ray is.
class RayLine {
 public:
  /// All numbers are finite. Takes some microseconds.
  RayLine(const Ray& ray, const Vec3d& near);

  /// Whether the line misses the box for certain: it passes the box in a view along one of the axes.
  bool misses(const QueryBox& box) const;

 private:
  Vec3d near_, direction_;
  /// (near - origin) x direction, rounded.
  Vec3d moment_;
};

}  // namespace supple
