#include "octree/volumes/node_volumes.hpp"

#include <array>
#include <cmath>

#include "core/float_rounding.hpp"
#include "geometry/vector.hpp"
#include "octree/object_octree.hpp"
#include "octree/refit_bottom_up.hpp"

namespace supple {
namespace {

void set_child(ChildOrientedBoxes& boxes, int child, const OrientedBox& box) {
  for (int coordinate = 0; coordinate < 3; ++coordinate) {
    boxes.center[coordinate][child] = box.center[coordinate];
    boxes.half_lengths[coordinate][child] = box.half_lengths[coordinate];
    for (std::size_t axis = 0; axis < 3; ++axis)
      boxes.axes[axis][coordinate][child] = box.axes[axis][coordinate];
  }
}

/// The slab along a direction of the points that have distances from `low` to `high` along it, moved. The
/// growth covers the rounding of the sums.
Slab moved_slab(Vec3f direction, double low, double high, Vec3d translation) {
  const Vec3d d{direction.x, direction.y, direction.z};
  const double shift = dot(d, translation);
  const double growth = 0x1p-48 * (std::abs(low) + std::abs(high) + 3 * largest_magnitude(translation));
  return {direction, round_down(low + shift - growth), round_up(high + shift + growth)};
}

/// Extends the extents by the vertices of a child, whose triangles are `part`.
void extend_by_child(const AxisFrame& frame, std::span<const OctreeNode> nodes, std::uint32_t n, int child,
                     const SurfacePart& part, const LeafVertexArrays& leaves, AxisExtents& extents) {
  const TriangleArrays arrays = arrays_of(part.triangles, part.vertices, part.inert);
  if (!part.inert.empty()) {
    for (std::size_t t = 0; t < part.triangles.size(); ++t) {
      if (part.inert[t] == 0) extend_extents(frame, arrays, part.triangles[t], extents);
    }
    return;
  }
  // The vertices of consecutive children of consecutive nodes are consecutive.
  const auto extend_by = [&](std::size_t begin_child, std::size_t end_child) {
    const std::uint32_t first = leaves.first[begin_child], last = leaves.first[end_child];
    extend_extents(frame, arrays, {leaves.vertices + first, last - first}, extents);
  };
  if (!nodes[n].is_inner(child)) {
    const std::size_t leaf = std::size_t{n} * node_width + static_cast<std::size_t>(child);
    return extend_by(leaf, leaf + 1);
  }
  // Nodes are in order of levels, so the nodes below in one level are consecutive.
  const auto count = static_cast<std::uint32_t>(nodes.size());
  for (std::uint32_t begin = nodes[n].child_node(child), end = begin + 1; begin < end;) {
    extend_by(std::size_t{begin} * node_width, std::size_t{end} * node_width);
    begin = nodes[begin].first_child;
    end = end < count ? nodes[end].first_child : count;
  }
}

}  // namespace

NodeVolumes::NodeVolumes(BoundingVolume kind, std::size_t nodes) : directions_(slab_directions_of(kind)) {
  if (nodes == 0) return;
  slabs_.resize((nodes + 1) * directions_.size() * floats_per_slab);
  if (kind != BoundingVolume::obb) return;
  oriented_boxes_.resize(nodes + 1);
  moments_.resize(nodes);
}

NodeVolumesView NodeVolumes::view() const {
  if (!slabs_.empty()) {
    const std::size_t entries = slabs_.size() / (directions_.size() * floats_per_slab);
    return {nullptr, slabs_.data(), directions_, static_cast<std::uint32_t>(entries - 1)};
  }
  if (oriented_boxes_.empty()) return {};
  return {oriented_boxes_.data(), nullptr, {}, static_cast<std::uint32_t>(oriented_boxes_.size() - 1)};
}

void NodeVolumes::refit(std::span<const OctreeNode> nodes, const ChildBoxes* boxes,
                        const SurfacePart& surface, const LeafVertexArrays& leaves, std::uint32_t begin,
                        std::uint32_t end) {
  if (!slabs_.empty()) {
    refit_slabs(nodes.data(), boxes, slabs_.data(), directions_,
                arrays_of(surface.triangles, surface.vertices, surface.inert), leaves, begin, end);
  }
  if (oriented_boxes_.empty()) return;
  const auto part_of = [&](std::uint32_t n, int child) {
    return surface.part(nodes[n].first_triangle[child], nodes[n].size(child));
  };
  std::array<SurfaceMoments, node_width> of_leaves;
  refit_bottom_up(
      nodes.data(), begin, end,
      [&](std::uint32_t n, int child) {
        of_leaves[static_cast<std::size_t>(child)] = moments_of(part_of(n, child));
      },
      [&](std::uint32_t n) {
        const OctreeNode& node = nodes[n];
        moments_[n] = {};
        for (int child = 0; child < node.child_count; ++child) {
          const SurfaceMoments& moments = node.is_inner(child) ? moments_[node.child_node(child)]
                                                               : of_leaves[static_cast<std::size_t>(child)];
          moments_[n] += moments;
          const OrientedBoxFit fit(moments, child_box(boxes[n], child));
          AxisExtents extents;
          if (fit.needs_extents())
            extend_by_child(fit.frame(), nodes, n, child, part_of(n, child), leaves, extents);
          set_child(oriented_boxes_[n], child, fit.box(extents));
        }
      });
}

void NodeVolumes::refit_object(std::span<const OctreeNode> nodes, const ChildBoxes* boxes,
                               const SurfacePart& surface, const LeafVertexArrays& leaves) {
  if (!slabs_.empty()) {
    const std::size_t stride = directions_.size() * floats_per_slab;
    unite_slabs(slabs_.data(), nodes[0].child_count, directions_.size(),
                slabs_.data() + nodes.size() * stride, 0);
  }
  if (oriented_boxes_.empty()) return;
  const OrientedBoxFit fit(moments_[0], enclosing_box(boxes[0]));
  AxisExtents extents;
  for (int child = 0; fit.needs_extents() && child < nodes[0].child_count; ++child) {
    const SurfacePart part = surface.part(nodes[0].first_triangle[child], nodes[0].size(child));
    extend_by_child(fit.frame(), nodes, 0, child, part, leaves, extents);
  }
  set_child(oriented_boxes_.back(), 0, fit.box(extents));
}

OrientedBox child_oriented_box(const ChildOrientedBoxes& boxes, int child) {
  OrientedBox box;
  for (int coordinate = 0; coordinate < 3; ++coordinate) {
    box.center[coordinate] = boxes.center[coordinate][child];
    box.half_lengths[coordinate] = boxes.half_lengths[coordinate][child];
    for (std::size_t axis = 0; axis < 3; ++axis)
      box.axes[axis][coordinate] = boxes.axes[axis][coordinate][child];
  }
  return box;
}

std::vector<Slab> child_slabs(const NodeVolumesView& volumes, const Aabb& box, std::uint32_t node, int child,
                              Vec3d translation) {
  std::vector<Slab> result;
  if (volumes.oriented_boxes != nullptr) {
    const OrientedBox oriented = child_oriented_box(volumes.oriented_boxes[node], child);
    const Vec3d center{oriented.center.x, oriented.center.y, oriented.center.z};
    for (int k = 0; k < 3; ++k) {
      const Vec3f axis = oriented.axes[static_cast<std::size_t>(k)];
      const double along = dot(Vec3d{axis.x, axis.y, axis.z}, center), half = oriented.half_lengths[k];
      result.push_back(moved_slab(axis, along - half, along + half, translation));
    }
  }
  if (volumes.slabs != nullptr) {
    for (int axis = 0; axis < 3; ++axis) {
      Vec3f direction;
      direction[axis] = 1;
      result.push_back(moved_slab(direction, box.min[axis], box.max[axis], translation));
    }
    const float* low = volumes.slabs_of(node) + child;
    for (const Vec3f& direction : volumes.directions) {
      result.push_back(moved_slab(direction, low[0], low[node_width], translation));
      low += floats_per_slab;
    }
  }
  return result;
}

}  // namespace supple
