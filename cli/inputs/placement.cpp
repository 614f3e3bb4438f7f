#include "inputs/placement.hpp"

#include <cmath>
#include <utility>

#include "supple/trigonometry.hpp"

namespace supple::cli {
namespace {

struct Angle {
  double sine, cosine;
};

Angle angle(double degrees) {
  return {sin_turns(degrees / 360), cos_turns(degrees / 360)};
}

/// The matrix Rz Ry Rx, row by row.
Rotation rotation(Vec3d degrees) {
  const Angle x = angle(degrees.x), y = angle(degrees.y), z = angle(degrees.z);
  return {Vec3d{z.cosine * y.cosine, z.cosine * y.sine * x.sine - z.sine * x.cosine,
                z.cosine * y.sine * x.cosine + z.sine * x.sine},
          Vec3d{z.sine * y.cosine, z.sine * y.sine * x.sine + z.cosine * x.cosine,
                z.sine * y.sine * x.cosine - z.cosine * x.sine},
          Vec3d{-y.sine, y.cosine * x.sine, y.cosine * x.cosine}};
}

double row(Vec3d r, Vec3d p) {
  return r.x * p.x + r.y * p.y + r.z * p.z;
}

Vec3d rotated(const Rotation& r, Vec3d p) {
  return {row(r[0], p), row(r[1], p), row(r[2], p)};
}

}  // namespace

void place(std::span<Vec3d> positions, const Placement& placement) {
  const bool turned = placement.rotate_xyz_degrees != Vec3d{};
  const Rotation r = rotation(placement.rotate_xyz_degrees);
  for (Vec3d& p : positions) {
    p = p * placement.scale;
    // A product with 0 would make the other coordinates NaN when one is infinite.
    if (turned) p = rotated(r, p);
    if (placement.turn) p = rotated(*placement.turn, p);
    p = p + placement.translate;
  }
}

void turn_over(std::span<Triangle> triangles) {
  for (Triangle& triangle : triangles) std::swap(triangle[1], triangle[2]);
}

Rotation random_rotation(std::uint64_t seed, std::uint64_t number) {
  const std::uint64_t first = scrambled(scrambled(seed) + number);
  const double part = random_unit(first), turns_1 = random_unit(first + 1), turns_2 = random_unit(first + 2);
  const double r1 = std::sqrt(1 - part), r2 = std::sqrt(part);
  const double x = r1 * sin_turns(turns_1), y = r1 * cos_turns(turns_1);
  const double z = r2 * sin_turns(turns_2), w = r2 * cos_turns(turns_2);
  return {Vec3d{1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)},
          Vec3d{2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)},
          Vec3d{2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)}};
}

}  // namespace supple::cli
