#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace supple::viewer {

/// What a page asked frames to have besides positions, pairs, contacts and statistics.
struct Layers {
  bool candidates = false;
  bool scene_regions = false;
  bool colliding_vertices = false;
  std::vector<std::uint32_t> octree_objects{};  ///< whose octrees, ascending
  std::optional<std::uint32_t> octree_level{};  ///< nothing: the leaves
};

/// Those that are asked for, as the protocol calls them.
inline std::vector<std::string> layer_names(const Layers& layers) {
  std::vector<std::string> names;
  if (layers.candidates) names.emplace_back("candidates");
  if (layers.scene_regions) names.emplace_back("scene_regions");
  if (layers.colliding_vertices) names.emplace_back("colliding_vertices");
  if (!layers.octree_objects.empty()) names.emplace_back("octree");
  return names;
}

}  // namespace supple::viewer
