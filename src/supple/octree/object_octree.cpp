#include "octree/object_octree.hpp"

#include <algorithm>
#include <atomic>
#include <limits>
#include <numeric>
#include <string>
#include <utility>

#include "geometry/aabb.hpp"
#include "geometry/vector.hpp"
#include "octree/build/balanced_build.hpp"
#include "octree/comparison_methods.hpp"
#include "octree/octree_topology.hpp"
#include "octree/volumes/box_kernels.hpp"
#include "supple/option_descriptions.hpp"

namespace supple {
namespace {

constexpr std::uint32_t unnumbered = std::numeric_limits<std::uint32_t>::max();

constexpr std::size_t triangles_of_a_task = 4096;  // triangles

std::vector<Vec3d> box_centers(const PositionsView& positions, std::span<const Triangle> triangles,
                               const Parallel& parallel) {
  std::vector<Vec3d> centers(triangles.size());
  parallel.for_ranges(triangles.size(), triangles_of_a_task,
                      [&](std::size_t begin, std::size_t end, std::uint32_t) {
                        for (std::size_t t = begin; t < end; ++t) {
                          const Vec3d p = positions[triangles[t][0]], q = positions[triangles[t][1]],
                                      r = positions[triangles[t][2]];
                          for (int axis = 0; axis < 3; ++axis) {
                            const double low = std::min(std::min(p[axis], q[axis]), r[axis]);
                            const double high = std::max(std::max(p[axis], q[axis]), r[axis]);
                            // A minimum can lose a NaN; the sum keeps it.
                            centers[t][axis] = low / 2 + high / 2 + (p[axis] * 0 + q[axis] * 0 + r[axis] * 0);
                          }
                        }
                      });
  return centers;
}

OctreeTopology build_topology(const PositionsView& positions, std::span<const Triangle> triangles,
                              const ObjectOctreeOptions& options, const Parallel& parallel) {
  const std::vector<Vec3d> centers = box_centers(positions, triangles, parallel);
  if (options.build == ObjectOctreeBuild::balanced)
    return build_balanced_octree(centers, triangles, options, parallel);
  return comparison_methods(std::string("the octree build ") + word_of(options.build))
      .octree(positions, triangles, centers, options);
}

}  // namespace

TriangleArrays arrays_of(std::span<const Triangle> triangles, const VertexBuffer& vertices,
                         std::span<const std::uint8_t> inert) {
  return {triangles.data(), vertices.floats(), vertices.doubles(), inert.empty() ? nullptr : inert.data()};
}

ObjectOctree::ObjectOctree(const PositionsView& rest_positions, std::span<const Triangle> triangles,
                           const ObjectOctreeOptions& options, BoundingVolume bounding_volume,
                           SphereFit sphere_fit, const Parallel& parallel, std::span<const std::uint32_t> ids,
                           std::size_t id_count)
    : vertex_count_(rest_positions.size()),
      options_(options),
      bounding_volume_(bounding_volume),
      sphere_fit_(sphere_fit) {
  OctreeTopology topology = build_topology(rest_positions, triangles, options, parallel);
  nodes_ = std::move(topology.nodes);
  nodes_.shrink_to_fit();
  level_begin_ = std::move(topology.level_begin);
  cell_numbers_ = std::move(topology.numbers);
  triangle_ids_ = std::move(topology.order);
  boxes_.resize(nodes_.size());
  triangles_.resize(triangles.size());
  triangle_order_.resize(std::max(triangles.size(), id_count), no_place);
  parallel.for_ranges(triangles.size(), triangles_of_a_task,
                      [&](std::size_t begin, std::size_t end, std::uint32_t) {
                        for (std::size_t t = begin; t < end; ++t) {
                          triangles_[t] = triangles[triangle_ids_[t]];
                          if (!ids.empty()) triangle_ids_[t] = ids[triangle_ids_[t]];
                          triangle_order_[triangle_ids_[t]] = static_cast<std::uint32_t>(t);
                        }
                      });
  list_leaf_vertices(parallel);
  if (bounding_volume == BoundingVolume::aabb) return;
  list_unused_vertices();
  volumes_ = comparison_methods(std::string("the bounding volume ") + word_of(bounding_volume))
                 .node_volumes(bounding_volume, sphere_fit, *this, rest_positions);
}

void ObjectOctree::list_leaf_vertices(const Parallel& parallel) {
  struct Place {
    std::uint32_t leaf, place;
  };
  std::vector<std::vector<Place>> last_places(parallel.worker_count());
  // Each leaf has room for the corners of its triangles, because their number of vertices is not known yet.
  std::vector<std::uint32_t> vertices(3 * triangles_.size()), counts(nodes_.size() * node_width, 0);
  const std::size_t stride = triangles_.size();
  leaf_corners_.assign(3 * stride + corners_ahead, 0);
  const auto for_leaves = [&](const auto& body) {
    parallel.for_ranges(nodes_.size(), 64, [&](std::size_t begin, std::size_t end, std::uint32_t worker) {
      for (std::size_t n = begin; n < end; ++n) {
        const OctreeNode& node = nodes_[n];
        for (int child = 0; child < node.child_count; ++child) {
          if (!node.is_inner(child))
            body(n * node_width + static_cast<std::size_t>(child), node.first_triangle[child],
                 node.first_triangle[child + 1], worker);
        }
      }
    });
  };
  for_leaves([&](std::size_t leaf, std::uint32_t begin, std::uint32_t end, std::uint32_t worker) {
    std::vector<Place>& last_of_worker = last_places[worker];
    if (last_of_worker.empty()) last_of_worker.assign(vertex_count_, {unnumbered, 0});
    std::uint32_t* const found = vertices.data() + 3 * std::size_t{begin};
    std::uint32_t count = 0;
    for (std::uint32_t t = begin; t < end; ++t) {
      for (std::size_t corner = 0; corner < 3; ++corner) {
        const std::uint32_t vertex = triangles_[t][corner];
        Place& last = last_of_worker[vertex];
        if (last.leaf != leaf) {
          last = {static_cast<std::uint32_t>(leaf), count};
          found[count++] = vertex;
        }
        leaf_corners_[corner * stride + t] = static_cast<std::uint8_t>(last.place);
      }
    }
    counts[leaf] = count;
  });
  first_leaf_vertex_.reserve(counts.size() + 1);
  std::uint32_t total = 0;
  for (const std::uint32_t count : counts) {
    first_leaf_vertex_.push_back(total);
    constexpr auto step = static_cast<std::uint32_t>(leaf_vertices_step);
    total += (count + step - 1) / step * step;
  }
  first_leaf_vertex_.push_back(total);
  leaf_vertices_.resize(total + (total < leaf_vertices_ahead ? 0 : leaf_vertices_ahead), 0);
  for_leaves([&](std::size_t leaf, std::uint32_t begin, std::uint32_t, std::uint32_t) {
    const std::uint32_t* const found = vertices.data() + 3 * std::size_t{begin};
    std::uint32_t* const end = std::copy_n(found, counts[leaf], &leaf_vertices_[first_leaf_vertex_[leaf]]);
    std::fill(end, leaf_vertices_.data() + first_leaf_vertex_[leaf + 1], found[counts[leaf] - 1]);
  });
}

void ObjectOctree::list_unused_vertices() {
  std::vector<std::uint8_t> is_used(vertex_count_, 0);
  for (const Triangle& triangle : triangles_) {
    for (const std::uint32_t vertex : triangle) is_used[vertex] = 1;
  }
  unused_vertices_.clear();
  for (std::uint32_t vertex = 0; vertex < vertex_count_; ++vertex) {
    if (is_used[vertex] == 0) unused_vertices_.push_back(vertex);
  }
}

bool ObjectOctree::refit(const VertexBuffer& vertices, std::span<const std::uint8_t> inert,
                         const Parallel& parallel) {
  std::atomic<bool> all_finite = true;
  const TriangleArrays arrays = arrays_of(triangles_, vertices, inert);
  for_nodes_bottom_up(parallel, 64, [&](std::uint32_t begin, std::uint32_t end) {
    if (!all_finite) return;
    if (!refit_boxes(nodes_.data(), boxes_.data(), arrays, leaf_vertices(), begin, end)) all_finite = false;
    if (all_finite && volumes_) volumes_->refit(refitted(vertices, inert), begin, end);
  });
  box_ = nodes_.empty() ? Aabb{} : enclosing_box(boxes_[0]);
  if (all_finite && volumes_ && !nodes_.empty()) volumes_->refit_object(refitted(vertices, inert), box_);
  return all_finite;
}

std::optional<std::size_t> ObjectOctree::refit_moved(const VertexBuffer& vertices,
                                                     std::span<const std::uint32_t> moved,
                                                     const Parallel& parallel) {
  if (!std::all_of(moved.begin(), moved.end(), [&](std::uint32_t v) { return is_finite(vertices[v]); }))
    return std::nullopt;
  if (!moved_) list_nodes_of_vertices();
  MovedVertices& lists = *moved_;
  std::vector<std::uint32_t>& stale = lists.stale;
  stale.clear();
  for (const std::uint32_t vertex : moved) {
    for (std::uint32_t i = lists.first[vertex]; i < lists.first[vertex + 1]; ++i) {
      for (std::uint32_t node = lists.nodes[i]; std::exchange(lists.is_stale[node], std::uint8_t{1}) == 0;
           node = nodes_[node].parent)
        stale.push_back(node);
    }
  }
  std::sort(stale.begin(), stale.end());
  for (const std::uint32_t node : stale) lists.is_stale[node] = 0;
  const TriangleArrays arrays = arrays_of(triangles_, vertices, {});
  std::atomic<bool> all_finite = true;
  std::size_t triangles = 0;
  for (std::size_t end = stale.size(), begin = end; end > 0; end = begin) {
    const std::uint32_t level_begin = level_begin_[nodes_[stale[end - 1]].level];
    while (begin > 0 && stale[begin - 1] >= level_begin) --begin;
    parallel.for_ranges(end - begin, 16, [&](std::size_t first, std::size_t last, std::uint32_t) {
      for (std::size_t i = begin + first; i < begin + last; ++i) {
        const std::uint32_t n = stale[i];
        if (!refit_boxes(nodes_.data(), boxes_.data(), arrays, leaf_vertices(), n, n + 1)) all_finite = false;
        if (all_finite && volumes_) volumes_->refit(refitted(vertices, {}), n, n + 1);
      }
    });
    for (std::size_t i = begin; i < end; ++i) {
      const OctreeNode& node = nodes_[stale[i]];
      for (int child = 0; child < node.child_count; ++child)
        triangles += node.is_inner(child) ? 0 : node.size(child);
    }
  }
  if (!all_finite) return std::nullopt;
  if (stale.empty()) return triangles;
  box_ = enclosing_box(boxes_[0]);
  if (volumes_) volumes_->refit_object(refitted(vertices, {}), box_);
  return triangles;
}

void ObjectOctree::list_nodes_of_vertices() {
  MovedVertices lists;
  lists.is_stale.assign(nodes_.size(), 0);
  lists.stale.reserve(nodes_.size());
  lists.first.assign(vertex_count_ + 1, 0);
  const auto for_each_leaf_vertex = [&](const auto& function) {
    for (std::uint32_t n = 0; n < nodes_.size(); ++n) {
      const std::uint32_t* const first = &first_leaf_vertex_[std::size_t{n} * node_width];
      for (std::uint32_t i = first[0]; i < first[node_width]; ++i) function(leaf_vertices_[i], n);
    }
  };
  for_each_leaf_vertex([&](std::uint32_t vertex, std::uint32_t) { ++lists.first[vertex + 1]; });
  std::partial_sum(lists.first.begin(), lists.first.end(), lists.first.begin());
  lists.nodes.resize(lists.first.back());
  std::vector<std::uint32_t> next(lists.first.begin(), lists.first.end() - 1);
  for_each_leaf_vertex([&](std::uint32_t vertex, std::uint32_t n) { lists.nodes[next[vertex]++] = n; });
  moved_ = std::make_unique<MovedVertices>(std::move(lists));
}

std::size_t ObjectOctree::bytes() const {
  return nodes_.capacity() * sizeof(OctreeNode) + boxes_.capacity() * sizeof(ChildBoxes) +
         (volumes_ ? volumes_->bytes() : 0) + triangles_.capacity() * sizeof(Triangle) +
         (triangle_ids_.capacity() + triangle_order_.capacity() + level_begin_.capacity() +
          first_leaf_vertex_.capacity() + leaf_vertices_.capacity() + unused_vertices_.capacity() +
          (moved_ ? moved_->first.capacity() + moved_->nodes.capacity() + moved_->stale.capacity() : 0)) *
             sizeof(std::uint32_t) +
         (moved_ ? moved_->is_stale.capacity() : 0) + cell_numbers_.capacity() * sizeof(std::uint64_t) +
         leaf_corners_.capacity() + is_current_.capacity();
}

}  // namespace supple
