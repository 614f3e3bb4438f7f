#pragma once

#include <cstddef>
#include <cstdint>

#include "contact/impact/relative_motion.hpp"

namespace supple {

/// Relative motions of up to 64 pairs of one kind of elements, as structure of arrays.
class MotionBlock {
 public:
  static constexpr std::size_t capacity = 64;

  void set(std::size_t pair, const RelativeMotion& motion);
  /// m, u and w at the start, x, y and z of each, then the same at the end.
  const double* row(std::size_t index) const { return rows_[index]; }

 private:
  alignas(64) double rows_[18][capacity];
};

/// What floating point can prove at a glance about the first impacts of a block of pairs.
struct CoplanarSearch {
  std::uint64_t apart = 0;     ///< bit i: pair i does not touch within the step
  std::uint64_t touching = 0;  ///< bit i: pair i touches, first within the tolerances after `times[i]`
  /// Bit i: after the start, the volume that pair i spans is never 0, or always 0.
  std::uint64_t clear_after_start = 0;
  double times[MotionBlock::capacity];
};

/// Searches the times at which the four vertices of the first `count` pairs lie in one plane, for elements
/// without separation. `search_impact` decides the pairs that are neither apart nor touching here: degenerate
/// ones, and those that touch near a border. The same bits on all instruction sets.
void search_coplanar_times(const MotionBlock& block, std::size_t count, bool is_square,
                           CoplanarSearch& search);

}  // namespace supple
