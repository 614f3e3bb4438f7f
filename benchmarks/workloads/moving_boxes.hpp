#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "supple/types.hpp"

namespace supple::benchmarks {

/// Names of the four box fields.
inline constexpr std::array<std::string_view, 4> box_field_names{"u1", "u8", "clu", "cl8"};

/// Workload A: n boxes. Each has a constant velocity of a tenth of its size per frame in a random direction;
/// its centre is reflected at the walls of a cube of side L.
///
/// - u1, u8: unit cubes, uniformly distributed; L = 2 n^(1/3) and n^(1/3).
///
/// - clu, cl8: sizes from a Pareto distribution on [1/64, 16] with alpha 2, each edge 0.5 to 1 times the
/// size, in Gaussian clusters of 512 boxes with sigma 0.25 L / clusters^(1/3); L = 0.30 n^(1/3) and 0.13
/// n^(1/3).
///
/// Faces lie on a lattice of 2^-13, lower faces on even and upper faces on odd multiples. So no two boxes
/// touch without overlapping, and all coordinates are exact in single precision: every method must find the
/// same pairs.
class MovingBoxes {
 public:
  /// Throws `Error` for a name that is not in `box_field_names`.
  MovingBoxes(std::string_view name, std::size_t count, std::uint64_t seed = 1);

  std::span<const Aabb> boxes() const { return boxes_; }
  /// Advances by one frame; only every `one_in`-th box moves.
  void advance(std::size_t one_in = 1);
  double side() const { return side_; }

 private:
  struct Motion {
    Vec3d center, half_extent, velocity;
  };
  void snap(std::size_t box);

  double side_;
  std::vector<Motion> motions_;
  std::vector<Aabb> boxes_;
};

}  // namespace supple::benchmarks
