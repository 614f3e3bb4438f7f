#pragma once

#include <array>
#include <cmath>

#include "geometry/vector.hpp"
#include "motion/network/spring_network.hpp"
#include "supple/types.hpp"

namespace supple {

/// The force on end a of a spring; the force on b is the opposite. `d` = x_b - x_a, `velocity` = v_b - v_a.
///
/// Eq. 2 of the paper, (k_s (|d| - s) + k_d |d|˙) d/|d|, with |d|˙ = velocity·d / |d|: damping acts along
/// the spring (Teschner et al. 2004). A spring of length 0 has no direction and exerts no force.
inline Vec3d spring_force(Vec3d d, Vec3d velocity, double stiffness, double damping, double rest_length) {
  const double length = std::sqrt(dot(d, d));
  if (!(length > 0)) return {};
  const double inverse = 1 / length;
  return d * ((stiffness * (length - rest_length) + damping * dot(velocity, d) * inverse) * inverse);
}

/// The area of a triangle and its gradient with respect to the corners.
struct AreaGradient {
  double area = 0;
  std::array<Vec3d, 3> of_corner{};  ///< ∂A/∂x: half the opposite side, rotated outward by 90 degrees
};

/// A triangle of area 0 has no normal; its gradient is 0.
inline AreaGradient area_gradient(Vec3d p0, Vec3d p1, Vec3d p2) {
  const Vec3d normal = cross(p1 - p0, p2 - p0);
  const double twice = std::sqrt(dot(normal, normal));
  if (!(twice > 0)) return {};
  const Vec3d half = normal * (0.5 / twice);
  AreaGradient result{0.5 * twice, {}};
  result.of_corner[1] = cross(p2 - p0, half);
  result.of_corner[2] = cross(half, p1 - p0);
  // The sum must be exactly zero after rounding, because momentum depends on it.
  result.of_corner[0] = Vec3d{} - (result.of_corner[1] + result.of_corner[2]);
  return result;
}

/// Forces of the energy k (A - A0)² / 2 S on the three corners (Teschner et al. 2004, with S instead of
/// A0²).
inline std::array<Vec3d, 3> area_forces(const AreaElement& element, double stiffness, Vec3d p0, Vec3d p1,
                                        Vec3d p2) {
  const AreaGradient gradient = area_gradient(p0, p1, p2);
  const double pull = stiffness * (element.rest_area - gradient.area) * element.inverse_scale;
  return {gradient.of_corner[0] * pull, gradient.of_corner[1] * pull, gradient.of_corner[2] * pull};
}

}  // namespace supple
