#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "comparison/methods.hpp"

namespace supple {
namespace {

void append_marked_vertices(const IntersectedObject& owner, std::span<const CollidingLeaves> leaves,
                            bool side_b, CollidingVertexLists& lists) {
  lists.marked.assign(owner.octree->vertex_count(), 0);
  for (const CollidingLeaves& pair : leaves) {
    const std::uint32_t begin = side_b ? pair.leaves.begin_b : pair.leaves.begin_a;
    const std::uint32_t end = side_b ? pair.leaves.end_b : pair.leaves.end_a;
    for (std::uint32_t t = begin; t < end; ++t) {
      for (const std::uint32_t vertex : owner.view.arrays.triangles[t]) lists.marked[vertex] = 1;
    }
  }
  for (std::uint32_t vertex = 0; vertex < lists.marked.size(); ++vertex) {
    if (lists.marked[vertex] != 0) lists.vertices.push_back(vertex);
  }
}

}  // namespace

void list_colliding_vertices(std::span<const ContactJob> jobs, std::span<const IntersectedObject> objects,
                             CollidingVertexLists& lists) {
  std::vector<CollidingLeaves>& leaves = lists.leaves;
  std::vector<std::uint32_t>& vertices = lists.vertices;
  // The result is a set of vertices, so the order of leaves within a job does not matter.
  std::sort(leaves.begin(), leaves.end(),
            [](const CollidingLeaves& p, const CollidingLeaves& q) { return p.job < q.job; });
  for (auto first = leaves.begin(); first != leaves.end();) {
    const std::uint32_t job = first->job;
    const auto last =
        std::find_if(first, leaves.end(), [&](const CollidingLeaves& pair) { return pair.job != job; });
    const IntersectedObject &a = objects[jobs[job].a], &b = objects[jobs[job].b];
    CollidingVertices group{a.id, b.id, static_cast<std::uint32_t>(vertices.size()), 0, 0};
    append_marked_vertices(a, {first, last}, false, lists);
    group.count_a = static_cast<std::uint32_t>(vertices.size()) - group.first_vertex;
    append_marked_vertices(b, {first, last}, true, lists);
    group.count_b = static_cast<std::uint32_t>(vertices.size()) - group.first_vertex - group.count_a;
    lists.groups.push_back(group);
    first = last;
  }
}

}  // namespace supple
