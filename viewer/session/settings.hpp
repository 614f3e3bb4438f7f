#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <type_traits>

#include "arguments.hpp"
#include "overrides.hpp"
#include "scene_view.hpp"
#include "supple/simulation_descriptions.hpp"

namespace supple::viewer {

/// Settings that a simulation cannot change while it runs: a change restarts it.
struct RestartSettings {
  std::optional<std::uint32_t> objects{};  ///< number of objects
  std::optional<Integrator> integrator{};
  std::optional<double> time_step{};
  std::optional<std::uint64_t> seed{};

  constexpr bool operator==(const RestartSettings&) const = default;
};

/// The values that the commands `set` and `reset` change.
struct Settings {
  Overrides<SceneOptions> scene{};
  Overrides<ObjectOctreeOptions> octree{};  ///< of all objects
  RestartSettings restart{};
};

/// Has the description of the number of objects.
struct ObjectCount {
  std::uint32_t objects = 1;
};

/// Calls `visitor(field, member)` for each setting of the command `set` that restarts. `member` points to the
/// member of `RestartSettings`.
template <class Visitor>
constexpr void for_each_restart_setting(Visitor&& visitor) {
  visitor(Field<ObjectCount, std::uint32_t>{.name = "objects",
                                            .member = &ObjectCount::objects,
                                            .doc = "Number of objects: the list is repeated, or cut",
                                            .range = ValueRange::from(1, 100'000)},
          &RestartSettings::objects);
  for_each_field<MassSpringOptions>([&]<class Value>(const Field<MassSpringOptions, Value>& field) {
    if constexpr (std::is_same_v<Value, Integrator>) visitor(field, &RestartSettings::integrator);
  });
  for_each_field<SimulationOptions>([&]<class Value>(const Field<SimulationOptions, Value>& field) {
    if constexpr (std::is_same_v<Value, double>) visitor(field, &RestartSettings::time_step);
  });
}

/// Whether the commands can set an option of the scene or of an octree. The colliding vertices are a layer of
/// frames instead. A page shows no manifolds, and one listing of proximity.
template <class Struct, class Value>
constexpr bool is_setting(const Field<Struct, Value>& field) {
  if constexpr (std::is_same_v<Struct, ComparisonOptions>) {
    if (std::string_view(field.name) == "colliding_vertices") return false;
  }
  if constexpr (std::is_same_v<Struct, SceneOptions>) {
    if (std::string_view(field.name) == "manifolds" || std::string_view(field.name) == "curves") return false;
  }
  if constexpr (std::is_same_v<Value, ProximityListing>) return false;
  return !field.is_of_machine;
}

/// The settings after the command `set`, which changes those that it names.
Settings read_settings(Settings settings, const SceneOptions& scene, bool of_simulation,
                       Arguments& arguments);

/// Other methods refuse options of the scene octree.
constexpr bool uses_scene_octree(BroadPhaseMethod method) {
  return method == BroadPhaseMethod::automatic || method == BroadPhaseMethod::octree;
}

/// Estimates the memory in bytes that a session needs for its objects, generously: measured sessions of all
/// kinds of motion, contacts and octrees need 10 to 90 % of it. Cost: one visit of each object.
double estimated_memory(const SceneView& show, const Settings& settings);

/// Whether a session has this memory in bytes; if not, this is an error of the arguments.
bool fits_in_memory(const SceneView& show, const Settings& settings, double bytes, Arguments& arguments);

/// Applies the settings to a scene view. Additional objects are copies, placed in a grid beside the
/// originals; the border grows with the grid. Throws `Error` with the object and the value when an object is
/// invalid, or when the result exceeds the limits of messages.
SceneView arranged(const SceneView& show, const Settings& settings);

}  // namespace supple::viewer
