#pragma once

#include <cstdint>

#include "results.hpp"

namespace supple::experiments {

struct VolumesOptions {
  bool with_bikes = true;
  std::uint32_t frequency = 64;  ///< of the spheres: 20 f² triangles
  int deformed_frames = 40;      ///< frames of each deforming scene, ≥ 1
  int rounds = 5;                ///< ≥ 1; the fastest counts
  std::uint64_t seed = 1;
};

VolumesOptions volumes_options(bool quick);

/// All kinds of bounding volumes and all ways to build the octrees of objects on the same frames, with one
/// thread.
Results run_volumes(const VolumesOptions& options, bool show_progress);

}  // namespace supple::experiments
