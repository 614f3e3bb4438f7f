#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geometry/vector.hpp"

namespace supple {

constexpr int curve_bits_per_axis = 21;

/// Place of a triangle on a Morton curve: three bits a level, the first level highest.
struct CurvePlace {
  std::uint64_t code;
  std::uint32_t triangle;
};

/// Sorts by the codes, of 63 bits, then by the triangles, which ascend. `memory` is for the sort.
void sort_by_code(std::span<CurvePlace> places, std::vector<CurvePlace>& memory);

/// Codes the centres `centers[triangle]` in the cube around them and sorts by the codes. A centre that is not
/// finite counts as the lower corner of the others. All codes are 0 when all centres are equal.
void sort_along_curve(std::span<CurvePlace> places, std::span<const Vec3d> centers,
                      std::vector<CurvePlace>& memory);

}  // namespace supple
