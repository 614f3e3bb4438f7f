#include <algorithm>
#include <cmath>
#include <string>

#include "core/error.hpp"
#include "supple/scene.hpp"

namespace supple {

RigidTransform RigidTransform::from_quaternion(double x, double y, double z, double w, Vec3d translation) {
  const double largest = std::max({std::fabs(x), std::fabs(y), std::fabs(z), std::fabs(w)});
  const bool is_finite = std::isfinite(x) && std::isfinite(y) && std::isfinite(z) && std::isfinite(w);
  if (!is_finite || largest == 0) {
    fail("RigidTransform::from_quaternion: the quaternion is " + std::to_string(x) + ", " +
         std::to_string(y) + ", " + std::to_string(z) + ", " + std::to_string(w) +
         "; it must be finite and not zero");
  }
  // A power of two, so that squares neither overflow nor vanish.
  for (double* const number : {&x, &y, &z, &w}) *number = std::ldexp(*number, -std::ilogb(largest));
  const double s = 2 / (x * x + y * y + z * z + w * w);
  return {{1 - s * (y * y + z * z), s * (x * y - z * w), s * (x * z + y * w),  //
           s * (x * y + z * w), 1 - s * (x * x + z * z), s * (y * z - x * w),  //
           s * (x * z - y * w), s * (y * z + x * w), 1 - s * (x * x + y * y)},
          translation};
}

}  // namespace supple
