#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "supple/simulation.hpp"
#include "supple/types.hpp"

namespace supple {

/// An analytic deformation: an object drifts, the border of the scene reflects it, and waves run through it.
/// It depends only on the time and has the same bits on every machine, so any frame can be computed
/// separately.
struct WaveMotion {
  Vec3d velocity{};        ///< of the drift, units per second
  double amplitude = 0;    ///< of the waves, units
  double wavelength = 1;   ///< units, > 0
  double period = 1;       ///< of the waves, seconds, > 0
  std::uint64_t seed = 0;  ///< chooses the phases of the waves
};

/// Writes the positions at time `seconds` of vertices with the positions `rest`; both spans have the same
/// length. Without a border the drift never ends. Along an axis where the border is smaller than the object,
/// the object does not drift. O(n). A vertex whose rest position is not finite stays so and does not affect
/// others.
void apply_wave_motion(const WaveMotion& motion, const std::optional<Border>& border,
                       std::span<const Vec3d> rest, double seconds, std::span<Vec3d> positions);

}  // namespace supple
