#include "octree/object_octree.hpp"

#include <hwy/cache_control.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <thread>

#include "geometry/aabb.hpp"
#include "octree/box_kernels.hpp"
#include "octree/octree_build.hpp"

namespace supple {
namespace {

constexpr std::uint32_t unnumbered = std::numeric_limits<std::uint32_t>::max();

std::vector<Vec3d> box_centers(const PositionsView<double>& positions, std::span<const Triangle> triangles) {
  std::vector<Vec3d> centers;
  centers.reserve(triangles.size());
  for (const Triangle& triangle : triangles) {
    const Vec3d p = positions[triangle[0]], q = positions[triangle[1]], r = positions[triangle[2]];
    Vec3d center;
    for (int axis = 0; axis < 3; ++axis) {
      const auto [low, high] = std::minmax({p[axis], q[axis], r[axis]});
      center[axis] = low / 2 + high / 2;
      // std::minmax loses a NaN that is not its first argument; the sum keeps it.
      if (!std::isfinite(p[axis] * 0 + q[axis] * 0 + r[axis] * 0)) center[axis] = p[axis] + q[axis] + r[axis];
    }
    centers.push_back(center);
  }
  return centers;
}

Aabb lane_box(const AabbLanes& lanes, int lane) {
  return {{lanes.min_x[lane], lanes.min_y[lane], lanes.min_z[lane]},
          {lanes.max_x[lane], lanes.max_y[lane], lanes.max_z[lane]}};
}

void set_lane(AabbLanes& lanes, int lane, const Aabb& box) {
  lanes.min_x[lane] = box.min.x;
  lanes.min_y[lane] = box.min.y;
  lanes.min_z[lane] = box.min.z;
  lanes.max_x[lane] = box.max.x;
  lanes.max_y[lane] = box.max.y;
  lanes.max_z[lane] = box.max.z;
}

void set_lane(SphereLanes& lanes, int lane, const BoundingSphere& sphere) {
  lanes.x[lane] = sphere.center.x;
  lanes.y[lane] = sphere.center.y;
  lanes.z[lane] = sphere.center.z;
  lanes.radius[lane] = sphere.radius;
}

/// The paper's eq. 3 and 4: the ball in the cube over the box's lower corner with the box's longest side.
BoundingSphere sphere_from_box(const Aabb& box) {
  if (box.empty()) return {};
  const double side =
      std::max({double{box.max.x} - box.min.x, double{box.max.y} - box.min.y, double{box.max.z} - box.min.z});
  const auto half = static_cast<float>(side / 2);
  return {{box.min.x + half, box.min.y + half, box.min.z + half}, half};
}

/// The paper's eq. 5: about the centre of the box, radius to the farthest vertex, rounded up.
BoundingSphere sphere_around(const Aabb& box, std::span<const Triangle> triangles,
                             const VertexBuffer& vertices, std::span<const std::uint8_t> inert,
                             std::uint32_t first) {
  if (box.empty()) return {};
  const auto clamped_middle = [](float low, float high) {
    constexpr double limit = std::numeric_limits<float>::max();
    return static_cast<float>(
        (std::clamp(double{low}, -limit, limit) + std::clamp(double{high}, -limit, limit)) / 2);
  };
  const Vec3f center{clamped_middle(box.min.x, box.max.x), clamped_middle(box.min.y, box.max.y),
                     clamped_middle(box.min.z, box.max.z)};
  double squared_radius = 0;
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    if (!inert.empty() && inert[first + t] != 0) continue;
    for (const std::uint32_t vertex : triangles[t]) {
      const Vec3d p = vertices[vertex];
      const double dx = p.x - center.x, dy = p.y - center.y, dz = p.z - center.z;
      squared_radius = std::max(squared_radius, dx * dx + dy * dy + dz * dz);
    }
  }
  // The factor covers the roundings of the sum and of the root, the addend squares that underflow.
  return {center, round_up(std::sqrt(squared_radius) * (1 + 0x1p-50) + std::numeric_limits<float>::min())};
}

}  // namespace

TriangleArrays arrays_of(std::span<const Triangle> triangles, const VertexBuffer& vertices,
                         std::span<const std::uint8_t> inert) {
  return {triangles.data(), vertices.is_double() ? nullptr : vertices.floats(),
          vertices.is_double() ? vertices.doubles() : nullptr, inert.empty() ? nullptr : inert.data()};
}

ObjectOctree::ObjectOctree(const PositionsView<double>& rest_positions, std::span<const Triangle> triangles,
                           const ObjectOctreeOptions& options, BoundingVolume bounding_volume,
                           SphereFit sphere_fit)
    : sphere_fit_(sphere_fit), arity_(options.arity) {
  OctreeTopology topology = build_octree(box_centers(rest_positions, triangles), options);
  nodes_ = std::move(topology.nodes);
  nodes_.shrink_to_fit();
  level_begin_ = std::move(topology.level_begin);
  triangle_ids_ = std::move(topology.order);
  boxes_.resize(nodes_.size());
  if (bounding_volume == BoundingVolume::sphere) spheres_.resize(nodes_.size());

  vertex_order_.assign(rest_positions.count, unnumbered);
  vertex_ids_.reserve(rest_positions.count);
  const auto number = [&](std::uint32_t user_vertex) {
    if (vertex_order_[user_vertex] == unnumbered) {
      vertex_order_[user_vertex] = static_cast<std::uint32_t>(vertex_ids_.size());
      vertex_ids_.push_back(user_vertex);
    }
    return vertex_order_[user_vertex];
  };
  triangles_.reserve(triangles.size());
  for (const std::uint32_t id : triangle_ids_) {
    const Triangle& triangle = triangles[id];
    const std::uint32_t p = number(triangle[0]), q = number(triangle[1]), r = number(triangle[2]);
    triangles_.push_back({p, q, r});
  }
  for (std::uint32_t vertex = 0; vertex < rest_positions.count; ++vertex) number(vertex);
  if (!spheres_.empty()) return;
  subtrees_ = Subtrees(nodes_, triangles_);
  subtree_states_ = std::make_unique<std::atomic<std::uint8_t>[]>(subtrees_.size());
}

void ObjectOctree::refit(const VertexBuffer& vertices, std::span<const std::uint8_t> inert,
                         const Parallel& parallel) {
  box_ = Aabb{};
  sphere_ = BoundingSphere{};
  if (nodes_.empty()) return;
  for (std::size_t s = 0; s < subtrees_.size(); ++s)
    subtree_states_[s].store(is_fresh, std::memory_order_relaxed);
  for (std::size_t level = level_begin_.size() - 1; level-- > 0;) {
    refit_level(static_cast<std::uint32_t>(level), vertices, inert, parallel);
  }
  box_ = box_of_lanes(boxes_[0]);
  if (spheres_.empty()) return;
  sphere_ = sphere_fit_ == SphereFit::box ? sphere_from_box(box_)
                                          : sphere_around(box_, triangles_, vertices, inert, 0);
}

void ObjectOctree::refit_lazily(const VertexBuffer& vertices, const Parallel& parallel) {
  box_ = Aabb{};
  if (nodes_.empty()) return;
  const TriangleArrays arrays = arrays_of(triangles_, vertices, {});
  parallel.for_ranges(subtrees_.size(), 64, [&](std::size_t begin, std::size_t end, std::uint32_t) {
    for (std::size_t s = begin; s < end; ++s) {
      const Subtree& subtree = subtrees_[s];
      const Aabb box = box_of_vertices(arrays, subtrees_.vertex_begin(s), subtrees_.vertex_end(s),
                                       subtrees_.shared_vertices(s));
      if (subtree.parent == Subtree::none) {
        box_ = box;
      } else {
        set_lane(boxes_[subtree.parent], subtree.lane, box);
      }
      subtree_states_[s].store(subtree.root == Subtree::none ? is_fresh : is_stale,
                               std::memory_order_relaxed);
    }
  });
  const auto top_nodes = subtrees_.top_nodes();
  for (auto n = top_nodes.rbegin(); n != top_nodes.rend(); ++n) {
    const OctreeNode& node = nodes_[*n];
    for (int lane = node.lane_count; lane < node_width; ++lane) set_lane(boxes_[*n], lane, Aabb{});
    const Aabb box = box_of_lanes(boxes_[*n]);
    if (*n == 0) {
      box_ = box;
    } else {
      set_lane(boxes_[node.parent], node.parent_lane, box);
    }
  }
}

/// The first thread to come does it, others that need the subtree wait for it: a microsecond or two.
void ObjectOctree::refresh_subtree(std::uint32_t subtree, const TriangleArrays& arrays) const {
  std::atomic<std::uint8_t>& state = subtree_states_[subtree];
  std::uint8_t seen = is_stale;
  if (state.compare_exchange_strong(seen, in_work, std::memory_order_acquire)) {
    fetch_ahead(subtree, arrays);
    refit_subtree(subtrees_[subtree].root, arrays);
    state.store(is_fresh, std::memory_order_release);
    return;
  }
#if !defined(SUPPLE_SERIAL)
  while (state.load(std::memory_order_acquire) != is_fresh) std::this_thread::yield();
#endif
}

/// What a subtree is refitted from lies in two or three places in memory, long out of the cache.
void ObjectOctree::fetch_ahead(std::uint32_t subtree, const TriangleArrays& arrays) const {
  constexpr std::size_t line = 64;
  const auto fetch = [](const void* begin, const void* end) {
    for (auto at = static_cast<const char*>(begin); at < static_cast<const char*>(end); at += line) {
      hwy::Prefetch(at);
    }
  };
  const OctreeNode& root = nodes_[subtrees_[subtree].root];
  const std::size_t vertex_begin = subtrees_.vertex_begin(subtree) * std::size_t{4};
  const std::size_t vertex_end = subtrees_.vertex_end(subtree) * std::size_t{4};
  fetch(arrays.triangles + root.first_triangle[0], arrays.triangles + root.first_triangle[node_width]);
  if (arrays.doubles != nullptr) {
    fetch(arrays.doubles + vertex_begin, arrays.doubles + vertex_end);
  } else {
    fetch(arrays.floats + vertex_begin, arrays.floats + vertex_end);
  }
}

/// Deepest level first. The nodes of a subtree that are of one level follow each other, as their parents do.
void ObjectOctree::refit_subtree(std::uint32_t root, const TriangleArrays& arrays) const {
  std::array<std::uint32_t, 128> begin, end;  // more than there are levels below any node
  std::size_t levels = 0;
  for (std::uint32_t first = root, last = root + 1; first < last;) {
    begin[levels] = first;
    end[levels++] = last;
    const OctreeNode& last_node = nodes_[last - 1];
    first = nodes_[first].first_child;
    last = last_node.first_child + static_cast<std::uint32_t>(std::popcount(last_node.inner_mask));
  }
  while (levels-- > 0) refit_boxes(nodes_.data(), boxes_.data(), arrays, begin[levels], end[levels], root);
}

void ObjectOctree::refit_level(std::uint32_t level, const VertexBuffer& vertices,
                               std::span<const std::uint8_t> inert, const Parallel& parallel) {
  const TriangleArrays arrays = arrays_of(triangles_, vertices, inert);
  const std::uint32_t first = level_begin_[level];
  parallel.for_ranges(
      level_begin_[level + 1] - first, 512, [&](std::size_t begin, std::size_t end, std::uint32_t) {
        const auto node_begin = static_cast<std::uint32_t>(first + begin);
        const auto node_end = static_cast<std::uint32_t>(first + end);
        refit_boxes(nodes_.data(), boxes_.data(), arrays, node_begin, node_end, 0);
        if (spheres_.empty()) return;
        for (std::uint32_t n = node_begin; n < node_end; ++n) {
          const OctreeNode& node = nodes_[n];
          for (int lane = 0; lane < node_width; ++lane) {
            const Aabb box = lane_box(boxes_[n], lane);
            const std::uint32_t begin_t = node.first_triangle[lane];
            const std::uint32_t count = lane < node.lane_count ? node.first_triangle[lane + 1] - begin_t : 0;
            set_lane(spheres_[n], lane,
                     sphere_fit_ == SphereFit::box
                         ? sphere_from_box(box)
                         : sphere_around(box, std::span<const Triangle>(triangles_).subspan(begin_t, count),
                                         vertices, inert, begin_t));
          }
        }
      });
}

}  // namespace supple
