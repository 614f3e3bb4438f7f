#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "options/option_needs.hpp"
#include "supple/comparison.hpp"
#include "supple/options.hpp"
#include "supple/simulation_descriptions.hpp"

namespace supple::experiments {

/// A scene that the experiment runs.
struct Table1Scene {
  enum class Source { built_in, mixed, file };
  Source source = Source::mixed;
  std::string name;           ///< of a built-in scene, or the path of a scene file
  std::uint32_t objects = 0;  ///< of a mixed scene: pawns, fish and rabbits in equal parts
  /// Edge of the cube that reflects the objects, above 0; none: the border of the scene.
  std::optional<double> size{};
};

/// The number of objects of a mixed scene, `table1_9`.
Table1Scene mixed_scene(std::uint32_t objects, std::optional<double> size = {});
Table1Scene built_in_scene(const std::string& name);
/// A scene that is built into the program, or a scene file.
Table1Scene scene_called(const std::string& name);

/// How collisions are found. The defaults are the method of the paper.
struct Table1Method {
  std::vector<BoundingVolume> volumes{BoundingVolume::aabb, BoundingVolume::sphere};
  /// All options but the bounding volume and the threads.
  SceneOptions scene = with_method_of_2007({});
  ObjectOctreeOptions octree = octree_of_2007();  ///< of every object
  bool fused_refit = true;
  bool root_is_border = true;  ///< the root of the scene octree is the cube around the border of each scene
  std::optional<Integrator> integrator{};  ///< of every mass-spring body; none: that of the scene
};

/// Calls `visitor(field, value)` for each option of the method that has a description and that users choose,
/// except the root of the scene octree, which may be `border`.
/// `Method` is `Table1Method`, constant or not.
template <class Visitor, class Method>
void for_each_option(Visitor&& visitor, Method& method) {
  for_each_leaf(
      [&]<class Struct, class Value>(const Field<Struct, Value>& field, auto& value) {
        if constexpr (std::is_same_v<Value, std::optional<RootCube>>)
          return;
        else if constexpr (std::is_same_v<Struct, ComparisonOptions>) {
          if (std::string_view(field.name) != "colliding_vertices") visitor(field, value);
        } else if constexpr (std::is_same_v<Struct, SceneOctreeOptions> ||
                             std::is_same_v<Value, BroadPhaseMethod>)
          visitor(field, value);
      },
      method.scene);
  for_each_leaf(
      [&](const auto& field, auto& value) {
        // Octrees are never rebuilt, because the counts of the narrow phase depend on the leaves.
        if (std::string_view(field.key) != "rebuild_degraded") visitor(field, value);
      },
      method.octree);
}

/// Whether the condition is met with one of the volumes of the method.
bool is_met(const cli::OptionNeed& need, const Table1Method& method);

struct Table1Options {
  std::vector<Table1Scene> scenes;
  Table1Method method{};
  std::uint32_t runs = 5;                  ///< ≥ 1; run k has the seed `seed` + k
  double simulated_seconds = 600;          ///< per run that is counted in simulated time; 0: no such runs
  std::optional<double> program_clock{};   ///< seconds of detection and motion per run; none: no such runs
  std::optional<std::uint32_t> threads{};  ///< parallel runs in simulated time; none and 0: one per core
  std::uint64_t seed = 1;
};

/// The scenes of section 7: 3, 6 and 9 objects; 12, 20 and 30, of which its text speaks; 9 objects in a
/// smaller cube; three humans and three bikes. With `quick`, a small part of the experiment.
Table1Options default_table1_options(bool quick);

}  // namespace supple::experiments
