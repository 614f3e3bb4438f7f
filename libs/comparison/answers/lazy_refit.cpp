#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "comparison/methods.hpp"
#include "comparison/volumes/volume_kernels.hpp"
#include "geometry/aabb.hpp"
#include "geometry/vector.hpp"
#include "narrow_phase/query_kernels.hpp"

namespace supple {
namespace {

/// The bounds of finite points, rounded outward.
Aabb rounded(const QueryBox& bounds) {
  Aabb box;
  if (!(bounds.min.x <= bounds.max.x)) return box;
  extend(box, bounds.min);
  extend(box, bounds.max);
  return box;
}

}  // namespace

bool LazyRefit::refit_object(ObjectOctree& octree, const VertexBuffer& vertices,
                             const std::optional<Aabb>& box) {
  if (octree.nodes_.empty()) return true;
  if (octree.is_current_.empty()) octree.list_unused_vertices();
  octree.is_current_.assign(octree.nodes_.size(), 0);
  QueryBox bounds = no_box();
  bool all_finite = true;
  const auto add = [&](std::uint32_t vertex) {
    const Vec3d p = vertices[vertex];
    all_finite = all_finite && is_finite(p);
    extend(bounds, p, p);
  };
  if (!box || !octree.unused_vertices_.empty()) {
    for_each_used_vertex(vertices, octree.unused_vertices_, add);
    for (const std::uint32_t vertex : octree.unused_vertices_)
      all_finite = all_finite && is_finite(vertices[vertex]);
  }
  octree.box_ = box && octree.unused_vertices_.empty() ? *box : rounded(bounds);
  if (all_finite && octree.volumes_)
    octree.volumes_->refit_object(octree.refitted(vertices, {}, false), octree.box_);
  return all_finite;
}

std::size_t LazyRefit::refit_children(ObjectOctree& octree, std::uint32_t n, const VertexBuffer& vertices) {
  if (std::exchange(octree.is_current_[n], std::uint8_t{1}) != 0) return 0;
  const OctreeNode& node = octree.nodes_[n];
  for (int child = 0; child < node_width; ++child) {
    QueryBox bounds = no_box();
    for (std::uint32_t t = node.first_triangle[child]; t < node.first_triangle[child + 1]; ++t) {
      for (const std::uint32_t vertex : octree.triangles_[t])
        extend(bounds, vertices[vertex], vertices[vertex]);
    }
    set_child_box(octree.boxes_[n], child, rounded(bounds));
  }
  if (octree.volumes_) octree.volumes_->refit(octree.refitted(vertices, {}, false), n, n + 1);
  return node.size();
}

std::uint64_t LazyRefit::refit_where_objects_meet(const World& world, std::span<const ContactJob> jobs,
                                                  std::vector<NodePair>& node_pairs,
                                                  std::vector<ChildPair>& children) {
  std::uint64_t triangles = 0;
  for (const ContactJob& job : jobs) {
    WorldObject &a = world[job.a], &b = world[job.b];
    if (job.a == job.b || a.octree().nodes().empty() || b.octree().nodes().empty()) continue;
    const ObjectPairView pair = pair_of(a.resting_view(), b.resting_view());
    for (node_pairs.assign(1, {}); !node_pairs.empty();) {
      const NodePair at = node_pairs.back();
      node_pairs.pop_back();
      triangles += a.update_children(at.a) + b.update_children(at.b);
      children.clear();
      find_overlapping_children(pair, at, children);
      for (const ChildPair& both : children) {
        if (const auto below = nodes_below(pair, both)) node_pairs.push_back(*below);
      }
    }
  }
  return triangles;
}

}  // namespace supple
