#pragma once

#include <algorithm>
#include <cmath>

#include "animation/angles.hpp"
#include "supple/trigonometry.hpp"

// Compiles ufbx as a part of the file that includes this header, so that a program may have a ufbx of its
// own, also of another version. Its functions are static; C++ does not allow this for its constants, which
// get other names.

// The functions of <math.h> that ufbx calls, with the same bits on every machine. Those for cameras and
// colours are the ones of the standard library.

namespace supple::ufbx_math {

inline constexpr double turn = 6.283185307179586;

inline double sin(double x) {
  return sin_turns(x / turn);
}
inline double cos(double x) {
  return cos_turns(x / turn);
}
/// The angle of the point (x, y), of which at least one is not 0.
inline double atan2(double y, double x) {
  const double largest = std::max(std::fabs(x), std::fabs(y));
  if (!(largest > 0) || !std::isfinite(largest)) return std::atan2(y, x);
  const double u = std::fabs(x) / largest, v = std::fabs(y) / largest, length = std::sqrt(u * u + v * v);
  const double quarter = angle_in_turns(u / length, v / length) * turn;
  return std::copysign(x < 0 ? turn / 2 - quarter : quarter, y);
}
inline double asin(double x) {
  return atan2(x, std::sqrt(std::max(0.0, (1 - x) * (1 + x))));
}
inline double acos(double x) {
  return atan2(std::sqrt(std::max(0.0, (1 - x) * (1 + x))), x);
}

}  // namespace supple::ufbx_math

#define UFBX_STATIC
// Without undefined shifts and unaligned loads, which ufbx otherwise leaves to x86 processors.
#define UFBX_UBSAN 1
#define ufbx_abi_data extern
#define ufbx_abi_data_definition
#define ufbx_abi_data_def
#define ufbx_empty_string supple_ufbx_empty_string
#define ufbx_empty_blob supple_ufbx_empty_blob
#define ufbx_identity_matrix supple_ufbx_identity_matrix
#define ufbx_identity_transform supple_ufbx_identity_transform
#define ufbx_zero_vec2 supple_ufbx_zero_vec2
#define ufbx_zero_vec3 supple_ufbx_zero_vec3
#define ufbx_zero_vec4 supple_ufbx_zero_vec4
#define ufbx_identity_quat supple_ufbx_identity_quat
#define ufbx_axes_right_handed_y_up supple_ufbx_axes_right_handed_y_up
#define ufbx_axes_right_handed_z_up supple_ufbx_axes_right_handed_z_up
#define ufbx_axes_left_handed_y_up supple_ufbx_axes_left_handed_y_up
#define ufbx_axes_left_handed_z_up supple_ufbx_axes_left_handed_z_up
#define ufbx_element_type_size supple_ufbx_element_type_size
#define ufbx_source_version supple_ufbx_source_version
#define UFBX_EXTERNAL_MATH
#define UFBX_NO_EXTERNAL_DEFINES
#define ufbx_acos supple::ufbx_math::acos
#define ufbx_asin supple::ufbx_math::asin
#define ufbx_atan2 supple::ufbx_math::atan2
#define ufbx_cos supple::ufbx_math::cos
#define ufbx_sin supple::ufbx_math::sin
#define ufbx_atan std::atan
#define ufbx_ceil std::ceil
#define ufbx_copysign std::copysign
#define ufbx_fabs std::fabs
#define ufbx_floor std::floor
#define ufbx_fmax std::fmax
#define ufbx_fmin std::fmin
#define ufbx_isnan std::isnan
#define ufbx_nextafter std::nextafter
#define ufbx_pow std::pow
#define ufbx_rint std::rint
#define ufbx_sqrt std::sqrt
#define ufbx_tan std::tan
#include <ufbx.c>
