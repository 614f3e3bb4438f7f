#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "arguments.hpp"
#include "fields/field_forms.hpp"
#include "scene_view.hpp"

namespace supple::viewer {

/// The nodes of octrees that collide in the narrow phase.
struct CollidingNodes {
  static constexpr std::int64_t leaves = -1, all_levels = -2;
  std::optional<std::array<std::uint32_t, 2>> objects{};  ///< empty: all pairs of different objects
  std::int64_t level = leaves;                            ///< of `NodePairList`, or one of the constants
};

/// The data that the page requests in addition to positions, pairs, contacts and statistics.
struct Layers {
  bool candidates = false;
  bool scene_regions = false;
  bool colliding_vertices = false;
  std::vector<std::uint32_t> octree_objects{};  ///< objects whose octrees are sent, ascending
  std::optional<std::uint32_t> octree_level{};  ///< empty: the leaves
  std::optional<CollidingNodes> colliding_nodes{};
  std::string field{};  ///< the key of a `FieldForm`; empty for none
};

/// The requested layers by their names in the protocol.
std::vector<std::string> layer_names(const Layers& layers);

/// The layers after the command `layers`, which changes those that it names; empty after an error. `fields`
/// are those that the scene offers.
std::optional<Layers> read_layers(Layers layers, const SceneView& scene, const std::vector<FieldForm>& fields,
                                  Arguments& arguments);

/// Removes objects from `count` on.
void keep_objects(Layers& layers, std::size_t count);

}  // namespace supple::viewer
