#pragma once

#include <array>

#include "supple/types.hpp"

namespace supple::benchmarks {

/// Distances in plain double precision, as a user of another library would compute them (Ericson, Real-Time
/// Collision Detection, 5.1.5 and 5.1.9).
double plain_distance(const Vec3d& point, const std::array<Vec3d, 3>& triangle);
double plain_distance(const std::array<Vec3d, 2>& a, const std::array<Vec3d, 2>& b);

}  // namespace supple::benchmarks
