#pragma once

#include <memory>
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
  /// The rank whose region contains the point.
  int rank_of(const Vec3f& point);

 private:
  Zoltan_Struct* zoltan_ = nullptr;
  std::span<const WeightedPoint> points_;  // during `divide`
  std::vector<int> ranks_;
  bool are_divided_ = false;

  friend struct Callbacks;
};

}  // namespace supple
