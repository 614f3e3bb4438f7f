#pragma once

#include <span>

#include "supple/options.hpp"

namespace supple::cli {

/// The options of the programs where nothing else is given: what touches is also described by curves.
inline SceneOptions default_scene_options() {
  return {.curves = true};
}

/// A condition under which an option of the scene has an effect. An option may have several.
struct OptionNeed {
  const char* key;
  bool (*is_met)(const SceneOptions& scene);
  const char* decider;  ///< key of the option that decides
  const char* values;   ///< the values of that option that meet the condition
};

/// The command line and scene files refuse an option that is given and has no effect.
std::span<const OptionNeed> option_needs();

/// Whether the scene looks at triangles at rest. Otherwise it searches elements, with boxes.
bool is_at_rest(const SceneOptions& scene);
/// Whether the regions of the scene octree may be used.
bool has_scene_octree(const SceneOptions& scene);
/// Whether the scene finds these contacts.
template <ContactKinds kind>
bool finds(const SceneOptions& scene) {
  return contains(with_included(scene.contacts), kind);
}
inline constexpr auto has_intersections = finds<ContactKinds::intersection>;
inline constexpr auto has_continuous = finds<ContactKinds::continuous>;
inline constexpr auto has_margins = finds<ContactKinds::proximity>;
inline constexpr auto has_penetration = finds<ContactKinds::penetration>;
bool has_spheres(const SceneOptions& scene);

}  // namespace supple::cli
