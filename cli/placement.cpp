#include "placement.hpp"

#include <array>

#include "supple/trigonometry.hpp"

namespace supple::cli {
namespace {

struct Angle {
  double sine, cosine;
};

Angle angle(double degrees) {
  return {sin_turns(degrees / 360), cos_turns(degrees / 360)};
}

/// Rz Ry Rx, its rows one after the other.
std::array<Vec3d, 3> rotation(Vec3d degrees) {
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

}  // namespace

void place(std::vector<Vec3d>& positions, const Placement& placement) {
  const bool turned = placement.rotate_xyz_degrees != Vec3d{};
  const std::array<Vec3d, 3> r = rotation(placement.rotate_xyz_degrees);
  for (Vec3d& p : positions) {
    p = p * placement.scale;
    // A product with 0 would spread an infinite coordinate to the others.
    if (turned) p = {row(r[0], p), row(r[1], p), row(r[2], p)};
    p = p + placement.translate;
  }
}

}  // namespace supple::cli
