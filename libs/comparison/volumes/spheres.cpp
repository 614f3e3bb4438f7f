#include "comparison/methods.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <optional>

#include "comparison/volumes/medial_axis.hpp"
#include "comparison/volumes/volume_kernels.hpp"
#include "core/float_rounding.hpp"
#include "geometry/sphere.hpp"
#include "geometry/vector.hpp"
#include "octree/volumes/box_kernels.hpp"
#include "world/object/resting_shape.hpp"

namespace supple {
namespace {

/// The spheres of the children of a node. Those of missing children, and of children without a finite
/// triangle, are empty.
using ChildSpheres = std::array<BoundingSphere, node_width>;

/// Pivots after which the search ends. It usually takes fewer than ten.
constexpr int most_pivots = 32;
/// The search ends when no vertex is farther than this factor of the squared radius.
constexpr double squared_tolerance = 1 + 0x1p-22;
/// Covers the rounding of spheres around up to five points.
constexpr double squared_slack = 1 + 0x1p-36;
/// Medial centres that are tried for a sphere.
constexpr std::uint32_t most_candidates = 32;

/// The paper's equations 3 and 4: the sphere inside the cube that has the lower corner and the longest side
/// of the box.
BoundingSphere sphere_from_box(const Aabb& box) {
  const double side =
      std::max({double{box.max.x} - box.min.x, double{box.max.y} - box.min.y, double{box.max.z} - box.min.z});
  const auto half = static_cast<float>(side / 2);
  return {{box.min.x + half, box.min.y + half, box.min.z + half}, half};
}

Vec3f middle_of(const Aabb& box) {
  Vec3f middle;
  constexpr double limit = std::numeric_limits<float>::max();
  for (int axis = 0; axis < 3; ++axis) {
    middle[axis] = static_cast<float>((std::clamp(double{box.min[axis]}, -limit, limit) +
                                       std::clamp(double{box.max[axis]}, -limit, limit)) /
                                      2);
  }
  return middle;
}

/// The point of the box that is nearest to a medial centre, because no vertex of the box is farther from it.
/// Coordinates that are not finite become those of the middle.
Vec3f nearest_in(const Aabb& box, const Vec3d& medial_center, Vec3f middle) {
  for (int axis = 0; axis < 3; ++axis) {
    const double nearest = std::clamp(medial_center[axis], double{box.min[axis]}, double{box.max[axis]});
    if (std::abs(nearest) <= std::numeric_limits<float>::max()) middle[axis] = static_cast<float>(nearest);
  }
  return middle;
}

/// Finds the vertex below a child, or of the whole object, that is farthest from a centre.
class FarthestVertex {
 public:
  FarthestVertex(const RefittedOctree& octree, std::span<const ChildSpheres> spheres, std::uint32_t n,
                 int child)
      : octree_(octree), spheres_(spheres), n_(n), child_(child) {}

  void search_from(const Vec3f& center) {
    center_ = center;
    from_ = in_double(center);
    squared_distance_ = 0;
    if (n_ < octree_.nodes.size())
      search_child(n_, child_);
    else if (octree_.are_nodes_current)
      search_node(0);
    else  // no sphere skips vertices: one loop reads each position once and in order
      for_each_used_vertex(octree_.vertices, octree_.unused_vertices,
                           [&](std::uint32_t vertex) { consider(vertex); });
  }

  Vec3d position() const { return position_; }
  double squared_distance() const { return squared_distance_; }

  /// The sphere around the centre that reaches the vertex.
  BoundingSphere sphere() const {
    // The factor covers the rounding of the sum and the root; the addend covers squares that underflow.
    return {center_,
            round_up(std::sqrt(squared_distance_) * (1 + 0x1p-50) + std::numeric_limits<float>::min())};
  }

 private:
  void search_child(std::uint32_t n, int child) {
    const OctreeNode& node = octree_.nodes[n];
    if (node.is_inner(child) && octree_.are_nodes_current)
      search_node(node.child_node(child));
    else
      for_each_vertex(octree_, n, child, [&](std::uint32_t vertex) { consider(vertex); });
  }

  void search_node(std::uint32_t n) {
    struct Reach {
      double most;  ///< bound of the distance
      std::size_t child;
    };
    std::array<Reach, node_width> reaches;
    const int count = octree_.nodes[n].child_count;
    for (std::size_t child = 0; child < octree_.nodes[n].child_count; ++child) {
      const BoundingSphere& sphere = spheres_[n][child];
      reaches[child] = {norm(in_double(sphere.center) - from_) + sphere.radius, child};
    }
    std::sort(reaches.begin(), reaches.begin() + count, [](const Reach& a, const Reach& b) {
      return a.most != b.most ? a.most > b.most : a.child < b.child;
    });
    for (int i = 0; i < count; ++i) {
      const auto [most, child] = reaches[static_cast<std::size_t>(i)];
      // The factor covers the rounding of the distances.
      if (most * most * (1 + 0x1p-40) < squared_distance_) break;
      if (!spheres_[n][child].empty()) search_child(n, static_cast<int>(child));
    }
  }

  void consider(std::uint32_t vertex) {
    const Vec3d p = octree_.vertices[vertex];
    const double squared_distance = squared_norm(p - from_);
    if (!(squared_distance > squared_distance_)) return;
    squared_distance_ = squared_distance;
    position_ = p;
  }

  const RefittedOctree& octree_;
  std::span<const ChildSpheres> spheres_;
  std::uint32_t n_;
  int child_;
  Vec3f center_{};
  Vec3d from_{}, position_{};
  double squared_distance_ = 0;
};

struct Ball {
  Vec3d center;
  double squared_radius;
};

/// Up to four points on a ball.
struct Support {
  std::array<Vec3d, 4> points{};
  std::size_t count = 0;

  void push(const Vec3d& point) { points[count++] = point; }
  std::span<const Vec3d> all() const { return std::span(points).first(count); }
};

/// The smallest ball with all points on its surface. The center is not finite when the points are not
/// independent.
Ball ball_through(const Support& support) {
  const auto& p = support.points;
  const Vec3d a = p[1] - p[0], b = p[2] - p[0], c = p[3] - p[0];
  const double aa = squared_norm(a), bb = squared_norm(b), cc = squared_norm(c);
  Vec3d offset{};
  if (support.count == 2) offset = a / 2;
  if (support.count == 3) {
    const Vec3d normal = cross(a, b);
    offset = cross(aa * b - bb * a, normal) / (2 * squared_norm(normal));
  }
  if (support.count == 4)
    offset = (aa * cross(b, c) + bb * cross(c, a) + cc * cross(a, b)) / (2 * dot(a, cross(b, c)));
  return {p[0] + offset, squared_norm(offset)};
}

/// The smallest ball around the support and a point outside of its ball, which is on the new ball. Replaces
/// the support by the points on the new ball. Nothing when rounding hides it.
std::optional<Ball> extended_ball(Support& support, const Vec3d& point) {
  std::optional<Ball> smallest;
  Support chosen;
  for (std::uint32_t subset = 0; subset < 1u << support.count; ++subset) {
    if (bit_count(subset) > 3) continue;
    Support on_ball;
    on_ball.push(point);
    for (std::size_t i = 0; i < support.count; ++i) {
      if ((subset >> i & 1) != 0) on_ball.push(support.points[i]);
    }
    const Ball ball = ball_through(on_ball);
    if (smallest && !(ball.squared_radius < smallest->squared_radius)) continue;
    const bool encloses = std::ranges::all_of(support.all(), [&](const Vec3d& p) {
      return squared_norm(p - ball.center) <= ball.squared_radius * squared_slack;
    });
    if (!encloses || !is_finite(ball.center)) continue;
    smallest = ball;
    chosen = on_ball;
  }
  support = chosen;
  return smallest;
}

/// `farthest` starts with the vertex farthest from the middle of the box. Points are relative to the middle
/// of the box, so that an object far from the origin loses no bits.
BoundingSphere minimal_sphere(FarthestVertex& farthest, const Vec3f& middle) {
  BoundingSphere smallest = farthest.sphere();
  if (farthest.squared_distance() == 0) return smallest;
  Support support;
  double squared_radius = -1;
  for (int pivot = 0; pivot < most_pivots; ++pivot) {
    const std::optional<Ball> ball = extended_ball(support, farthest.position() - in_double(middle));
    if (!ball || !(ball->squared_radius > squared_radius)) break;
    squared_radius = ball->squared_radius;
    Vec3f center;
    for (int axis = 0; axis < 3; ++axis)
      center[axis] = static_cast<float>(double{middle[axis]} + ball->center[axis]);
    farthest.search_from(center);
    const BoundingSphere sphere = farthest.sphere();
    if (sphere.radius < smallest.radius) smallest = sphere;
    if (farthest.squared_distance() <= squared_radius * squared_tolerance) break;
  }
  return smallest;
}

auto& at(auto& of_children, std::uint32_t n, int child) {
  return of_children[n][static_cast<std::size_t>(child)];
}

class Spheres final : public NodeVolumes {
 public:
  Spheres(SphereFit fit, const ObjectOctree& octree, const PositionsView& rest_positions)
      : NodeVolumes(BoundingVolume::sphere, octree.nodes().size()),
        fit_(fit),
        spheres_(octree.nodes().size() + 1) {
    if (fit == SphereFit::medial && !octree.nodes().empty()) choose_centers(octree, rest_positions);
  }

  /// Not `refit_bottom_up`: a sphere is fitted to the vertices below, because the union of spheres is larger.
  void refit(const RefittedOctree& octree, std::uint32_t begin, std::uint32_t end) override {
    for (std::uint32_t n = begin; n < end; ++n) {
      for (int child = 0; child < node_width; ++child)
        at(spheres_, n, child) = fitted_sphere(octree, n, child, child_box(octree.boxes[n], child));
    }
  }

  void refit_object(const RefittedOctree& octree, const Aabb& box) override {
    at(spheres_, object(), 0) = fitted_sphere(octree, object(), 0, box);
  }

  void clear_apart(std::span<const NodePair> pairs, const NodeVolumes& b, const RelativePlacement& placement,
                   std::uint64_t* masks) const override {
    for (std::size_t k = 0; k < pairs.size(); ++k) {
      for (std::uint32_t rest_a = pairs[k].children_a; rest_a != 0; rest_a &= rest_a - 1) {
        const int i = std::countr_zero(rest_a);
        const BoundingSphere one = sphere(pairs[k].a, i);
        for (std::uint32_t rest_b = pairs[k].children_b; rest_b != 0; rest_b &= rest_b - 1) {
          const int j = std::countr_zero(rest_b);
          const BoundingSphere other = static_cast<const Spheres&>(b).sphere(pairs[k].b, j);
          const bool are_apart = !overlap(one, other, placement.offset, placement.slop);
          masks[k] &= ~(std::uint64_t{are_apart} << (node_width * i + j));
        }
      }
    }
  }

  BoundingSphere sphere(std::uint32_t node, int child) const override { return at(spheres_, node, child); }

  std::size_t bytes() const override {
    return spheres_.capacity() * sizeof(ChildSpheres) + centers_.capacity() * sizeof(ChildCenters);
  }

 private:
  using ChildCenters = std::array<MedialCenter, node_width>;

  BoundingSphere fitted_sphere(const RefittedOctree& octree, std::uint32_t n, int child,
                               const Aabb& box) const {
    if (box.empty()) return {};
    if (fit_ == SphereFit::box) return sphere_from_box(box);
    const Vec3f middle = middle_of(box);
    FarthestVertex farthest(octree, spheres_, n, child);
    farthest.search_from(middle);
    if (fit_ == SphereFit::minimal) return minimal_sphere(farthest, middle);
    const BoundingSphere sphere = farthest.sphere();
    if (centers_.empty()) return sphere;
    const Vec3f medial = nearest_in(box, at(centers_, n, child).position(octree), middle);
    if (medial == middle) return sphere;
    farthest.search_from(medial);
    return farthest.sphere().radius < sphere.radius ? farthest.sphere() : sphere;
  }

  /// For each sphere of the rest pose, tries centres on the medial axis below evenly spaced triangles.
  void choose_centers(const ObjectOctree& octree, const PositionsView& rest_positions) {
    VertexBuffer vertices;
    vertices.assign(rest_positions, Parallel(1));
    std::vector<std::uint8_t> inert;
    const bool some_inert = mark_inert(octree, vertices, ~std::uint32_t{0}, inert);
    std::vector<ChildBoxes> boxes(octree.nodes().size());
    for (std::uint32_t n = object(); n-- > 0;)
      refit_boxes(octree.nodes().data(), boxes.data(), arrays_of(octree.triangles(), vertices, inert),
                  octree.leaf_vertices(), n, n + 1);
    if (!some_inert) inert.clear();  // visits of vertices are faster
    const RefittedOctree resting{
        octree.nodes(), boxes.data(), octree.triangles(), octree.leaf_vertices(), vertices, inert, {}};
    const std::vector<double> depths = medial_depths(resting);
    centers_.resize(spheres_.size());
    const auto choose = [&](std::uint32_t n, int child, const Aabb& box, std::uint32_t begin,
                            std::uint32_t end) {
      BoundingSphere smallest = fitted_sphere(resting, n, child, box);
      MedialCenter& center = at(centers_, n, child);
      MedialCenter best = center;
      for (std::uint32_t t = begin; t < end; t += (end - begin - 1) / most_candidates + 1) {
        center = {t, depths[t]};
        const BoundingSphere sphere = fitted_sphere(resting, n, child, box);
        if (!(sphere.radius < smallest.radius)) continue;
        smallest = sphere;
        best = center;
      }
      at(spheres_, n, child) = smallest;
      center = best;
    };
    for (std::uint32_t n = object(); n-- > 0;) {
      const OctreeNode& node = octree.nodes()[n];
      for (int child = 0; child < node.child_count; ++child)
        choose(n, child, child_box(boxes[n], child), node.first_triangle[child],
               node.first_triangle[child + 1]);
    }
    choose(object(), 0, enclosing_box(boxes[0]), 0, static_cast<std::uint32_t>(depths.size()));
  }

  SphereFit fit_;
  std::vector<ChildSpheres> spheres_;
  std::vector<ChildCenters> centers_;  // for `SphereFit::medial`
};

}  // namespace

std::unique_ptr<NodeVolumes> make_spheres(SphereFit fit, const ObjectOctree& octree,
                                          const PositionsView& rest_positions) {
  return std::make_unique<Spheres>(fit, octree, rest_positions);
}

}  // namespace supple
