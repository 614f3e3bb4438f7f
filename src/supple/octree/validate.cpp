#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "core/float_rounding.hpp"
#include "geometry/vector.hpp"
#include "octree/object_octree.hpp"

namespace supple {
namespace {

/// Checks one octree; each step returns the empty string or what is wrong.
class Validation {
 public:
  Validation(const ObjectOctree& octree, const VertexBuffer& vertices, std::span<const std::uint8_t> inert,
             bool check_spheres, std::uint32_t arity)
      : octree_(octree), vertices_(vertices), inert_(inert), check_spheres_(check_spheres), arity_(arity) {}

  std::string run() const {
    if (!is_permutation(octree_.triangle_ids())) return "triangle ids are not a permutation";
    const auto nodes = octree_.nodes();
    if (nodes.empty()) return octree_.triangles().empty() ? "" : "triangles without a node";
    std::vector<std::uint8_t> reached(nodes.size(), 0);
    std::uint32_t covered = 0;
    for (std::uint32_t n = 0; n < nodes.size(); ++n) {
      if (std::string wrong = check_node(n, reached, covered); !wrong.empty()) return wrong;
    }
    if (covered != octree_.triangles().size()) return "leaves hold " + std::to_string(covered) + " triangles";
    if (std::count(reached.begin() + 1, reached.end(), 1) != std::ssize(nodes) - 1) return "unreachable node";
    return "";
  }

 private:
  static bool is_permutation(std::span<const std::uint32_t> ids) {
    std::vector<std::uint8_t> seen(ids.size(), 0);
    return std::all_of(ids.begin(), ids.end(),
                       [&](std::uint32_t id) { return id < ids.size() && seen[id]++ == 0; });
  }

  std::string check_node(std::uint32_t n, std::vector<std::uint8_t>& reached, std::uint32_t& covered) const {
    const OctreeNode& node = octree_.nodes()[n];
    const std::string here = "node " + std::to_string(n) + ": ";
    if (node.child_count < 1 || node.child_count > arity_) return here + "number of children out of range";
    for (int child = 0; child < node.child_count; ++child) {
      const std::uint32_t begin = node.first_triangle[child], end = node.first_triangle[child + 1];
      if (begin >= end || end > octree_.triangles().size()) return here + "child without triangles";
      if (std::string wrong = check_bounds(n, child, begin, end); !wrong.empty()) return here + wrong;
      if (!node.is_inner(child)) {
        covered += end - begin;
        continue;
      }
      const std::uint32_t below_n = node.child_node(child);
      if (below_n <= n || below_n >= octree_.nodes().size()) return here + "child out of range";
      const OctreeNode& below = octree_.nodes()[below_n];
      reached[below_n] = 1;
      if (below.parent != n || below.index_in_parent != child || below.level != node.level + 1 ||
          below.first_triangle[0] != begin || below.first_triangle[node_width] != end ||
          below.child_count < 2) {
        return here + "child does not fit its parent";
      }
    }
    for (int child = node.child_count; child < node_width; ++child) {
      if (!child_box(octree_.boxes()[n], child).empty() || node.is_inner(child))
        return here + "missing child is not empty";
    }
    return "";
  }

  /// Every vertex of the child's triangles lies in its volumes, and the box is not larger than rounding
  /// explains.
  std::string check_bounds(std::uint32_t n, int child, std::uint32_t begin, std::uint32_t end) const {
    const Aabb box = child_box(octree_.boxes()[n], child);
    constexpr double inf = std::numeric_limits<double>::infinity();
    Vec3d lower{inf, inf, inf}, upper{-inf, -inf, -inf};
    const NodeVolumes* const volumes = octree_.volumes();
    const std::vector<Slab> slabs =
        volumes != nullptr ? volumes->slabs(n, child, box, {}) : std::vector<Slab>();
    const BoundingSphere sphere = volumes != nullptr ? volumes->sphere(n, child) : BoundingSphere{};
    for (std::uint32_t t = begin; t < end; ++t) {
      if (!inert_.empty() && inert_[t] != 0) continue;
      for (const std::uint32_t vertex : octree_.triangles()[t]) {
        const Vec3d p = vertices_[vertex];
        for (int axis = 0; axis < 3; ++axis) {
          lower[axis] = std::min(lower[axis], p[axis]);
          upper[axis] = std::max(upper[axis], p[axis]);
          if (!(box.min[axis] <= p[axis] && p[axis] <= box.max[axis])) return "box does not enclose a vertex";
        }
        if (check_spheres_ && !in_sphere(sphere, p)) return "sphere does not enclose a vertex";
        if (!std::all_of(slabs.begin(), slabs.end(), [&](const Slab& slab) { return in_slab(slab, p); }))
          return "oriented box or k-DOP does not enclose a vertex";
      }
    }
    for (int axis = 0; axis < 3; ++axis) {
      const float least = round_down(lower[axis]), greatest = round_up(upper[axis]);
      if (least - box.min[axis] > 4 * outward_step(least) ||
          box.max[axis] - greatest > 4 * outward_step(greatest)) {
        return "box is larger than rounding explains";
      }
    }
    return "";
  }

  static bool in_sphere(const BoundingSphere& sphere, Vec3d p) {
    const double distance = scaled_norm(p - in_double(sphere.center));
    return distance <= sphere.radius * (1 + 0x1p-40) || std::isinf(sphere.radius);
  }

  static bool in_slab(const Slab& slab, Vec3d p) {
    const Vec3d d{slab.direction.x, slab.direction.y, slab.direction.z};
    const double along = dot(d, p);
    const double error = 0x1p-50 * dot(absolute(d), absolute(p));
    return !(along < slab.low - error || along > slab.high + error);
  }

  const ObjectOctree& octree_;
  const VertexBuffer& vertices_;
  std::span<const std::uint8_t> inert_;
  bool check_spheres_;
  std::uint32_t arity_;
};

}  // namespace

std::string ObjectOctree::validate(const VertexBuffer& vertices, std::span<const std::uint8_t> inert) const {
  const bool enclosing_spheres = bounding_volume_ == BoundingVolume::sphere && sphere_fit_ != SphereFit::box;
  return Validation(*this, vertices, inert, enclosing_spheres, options_.arity).run();
}

std::size_t ObjectOctree::bytes() const {
  return nodes_.capacity() * sizeof(OctreeNode) + boxes_.capacity() * sizeof(ChildBoxes) +
         (volumes_ ? volumes_->bytes() : 0) + triangles_.capacity() * sizeof(Triangle) +
         (triangle_ids_.capacity() + triangle_order_.capacity() + level_begin_.capacity() +
          first_leaf_vertex_.capacity() + leaf_vertices_.capacity() + unused_vertices_.capacity() +
          first_node_.capacity() + nodes_of_vertices_.capacity() + stale_nodes_.capacity()) *
             sizeof(std::uint32_t) +
         cell_numbers_.capacity() * sizeof(std::uint64_t) + leaf_corners_.capacity() + is_stale_.capacity() +
         is_current_.capacity();
}

}  // namespace supple
