#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace supple::viewer {

/// The data that the page requests in addition to positions, pairs, contacts and statistics.
struct Layers {
  bool candidates = false;
  bool scene_regions = false;
  bool colliding_vertices = false;
  std::vector<std::uint32_t> octree_objects{};  ///< objects whose octrees are sent, ascending
  std::optional<std::uint32_t> octree_level{};  ///< empty: the leaves
};

/// The requested layers by their names in the protocol.
inline std::vector<std::string> layer_names(const Layers& layers) {
  std::vector<std::string> names;
  if (layers.candidates) names.emplace_back("candidates");
  if (layers.scene_regions) names.emplace_back("scene_regions");
  if (layers.colliding_vertices) names.emplace_back("colliding_vertices");
  if (!layers.octree_objects.empty()) names.emplace_back("octree");
  return names;
}

}  // namespace supple::viewer
