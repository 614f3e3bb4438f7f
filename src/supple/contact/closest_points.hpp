#pragma once

#include "contact/relative_motion.hpp"
#include "geometry/vector.hpp"

namespace supple {

/// Parameters (alpha, beta) in the domain, and the difference m - alpha u - beta w there.
struct ClosestPoints {
  double alpha = 0, beta = 0;
  Vec3d difference;
  double squared_distance = 0;
};

/// Where two elements are closest, in plain floating point: any place in the domain where they are as close
/// as rounding can tell.
ClosestPoints closest_points(const RelativePlaces<double>& places, bool is_square);

}  // namespace supple
