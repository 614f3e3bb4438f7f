#include "supple/wave_motion.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "simulation/random.hpp"
#include "supple/trigonometry.hpp"

namespace supple {
namespace {

double random_phase(std::uint64_t seed, std::uint64_t axis) {
  return random_unit(seed * 3 + axis + 1);
}

/// The position after `distance` of a point that starts at 0 and is reflected at `lowest` ≤ 0 and `highest`
/// ≥ 0.
double reflect(double distance, double lowest, double highest) {
  const double room = highest - lowest;
  if (!(room > 0)) return 0;
  double there_and_back = std::fmod(distance - lowest, 2 * room);
  if (there_and_back < 0) there_and_back += 2 * room;
  return lowest + (there_and_back <= room ? there_and_back : 2 * room - there_and_back);
}

double drift(const WaveMotion& motion, const std::optional<Border>& border, std::span<const Vec3d> rest,
             int axis, double seconds) {
  const double distance = motion.velocity[axis] * seconds;
  if (!border) return distance;
  double lowest = std::numeric_limits<double>::infinity(), highest = -lowest;
  for (const Vec3d& p : rest) {
    if (!std::isfinite(p[axis])) continue;
    lowest = std::min(lowest, p[axis]);
    highest = std::max(highest, p[axis]);
  }
  const double room_below = (*border)[0][axis] - (lowest - motion.amplitude);
  const double room_above = (*border)[1][axis] - (highest + motion.amplitude);
  if (!(room_below < room_above)) return 0;
  // An object that starts beyond the border is first moved to it.
  const double start = std::clamp(0.0, room_below, room_above);
  return start + reflect(distance, room_below - start, room_above - start);
}

}  // namespace

void apply_wave_motion(const WaveMotion& motion, const std::optional<Border>& border,
                       std::span<const Vec3d> rest, double seconds, std::span<Vec3d> positions) {
  Vec3d offset;
  std::array<double, 3> phase;
  for (int axis = 0; axis < 3; ++axis) {
    offset[axis] = drift(motion, border, rest, axis, seconds);
    phase[static_cast<std::size_t>(axis)] =
        random_phase(motion.seed, static_cast<std::uint64_t>(axis)) + seconds / motion.period;
  }
  for (std::size_t i = 0; i < rest.size(); ++i) {
    const Vec3d p = rest[i];
    // Each wave displaces points along one axis and travels along another, so that the object bends and
    // shears.
    const Vec3d wave{sin_turns(p.y / motion.wavelength + phase[0]),
                     sin_turns(p.z / motion.wavelength + phase[1]),
                     sin_turns(p.x / motion.wavelength + phase[2])};
    positions[i] = p + offset + motion.amplitude * wave;
  }
}

}  // namespace supple
