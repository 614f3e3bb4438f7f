#include "inputs/half_turns.hpp"

#include <Eigen/Dense>
#include <array>
#include <cmath>
#include <cstddef>

namespace supple::cli {
namespace {

bool is_finite(const Vec3d& p) {
  return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}

}  // namespace

/// Rotations that fit are quaternions: eigenvectors of a matrix of products of coordinates (Horn 1987). The
/// first component is the cosine of half of the angle. A rod has several that fit, with all between them; the
/// smallest angle counts.
bool turns_too_far(std::span<const Vec3d> from, std::span<const Vec3d> to) {
  constexpr double square_of_cosine_of_60_degrees = 0.25, largest_misfit = 1.0 / 16, least_motion = 0x1p-40;
  Vec3d center_from, center_to;
  double count = 0;
  const auto for_each_vertex = [&](const auto& visit) {
    for (std::size_t v = 0; v < from.size(); ++v) {
      if (is_finite(from[v]) && is_finite(to[v])) visit(from[v], to[v]);
    }
  };
  for_each_vertex([&](const Vec3d& a, const Vec3d& b) {
    center_from += a;
    center_to += b;
    ++count;
  });
  if (count < 2) return false;
  center_from = center_from / count;
  center_to = center_to / count;
  std::array<std::array<double, 3>, 3> s{};
  double size = 0, motion = 0;  // sums of squares
  for_each_vertex([&](const Vec3d& a, const Vec3d& b) {
    const Vec3d p = a - center_from, q = b - center_to;
    size += squared_norm(p) + squared_norm(q);
    motion += squared_norm(p - q);
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) s[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)] += p[i] * q[j];
    }
  });
  const auto& [x, y, z] = s;
  const double yz = y[2] - z[1], zx = z[0] - x[2], xy = x[1] - y[0];
  const double sum_xy = x[1] + y[0], sum_zx = z[0] + x[2], sum_yz = y[2] + z[1];
  Eigen::Matrix4d products;
  products << x[0] + y[1] + z[2], yz, zx, xy,  //
      yz, x[0] - y[1] - z[2], sum_xy, sum_zx,  //
      zx, sum_xy, y[1] - x[0] - z[2], sum_yz,  //
      xy, sum_zx, sum_yz, z[2] - x[0] - y[1];
  if (!(motion > least_motion * size)) return false;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d> rotations(products);
  if (rotations.info() != Eigen::Success) return false;
  bool fits = false;
  double square_of_cosine = 0;
  for (Eigen::Index i = 0; i < 4; ++i) {
    if (!(size - 2 * rotations.eigenvalues()[i] <= largest_misfit * motion)) continue;
    fits = true;
    square_of_cosine += rotations.eigenvectors()(0, i) * rotations.eigenvectors()(0, i);
  }
  return fits && square_of_cosine < square_of_cosine_of_60_degrees;
}

}  // namespace supple::cli
