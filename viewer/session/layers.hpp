#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

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
};

/// The requested layers by their names in the protocol.
inline std::vector<std::string> layer_names(const Layers& layers) {
  std::vector<std::string> names;
  if (layers.candidates) names.emplace_back("candidates");
  if (layers.scene_regions) names.emplace_back("scene_regions");
  if (layers.colliding_vertices) names.emplace_back("colliding_vertices");
  if (!layers.octree_objects.empty()) names.emplace_back("octree");
  if (layers.colliding_nodes) names.emplace_back("colliding_nodes");
  return names;
}

}  // namespace supple::viewer
