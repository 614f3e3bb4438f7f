#include "inspect/validation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <vector>

#include "core/float_rounding.hpp"
#include "geometry/aabb.hpp"
#include "geometry/vector.hpp"
#include "octree/object_octree.hpp"
#include "octree/refit_bottom_up.hpp"
#include "octree/surface_elements.hpp"
#include "octree/volumes/moving_boxes.hpp"
#include "world/world.hpp"

namespace supple {
namespace {

/// Checks one octree; each step returns the empty string or what is wrong.
class Validation {
 public:
  Validation(const ObjectOctree& octree, const VertexBuffer& vertices, std::span<const std::uint8_t> inert)
      : octree_(octree), vertices_(vertices), inert_(inert) {}

  std::string run() const {
    for (std::uint32_t t = 0; t < octree_.triangles().size(); ++t) {
      const std::uint32_t id = octree_.triangle_ids()[t];
      if (!octree_.has_triangle(id) || octree_.octree_triangle(id) != t)
        return "triangle ids and places do not match";
    }
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
  std::string check_node(std::uint32_t n, std::vector<std::uint8_t>& reached, std::uint32_t& covered) const {
    const OctreeNode& node = octree_.nodes()[n];
    const std::string here = "node " + std::to_string(n) + ": ";
    if (node.child_count < 1 || node.child_count > octree_.options().arity)
      return here + "number of children out of range";
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
        if (octree_.spheres_enclose() && !in_sphere(sphere, p)) return "sphere does not enclose a vertex";
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
};

/// Checks the boxes of all children at one end of the step.
std::string fault_of_moment(const ObjectOctree& octree, const SurfaceElements& elements,
                            const ChildBoxes* boxes, const VertexBuffer& positions,
                            std::span<const std::uint8_t> inert) {
  constexpr float greatest = std::numeric_limits<float>::max();
  const auto nodes = octree.nodes();
  std::vector<ChildBoxes> expected(nodes.size());
  refit_child_boxes(nodes, expected.data(), [&](const OctreeNode& node, int child) {
    Aabb box;
    for (const Triangle& face : elements.faces().subspan(node.first_triangle[child], node.size(child))) {
      for (const std::uint32_t vertex : face) {
        if (inert[vertex] == 0) extend(box, positions[vertex]);
      }
    }
    for (int axis = 0; axis < 3 && !box.empty(); ++axis) {
      box.min[axis] = std::max(box.min[axis], -greatest);
      box.max[axis] = std::min(box.max[axis], greatest);
    }
    return box;
  });
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    for (int child = 0; child < node_width; ++child) {
      if (child_box(boxes[n], child) != child_box(expected[n], child))
        return "the box of a child is not that of its vertices";
    }
  }
  return "";
}

std::string fault_of(const WorldObject& object) {
  const ObjectOctree& octree = object.octree();
  if (object.is_resting_current()) {
    const std::uint8_t* const inert = object.resting_view().arrays.inert;
    const std::size_t count = inert != nullptr ? octree.triangles().size() : 0;
    if (std::string wrong = fault_of(octree, object.placement().end(), std::span(inert, count));
        !wrong.empty())
      return wrong;
  }
  const MovingShape* const shapes[] = {&object.moving(), &object.near()};  // the same at rest
  for (const MovingShape* const shape : std::span(shapes).first(object.placement().has_motion() ? 2 : 1)) {
    if (!shape->is_current(object.placement())) continue;
    std::string wrong = fault_of(shape->elements(), octree);
    if (wrong.empty())
      wrong = fault_of(shape->boxes(), octree, shape->elements(), shape->start(), shape->end());
    if (!wrong.empty()) return wrong;
  }
  return "";
}

}  // namespace

std::string fault_of(const ObjectOctree& octree, const VertexBuffer& vertices,
                     std::span<const std::uint8_t> inert) {
  return Validation(octree, vertices, inert).run();
}

std::string fault_of(const SurfaceElements& elements, const ObjectOctree& octree) {
  const std::span<const Triangle> faces = elements.faces();
  const std::span<const std::uint32_t> ids = elements.vertex_ids();
  if (octree.triangles().size() != faces.size() || octree.vertex_count() != ids.size())
    return "elements of another octree";
  for (std::size_t t = 0; t < faces.size(); ++t) {
    for (std::size_t corner = 0; corner < 3; ++corner) {
      if (ids[faces[t][corner]] != octree.triangles()[t][corner])
        return "faces are not the octree's triangles";
    }
  }
  std::set<Edge> seen;
  std::uint32_t vertices = 0, edges = 0;
  for (std::size_t t = 0; t < faces.size(); ++t) {
    if (elements.first_vertex()[t] != vertices || elements.first_edge()[t] != edges)
      return "owned elements do not follow on";
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const std::uint32_t p = faces[t][corner], q = faces[t][(corner + 1) % 3];
      if (p > vertices) return "vertices are not in the order of first use";
      vertices = std::max(vertices, p + 1);
      const Edge edge{std::min(p, q), std::max(p, q)};
      if (p == q || !seen.insert(edge).second) continue;
      if (edges >= elements.edge_count() || elements.edges()[edges] != edge)
        return "edges are not in the order of first use";
      ++edges;
    }
  }
  if (elements.first_vertex()[faces.size()] != vertices || elements.first_edge()[faces.size()] != edges)
    return "elements are missing";
  return edges == elements.edge_count() ? "" : "edges of no triangle";
}

std::string fault_of(const MovingBoxes& boxes, const ObjectOctree& octree, const SurfaceElements& elements,
                     const VertexBuffer& start, const VertexBuffer& end) {
  std::vector<std::uint8_t> inert(start.size());
  for (std::uint32_t v = 0; v < inert.size(); ++v) inert[v] = !is_finite(start[v]) || !is_finite(end[v]);
  const MovingView view = boxes.view(elements);
  std::string wrong = fault_of_moment(octree, elements, view.start, start, inert);
  return wrong.empty() ? fault_of_moment(octree, elements, view.end, end, inert) : wrong;
}

std::string fault_of(const World& world) {
  for (std::size_t slot = 0; slot < world.slot_count(); ++slot) {
    const WorldObject* const object = world.at(slot);
    if (object == nullptr) continue;
    if (const std::string wrong = fault_of(*object); !wrong.empty())
      return object->options.name + ": " + wrong;
  }
  return {};
}

}  // namespace supple
