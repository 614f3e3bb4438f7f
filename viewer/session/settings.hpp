#pragma once

#include <cstdint>
#include <optional>

#include "scene_view.hpp"
#include "supple/motion.hpp"
#include "supple/options.hpp"

namespace supple::viewer {

/// The values that the commands `set` and `reset` change.
struct Settings {
  std::optional<BoundingVolume> bounding_volume{};
  std::optional<std::uint32_t> max_level{}, leaf_size{};
  std::optional<std::uint32_t> objects{};  ///< number of objects
  std::optional<Integrator> integrator{};
  std::optional<BroadPhaseMethod> broad_phase{};
  std::optional<ContactKinds> contacts{};
  std::optional<double> time_step{};
  std::optional<std::uint64_t> seed{};
};

/// Applies the settings to a scene view. Additional objects are copies, placed in a grid beside the
/// originals; the border grows with the grid. Throws `Error` with the object and the value when an object is
/// invalid, or when the result exceeds the limits of messages.
SceneView arranged(const SceneView& show, const Settings& settings);

}  // namespace supple::viewer
