#pragma once

#include <limits>
#include <span>
#include <vector>

#include "communicator.hpp"
#include "supple/types.hpp"

struct Zoltan_Struct;

namespace supple {

/// A point of space with the work that is there.
struct WeightedPoint {
  Vec3d position;
  double weight = 1;
};

/// The points above `min` and up to `max` along each axis; the outer bounds are the largest numbers and let
/// everything through.
struct Region {
  Vec3d min{-most, -most, -most}, max{most, most, most};

  static constexpr double most = std::numeric_limits<double>::max();

  bool contains(const Vec3d& p) const {
    for (int axis = 0; axis < 3; ++axis) {
      if (!(p[axis] > min[axis] || min[axis] <= -most) || !(p[axis] <= max[axis] || max[axis] >= most))
        return false;
    }
    return true;
  }
  /// Whether all points of the box are in the region.
  bool contains(const Aabb& box) const {
    return contains(Vec3d{box.min.x, box.min.y, box.min.z}) &&
           contains(Vec3d{box.max.x, box.max.y, box.max.z});
  }
  bool meets(const Aabb& box) const {
    for (int axis = 0; axis < 3; ++axis) {
      if (!(box.max[axis] > min[axis] || min[axis] <= -most) ||
          !(box.min[axis] <= max[axis] || max[axis] >= most))
        return false;
    }
    return true;
  }
};

/// A region of space for each rank, by recursive coordinate bisection.
class Regions {
 public:
  explicit Regions(const Communicator& communicator);
  ~Regions();
  Regions(const Regions&) = delete;
  Regions& operator=(const Regions&) = delete;

  /// Collective: divides space so that all ranks get the same part of the weights of all points.
  void divide(std::span<const WeightedPoint> points);
  bool are_divided() const { return are_divided_; }
  /// The ranks whose regions the box meets, in any order. The span is valid until the next call.
  std::span<const int> ranks_of(const Aabb& box);
  /// The region of this rank.
  Region own() const { return own_; }

 private:
  Zoltan_Struct* zoltan_ = nullptr;
  std::span<const WeightedPoint> points_;  // during `divide`
  std::vector<int> ranks_;
  int rank_;
  Region own_;
  bool are_divided_ = false;

  friend struct Callbacks;
};

}  // namespace supple
