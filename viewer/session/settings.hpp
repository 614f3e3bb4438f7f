#pragma once

#include <cstdint>
#include <optional>

#include "scene_view.hpp"
#include "supple/motion.hpp"
#include "supple/options.hpp"

namespace supple::viewer {

/// What the commands `set` and `reset` say instead of the show.
struct Settings {
  std::optional<BoundingVolume> bounding_volume{};
  std::optional<std::uint32_t> max_level{}, leaf_size{};
  std::optional<std::uint32_t> objects{};  ///< how many
  std::optional<Integrator> integrator{};
  std::optional<BroadPhaseMethod> broad_phase{};
  std::optional<ContactKinds> contacts{};
  std::optional<double> time_step{};
  std::optional<std::uint64_t> seed{};
};

/// The show with these settings. More objects than it has are copies, set out in a grid beside it, in a
/// border that grows with them. Throws `Error` that names the object and the value when an object of the show
/// is not what it should be, or when there is more than messages can hold.
SceneView arranged(const SceneView& show, const Settings& settings);

}  // namespace supple::viewer
