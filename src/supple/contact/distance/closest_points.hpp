#pragma once

#include "contact/impact/relative_motion.hpp"
#include "geometry/vector.hpp"

namespace supple {

/// Parameters (alpha, beta) in the domain, and the difference m - alpha u - beta w there.
struct ClosestPoints {
  double alpha = 0, beta = 0;
  Vec3d difference;
  double squared_distance = 0;
};

/// A place in the domain where two elements are closest, up to rounding.
ClosestPoints closest_points(const RelativePlaces<double>& places, bool is_square);

}  // namespace supple
