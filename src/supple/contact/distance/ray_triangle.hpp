#pragma once

#include <optional>

#include "geometry/numbers/bounded_double.hpp"
#include "supple/queries.hpp"
#include "supple/triangle_intersection.hpp"

namespace supple {

/// The smallest t ≥ 0 at which a ray meets a closed triangle, as a fraction.
class RayParameter {
 public:
  /// Nothing when the ray misses the triangle, which exact arithmetic decides. All numbers must be finite,
  /// and the direction not zero. Sets `used_exact` when integers decide.
  static std::optional<RayParameter> find(const Ray& ray, const TrianglePoints& triangle, bool& used_exact);

  const TrianglePoints& triangle() const { return triangle_; }
  /// Within 4 units in the last place.
  double rounded() const;
  /// At least the value, and hardly more; takes less than `rounded`.
  double upper_bound() const;
  /// The sign of the difference of two parameters, exact.
  int compare(const RayParameter& other, bool& used_exact) const;

 private:
  RayParameter(const Ray& ray, const TrianglePoints& triangle) : ray_(&ray), triangle_(triangle) {}

  const Ray* ray_;
  TrianglePoints triangle_;
  BoundedDouble numerator_, denominator_;
  bool is_bounded_ = false;  ///< `numerator_` and `denominator_` are known
};

}  // namespace supple
