#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <type_traits>

#include "overrides.hpp"
#include "scene_view.hpp"
#include "supple/simulation_descriptions.hpp"

namespace supple::viewer {

/// What the commands `set` and `reset` say instead of the show.
struct Settings {
  Overrides<SceneOptions> scene{};
  Overrides<ObjectOctreeOptions> octree{};  ///< of all objects
  std::optional<std::uint32_t> objects{};   ///< how many
  std::optional<Integrator> integrator{};
  std::optional<double> time_step{};
  std::optional<std::uint64_t> seed{};
};

/// Whether the commands can set an option of the scene or of an octree. The colliding vertices are a layer of
/// frames instead.
template <class Struct, class Value>
constexpr bool is_setting(const Field<Struct, Value>& field) {
  if constexpr (std::is_same_v<Struct, SceneOptions>) {
    if (std::string_view(field.name) == "colliding_vertices") return false;
  }
  return !field.is_of_machine;
}

/// The show with these settings. More objects than it has are copies, set out in a grid beside it, in a
/// border that grows with them. Throws `Error` that names the object and the value when an object of the show
/// is not what it should be, or when there is more than messages can hold.
SceneView arranged(const SceneView& show, const Settings& settings);

}  // namespace supple::viewer
