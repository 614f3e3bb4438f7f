#pragma once

#include "supple/mesh.hpp"
#include "supple/types.hpp"

namespace supple::viewer {

/// Has length 1; zero when the corners have no area or are not finite.
Vec3d unit_normal(const Vec3d& a, const Vec3d& b, const Vec3d& c);
double area(const Vec3d& a, const Vec3d& b, const Vec3d& c);

}  // namespace supple::viewer
