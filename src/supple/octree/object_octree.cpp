#include "octree/object_octree.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <utility>

#include "geometry/aabb.hpp"
#include "geometry/vector.hpp"
#include "octree/balanced_build.hpp"
#include "octree/box_kernels.hpp"
#include "octree/regular_build.hpp"

namespace supple {
namespace {

constexpr std::uint32_t unnumbered = std::numeric_limits<std::uint32_t>::max();

std::vector<Vec3d> box_centers(const PositionsView& positions, std::span<const Triangle> triangles) {
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

/// Balanced octrees have eight children per node; other arities are regular.
OctreeTopology build_topology(const PositionsView& positions, std::span<const Triangle> triangles,
                              const ObjectOctreeOptions& options) {
  const std::vector<Vec3d> centers = box_centers(positions, triangles);
  return options.regular || options.arity != 8 ? build_regular_octree(centers, options)
                                               : build_balanced_octree(centers, triangles, options);
}

void set_child(ChildSpheres& spheres, int child, const BoundingSphere& sphere) {
  spheres.x[child] = sphere.center.x;
  spheres.y[child] = sphere.center.y;
  spheres.z[child] = sphere.center.z;
  spheres.radius[child] = sphere.radius;
}

/// The paper's equations 3 and 4: the sphere inside the cube that has the lower corner and the longest side
/// of the box.
BoundingSphere sphere_from_box(const Aabb& box) {
  if (box.empty()) return {};
  const double side =
      std::max({double{box.max.x} - box.min.x, double{box.max.y} - box.min.y, double{box.max.z} - box.min.z});
  const auto half = static_cast<float>(side / 2);
  return {{box.min.x + half, box.min.y + half, box.min.z + half}, half};
}

/// The paper's equation 5: around the centre of the box, with the distance of the farthest vertex as radius,
/// rounded up.
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
  // The factor covers the rounding of the sum and the root; the addend covers squares that underflow.
  return {center, round_up(std::sqrt(squared_radius) * (1 + 0x1p-50) + std::numeric_limits<float>::min())};
}

}  // namespace

TriangleArrays arrays_of(std::span<const Triangle> triangles, const VertexBuffer& vertices,
                         std::span<const std::uint8_t> inert) {
  return {triangles.data(), vertices.floats(), vertices.doubles(), inert.empty() ? nullptr : inert.data()};
}

ObjectOctree::ObjectOctree(const PositionsView& rest_positions, std::span<const Triangle> triangles,
                           const ObjectOctreeOptions& options, BoundingVolume bounding_volume,
                           SphereFit sphere_fit)
    : vertex_count_(rest_positions.size()), options_(options), sphere_fit_(sphere_fit) {
  OctreeTopology topology = build_topology(rest_positions, triangles, options);
  nodes_ = std::move(topology.nodes);
  nodes_.shrink_to_fit();
  level_begin_ = std::move(topology.level_begin);
  triangle_ids_ = std::move(topology.order);
  boxes_.resize(nodes_.size());
  if (bounding_volume == BoundingVolume::sphere) spheres_.resize(nodes_.size());
  triangles_.reserve(triangles.size());
  for (const std::uint32_t id : triangle_ids_) triangles_.push_back(triangles[id]);
  triangle_order_.resize(triangle_ids_.size());
  for (std::uint32_t t = 0; t < triangle_ids_.size(); ++t) triangle_order_[triangle_ids_[t]] = t;
  list_leaf_vertices();
}

ObjectOctree ObjectOctree::rebuilt(const PositionsView& positions) const {
  std::vector<Triangle> user_triangles;
  user_triangles.reserve(triangles_.size());
  for (const std::uint32_t t : triangle_order_) user_triangles.push_back(triangles_[t]);
  const BoundingVolume volume = spheres_.empty() ? BoundingVolume::aabb : BoundingVolume::sphere;
  return ObjectOctree(positions, user_triangles, options_, volume, sphere_fit_);
}

void ObjectOctree::list_leaf_vertices() {
  struct Place {
    std::uint32_t leaf, place;
  };
  std::vector<Place> last_places(vertex_count_, {unnumbered, 0});
  first_leaf_vertex_.clear();
  leaf_vertices_.clear();
  unused_vertices_.clear();
  first_leaf_vertex_.reserve(nodes_.size() * node_width + 1);
  leaf_vertices_.reserve(triangles_.size());
  const std::size_t stride = triangles_.size() + corners_ahead;
  leaf_corners_.assign(3 * stride, 0);
  for (const OctreeNode& node : nodes_) {
    for (int child = 0; child < node_width; ++child) {
      const auto leaf = static_cast<std::uint32_t>(first_leaf_vertex_.size());
      const auto first = static_cast<std::uint32_t>(leaf_vertices_.size());
      first_leaf_vertex_.push_back(first);
      if (child >= node.child_count || node.is_inner(child)) continue;
      for (std::uint32_t t = node.first_triangle[child]; t < node.first_triangle[child + 1]; ++t) {
        for (std::size_t corner = 0; corner < 3; ++corner) {
          const std::uint32_t vertex = triangles_[t][corner];
          Place& last = last_places[vertex];
          if (last.leaf != leaf) {
            last = {leaf, static_cast<std::uint32_t>(leaf_vertices_.size()) - first};
            leaf_vertices_.push_back(vertex);
          }
          leaf_corners_[corner * stride + t] = static_cast<std::uint8_t>(last.place);
        }
      }
      while (leaf_vertices_.size() % leaf_vertices_step != 0) leaf_vertices_.push_back(leaf_vertices_.back());
    }
  }
  first_leaf_vertex_.push_back(static_cast<std::uint32_t>(leaf_vertices_.size()));
  leaf_vertices_.resize(leaf_vertices_.size() + leaf_vertices_ahead, 0);
  leaf_vertices_.shrink_to_fit();
  for (std::uint32_t vertex = 0; vertex < vertex_count_; ++vertex) {
    if (last_places[vertex].leaf == unnumbered) unused_vertices_.push_back(vertex);
  }
  unused_vertices_.shrink_to_fit();
}

bool ObjectOctree::refit(const VertexBuffer& vertices, std::span<const std::uint8_t> inert,
                         const Parallel& parallel) {
  std::atomic<bool> all_finite =
      !inert.empty() || std::all_of(unused_vertices_.begin(), unused_vertices_.end(),
                                    [&](std::uint32_t vertex) { return is_finite(vertices[vertex]); });
  const TriangleArrays arrays = arrays_of(triangles_, vertices, inert);
  for_nodes_bottom_up(parallel, 64, [&](std::uint32_t begin, std::uint32_t end) {
    if (!all_finite) return;
    if (!refit_boxes(nodes_.data(), boxes_.data(), arrays, leaf_vertices(), begin, end)) all_finite = false;
    if (all_finite && !spheres_.empty()) refit_spheres(begin, end, vertices, inert);
  });
  sphere_ = BoundingSphere{};
  if (all_finite && !spheres_.empty()) {
    sphere_ = sphere_fit_ == SphereFit::box ? sphere_from_box(box())
                                            : sphere_around(box(), triangles_, vertices, inert, 0);
  }
  return all_finite;
}

void ObjectOctree::refit_spheres(std::uint32_t node_begin, std::uint32_t node_end,
                                 const VertexBuffer& vertices, std::span<const std::uint8_t> inert) {
  for (std::uint32_t n = node_begin; n < node_end; ++n) {
    const OctreeNode& node = nodes_[n];
    for (int child = 0; child < node_width; ++child) {
      const Aabb box = child_box(boxes_[n], child);
      const std::uint32_t begin = node.first_triangle[child];
      const std::uint32_t count = child < node.child_count ? node.first_triangle[child + 1] - begin : 0;
      set_child(spheres_[n], child,
                sphere_fit_ == SphereFit::box
                    ? sphere_from_box(box)
                    : sphere_around(box, std::span<const Triangle>(triangles_).subspan(begin, count),
                                    vertices, inert, begin));
    }
  }
}

}  // namespace supple
