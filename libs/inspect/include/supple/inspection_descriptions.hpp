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
struct Description<OctreeStatistics> {
  static constexpr const char* name = "OctreeStatistics";
  template <class Visitor>
  static constexpr void visit(Visitor&& visitor) {
    using Stats = OctreeStatistics;
    const auto value = [&]<class Value>(const char* field, Value Stats::*member, const char* unit,
                                        const char* doc) {
      visitor(Field<Stats, Value>{.name = field, .member = member, .doc = doc, .unit = unit});
    };
    value("triangles", &Stats::triangles, "triangles", "Triangles in the octree");
    value("vertices", &Stats::vertices, "vertices", "Vertices of these triangles");
    value("nodes", &Stats::nodes, "nodes", "Nodes of eight children");
    value("leaves", &Stats::leaves, "leaves", "Leaves");
    value("depth", &Stats::depth, "levels", "Level of the deepest leaf; the root is level 0");
    value("largest_leaf", &Stats::largest_leaf, "triangles", "Triangles of the largest leaf");
    value("mean_leaf_size", &Stats::mean_leaf_size, "triangles", "Mean triangles of a leaf");
    value("mean_node_width", &Stats::mean_node_width, "children", "Mean children of a node");
    value("bytes", &Stats::bytes, "bytes", "Memory of the octree without the positions");
    value("bytes_per_triangle", &Stats::bytes_per_triangle, "bytes", "The same per triangle");
    value("leaves_by_level", &Stats::leaves_by_level, "leaves", "Leaves of each level from the root on");
    value("cost", &Stats::cost, "visits", "Mean visits of a query by the surface-area heuristic");
    value("degradation", &Stats::degradation, "", "The cost divided by the cost when the octree was built");
    value("rebuilds", &Stats::rebuilds, "rebuilds", "Rebuilds of the octree since the object was added");
  }
};

}  // namespace supple
