#pragma once

#include "supple/description.hpp"
#include "supple/inspection.hpp"

// Descriptions of what `SceneInspector` returns (description.hpp).

namespace supple {

template <>
inline constexpr std::array words<PairStage>{"not_tested",     "shared_vertex",  "inert",
                                             "object_volumes", "octree_volumes", "triangle_boxes",
                                             "exact_test",     "contact"};

template <>
struct Description<OctreeStatistics> : RecordDescription<OctreeStatistics> {
  static constexpr const char* name = "OctreeStatistics";
  static constexpr void fields(auto&& field) {
    field("triangles", &Row::triangles, "Triangles in the octree", {}, "triangles");
    field("vertices", &Row::vertices, "Vertices of these triangles", {}, "vertices");
    field("nodes", &Row::nodes, "Nodes of eight children", {}, "nodes");
    field("leaves", &Row::leaves, "Leaves", {}, "leaves");
    field("depth", &Row::depth, "Level of the deepest leaf; the root is level 0", {}, "levels");
    field("largest_leaf", &Row::largest_leaf, "Triangles of the largest leaf", {}, "triangles");
    field("mean_leaf_size", &Row::mean_leaf_size, "Mean triangles of a leaf", {}, "triangles");
    field("mean_node_width", &Row::mean_node_width, "Mean children of a node", {}, "children");
    field("bytes", &Row::bytes, "Memory of the octree without the positions", {}, "bytes");
    field("bytes_per_triangle", &Row::bytes_per_triangle, "The same per triangle", {}, "bytes");
    field("leaves_by_level", &Row::leaves_by_level, "Leaves of each level from the root on", {}, "leaves");
    field("cost", &Row::cost, "Mean visits of a query by the surface-area heuristic", {}, "visits");
    field("degradation", &Row::degradation, "The cost divided by the cost when the octree was built");
    field("rebuilds", &Row::rebuilds, "Rebuilds of the octree since the object was added", {}, "rebuilds");
  }
};

}  // namespace supple
