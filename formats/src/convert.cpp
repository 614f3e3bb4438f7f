#include <array>

#include "supple/formats.hpp"

namespace supple {
namespace {

double metres_of(LengthUnit unit) {
  constexpr std::array metres = {0.0, 1e-6, 1e-3, 1e-2, 1.0, 1e3, 0.0254, 0.3048};
  return metres[static_cast<std::size_t>(unit)];
}

bool has_up(const CoordinateFrame& frame, const CoordinateConversion& wanted) {
  return frame.up != UpAxis::file && wanted.up != UpAxis::file;
}

bool has_unit(const CoordinateFrame& frame, const CoordinateConversion& wanted) {
  return frame.unit > 0 && wanted.unit != LengthUnit::file;
}

Vec3d to_y_up(const Vec3d& p, UpAxis from) {
  return from == UpAxis::x ? Vec3d{-p.y, p.x, p.z} : from == UpAxis::z ? Vec3d{p.x, p.z, -p.y} : p;
}

Vec3d from_y_up(const Vec3d& p, UpAxis to) {
  return to == UpAxis::x ? Vec3d{p.y, -p.x, p.z} : to == UpAxis::z ? Vec3d{p.x, -p.z, p.y} : p;
}

}  // namespace

bool can_convert(const CoordinateFrame& frame, const CoordinateConversion& wanted) {
  return has_up(frame, wanted) || has_unit(frame, wanted);
}

void convert(std::span<Vec3d> positions, const CoordinateFrame& frame, const CoordinateConversion& wanted) {
  const double factor = has_unit(frame, wanted) ? frame.unit / metres_of(wanted.unit) : 1;
  const bool turns = has_up(frame, wanted) && frame.up != wanted.up;
  for (Vec3d& p : positions) {
    if (turns) p = from_y_up(to_y_up(p, frame.up), wanted.up);
    if (factor != 1) p = p * factor;
  }
}

}  // namespace supple
