#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "supple/types.hpp"

namespace supple {

/// A point that may span a manifold.
struct ManifoldCandidate {
  Vec3d position;
  double depth = 0;
  std::uint32_t record = 0, part = 0;  ///< where the caller has it from
};

/// Indices of candidates.
struct ManifoldChoice {
  std::array<std::uint32_t, 4> chosen{};
  std::uint32_t count = 0;
};

/// Chooses at most four points that span candidates in the plane at right angles to the normal, in the order
/// around it; see `Manifold`. Keeps its memory.
class PointChoice {
 public:
  /// There is at least one candidate, and all are finite. O(n).
  ManifoldChoice choose(std::span<const ManifoldCandidate> candidates, const Vec3d& normal);

 private:
  struct Point {
    double x = 0, y = 0, depth = 0;
  };
  double project(std::span<const ManifoldCandidate> candidates, const Vec3d& normal);

  std::vector<Point> points_;  // in the plane, scaled by a power of two so that nothing overflows or vanishes
};

}  // namespace supple
