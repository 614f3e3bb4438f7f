#pragma once

#include <cstdint>
#include <optional>
#include <vector>

namespace supple::viewer {

/// What a page asked frames to have besides positions, pairs, contacts and statistics.
struct Layers {
  bool candidates = false;
  bool scene_regions = false;
  bool colliding_vertices = false;
  std::vector<std::uint32_t> octree_objects{};  ///< whose octrees, ascending
  std::optional<std::uint32_t> octree_level{};  ///< nothing: the leaves

  bool operator==(const Layers&) const = default;
};

}  // namespace supple::viewer
