#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "supple/simulation.hpp"
#include "supple/types.hpp"

namespace supple {

/// An analytic deformation: an object drifts, turned back at the border of the scene, while waves run through
/// it. A function of time alone, so that any frame can be had at once and is the same bits everywhere.
struct WaveMotion {
  Vec3d velocity{};        ///< of the drift, units a second
  double amplitude = 0;    ///< of the waves, units
  double wavelength = 1;   ///< units, > 0
  double period = 1;       ///< of the waves, seconds, > 0
  std::uint64_t seed = 0;  ///< chooses the phases of the waves
};

/// Writes the positions at `seconds` of the vertices that are at `rest` when nothing moves them; both spans
/// are as long. Without a border the drift goes on for ever; within one smaller than the object it stays in
/// place along that axis. O(n); a vertex whose rest position is not finite stays not finite and moves nothing
/// else.
void apply_wave_motion(const WaveMotion& motion, const std::optional<Border>& border,
                       std::span<const Vec3d> rest, double seconds, std::span<Vec3d> positions);

}  // namespace supple
