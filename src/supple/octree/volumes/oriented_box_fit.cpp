#include "octree/volumes/oriented_box_fit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "core/float_rounding.hpp"
#include "geometry/aabb.hpp"
#include "geometry/vector.hpp"

namespace supple {
namespace {

using Matrix = std::array<std::array<double, 3>, 3>;

Matrix covariance(const SurfaceMoments& moments) {
  const auto& [xx, yy, zz, xy, yz, zx] = moments.second;
  return {{{xx, xy, zx}, {xy, yy, yz}, {zx, yz, zz}}};
}

/// Calls `visit(place, p[i] q[i])` for the six products of second moments.
template <class Visit>
void for_each_product(Vec3d p, Vec3d q, const Visit& visit) {
  visit(0, p.x * q.x);
  visit(1, p.y * q.y);
  visit(2, p.z * q.z);
  visit(3, p.x * q.y);
  visit(4, p.y * q.z);
  visit(5, p.z * q.x);
}

/// Sets the entry (i, j) of a symmetric matrix to zero by a rotation, and rotates the vectors likewise.
void rotate(Matrix& m, std::array<Vec3d, 3>& vectors, std::size_t i, std::size_t j) {
  if (m[i][j] == 0) return;
  const double theta = (m[j][j] - m[i][i]) / (2 * m[i][j]);
  const double t = (theta < 0 ? -1 : 1) / (std::abs(theta) + std::sqrt(theta * theta + 1));
  const double c = 1 / std::sqrt(t * t + 1), s = t * c;
  for (std::size_t k = 0; k < 3; ++k) {
    const double p = m[k][i], q = m[k][j];
    m[k][i] = c * p - s * q;
    m[k][j] = s * p + c * q;
  }
  for (std::size_t k = 0; k < 3; ++k) {
    const double p = m[i][k], q = m[j][k];
    m[i][k] = c * p - s * q;
    m[j][k] = s * p + c * q;
  }
  const Vec3d p = vectors[i], q = vectors[j];
  vectors[i] = c * p - s * q;
  vectors[j] = s * p + c * q;
}

/// The eigenvectors of a symmetric matrix by Jacobi's method, orthonormal except for rounding. Converges
/// quadratically: five sweeps are enough for double, and fewer when the matrix is nearly diagonal for float.
std::array<Vec3d, 3> eigenvectors(Matrix m) {
  std::array<Vec3d, 3> vectors{Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}};
  const double negligible = 0x1p-30 * (m[0][0] + m[1][1] + m[2][2]);
  for (int sweep = 0; sweep < 5; ++sweep) {
    if (std::max({std::abs(m[0][1]), std::abs(m[1][2]), std::abs(m[0][2])}) <= negligible) break;
    rotate(m, vectors, 0, 1);
    rotate(m, vectors, 1, 2);
    rotate(m, vectors, 0, 2);
  }
  return vectors;
}

double half_surface(Vec3f h) {
  return double{h.x} * h.y + double{h.y} * h.z + double{h.z} * h.x;
}

Vec3f in_float(Vec3d v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

OrientedBox aligned_box(const Aabb& box) {
  OrientedBox result;
  for (int axis = 0; axis < 3; ++axis) {
    const double low = box.min[axis], high = box.max[axis];
    result.center[axis] = static_cast<float>((low + high) / 2);
    result.half_lengths[axis] = round_up(std::max(high - result.center[axis], result.center[axis] - low));
  }
  return result;
}

}  // namespace

/// The parallel axis theorem.
SurfaceMoments& SurfaceMoments::operator+=(const SurfaceMoments& other) {
  if (!(other.area > 0)) return *this;
  if (!(area > 0)) return *this = other;
  const Vec3d between = other.center - center;
  const double sum = area + other.area, share = other.area / sum;
  for (std::size_t i = 0; i < second.size(); ++i) second[i] += other.second[i];
  for_each_product(between, between,
                   [&](std::size_t place, double product) { second[place] += area * share * product; });
  center += share * between;
  area = sum;
  return *this;
}

/// Sums over the triangles about the first corner, then moves the sums to the centre: without a division for
/// each triangle.
SurfaceMoments moments_of(const SurfacePart& part) {
  std::optional<Vec3d> origin;
  SurfaceMoments sum;
  part.for_each([&](Vec3d p, Vec3d q, Vec3d r) {
    if (!origin) origin = p;
    p = p - *origin;
    q = q - *origin;
    r = r - *origin;
    const double area = norm(cross(q - p, r - p)) / 2;
    const Vec3d corners = p + q + r;
    sum.area += area;
    sum.center += area / 3 * corners;
    // The mean of a b over a triangle is the sum of a b over its corners and their sum, divided by 12.
    for (const Vec3d& corner : {p, q, r, corners}) {
      for_each_product(corner, corner,
                       [&](std::size_t place, double product) { sum.second[place] += area / 12 * product; });
    }
  });
  if (!(sum.area > 0)) return {};
  const Vec3d center = sum.center * (1 / sum.area);
  for_each_product(center, center,
                   [&](std::size_t place, double product) { sum.second[place] -= sum.area * product; });
  sum.center = *origin + center;
  return sum;
}

OrientedBoxFit::OrientedBoxFit(const SurfaceMoments& moments, const Aabb& box) {
  if (box.empty()) return;
  constexpr float largest = 0x1p60f;  // squares of areas do not overflow
  for (int axis = 0; axis < 3; ++axis) {
    if (!(box.min[axis] >= -largest && box.max[axis] <= largest)) {
      constexpr float inf = std::numeric_limits<float>::infinity();
      aligned_.half_lengths = {inf, inf, inf};
      return;
    }
  }
  aligned_ = aligned_box(box);
  if (!(moments.area > 0)) return;
  const std::array<Vec3d, 3> axes = eigenvectors(covariance(moments));
  for (std::size_t k = 0; k < 3; ++k) frame_.axes[k] = in_float(axes[k]);
  frame_.origin = in_double(aligned_.center);
  needs_extents_ = true;
}

/// The growth covers the errors of the extents and the rounding of the axes, which makes them up to 2^-22
/// oblique.
OrientedBox OrientedBoxFit::box(const AxisExtents& extents) const {
  if (!needs_extents_) return aligned_;
  OrientedBox fitted{{}, frame_.axes, {}};
  Vec3d center = frame_.origin;
  double reach = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const double low = extents.low[k], high = extents.high[k];
    center += (low + high) / 2 * in_double(frame_.axes[k]);
    reach += std::max(std::abs(low), std::abs(high));
  }
  fitted.center = in_float(center);
  const double growth = 0x1p-19 * reach + std::numeric_limits<float>::min();
  for (std::size_t k = 0; k < 3; ++k) {
    const double along = dot(in_double(frame_.axes[k]), in_double(fitted.center) - frame_.origin);
    fitted.half_lengths[static_cast<int>(k)] =
        round_up(std::max(extents.high[k] - along, along - extents.low[k]) + growth);
  }
  return half_surface(fitted.half_lengths) < half_surface(aligned_.half_lengths) ? fitted : aligned_;
}

}  // namespace supple
