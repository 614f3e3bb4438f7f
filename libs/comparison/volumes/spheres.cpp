#include "comparison/methods.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <optional>

#include "comparison/volumes/volume_kernels.hpp"
#include "core/float_rounding.hpp"
#include "geometry/sphere.hpp"
#include "geometry/vector.hpp"

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

/// Finds the vertex that is farthest from a centre.
class FarthestVertex {
 public:
  FarthestVertex(const RefittedOctree& octree, std::span<const ChildSpheres> spheres)
      : octree_(octree), spheres_(spheres) {}

  void start(const Vec3f& center) {
    center_ = center;
    from_ = in_double(center);
    squared_distance_ = 0;
  }

  /// Without spheres of nodes that skip vertices, one loop reads each position once and in order.
  void search_object() {
    if (octree_.are_nodes_current)
      search_node(0);
    else
      for_each_used_vertex(octree_.vertices, octree_.unused_vertices,
                           [&](std::uint32_t vertex) { consider(vertex); });
  }

  void search_child(std::uint32_t n, int child) {
    const OctreeNode& node = octree_.nodes[n];
    if (node.is_inner(child) && octree_.are_nodes_current)
      search_node(node.child_node(child));
    else
      for_each_vertex(octree_, n, child, [&](std::uint32_t vertex) { consider(vertex); });
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

/// `farthest` starts with the vertex farthest from the middle of the box, and `search(farthest)` visits the
/// vertices to enclose. Points are relative to the middle of the box, so that
/// an object far from the origin loses no bits.
template <class Search>
BoundingSphere minimal_sphere(FarthestVertex& farthest, const Vec3f& middle, const Search& search) {
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
    farthest.start(center);
    search(farthest);
    const BoundingSphere sphere = farthest.sphere();
    if (sphere.radius < smallest.radius) smallest = sphere;
    if (farthest.squared_distance() <= squared_radius * squared_tolerance) break;
  }
  return smallest;
}

template <class Search>
BoundingSphere fitted_sphere(SphereFit fit, FarthestVertex farthest, const Aabb& box, const Search& search) {
  if (box.empty()) return {};
  if (fit == SphereFit::box) return sphere_from_box(box);
  const Vec3f middle = middle_of(box);
  farthest.start(middle);
  search(farthest);
  return fit == SphereFit::minimal ? minimal_sphere(farthest, middle, search) : farthest.sphere();
}

class Spheres final : public NodeVolumes {
 public:
  Spheres(SphereFit fit, std::size_t nodes)
      : NodeVolumes(BoundingVolume::sphere, nodes), fit_(fit), spheres_(nodes) {}

  /// Not `refit_bottom_up`: a sphere is fitted to the vertices below, because the union of spheres is larger.
  void refit(const RefittedOctree& octree, std::uint32_t begin, std::uint32_t end) override {
    for (std::uint32_t n = begin; n < end; ++n) {
      for (int child = 0; child < node_width; ++child) {
        spheres_[n][static_cast<std::size_t>(child)] =
            fitted_sphere(fit_, FarthestVertex(octree, spheres_), child_box(octree.boxes[n], child),
                          [&](FarthestVertex& farthest) { farthest.search_child(n, child); });
      }
    }
  }

  void refit_object(const RefittedOctree& octree, const Aabb& box) override {
    object_sphere_ = fitted_sphere(fit_, FarthestVertex(octree, spheres_), box,
                                   [](FarthestVertex& farthest) { farthest.search_object(); });
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

  BoundingSphere sphere(std::uint32_t node, int child) const override {
    return node == object() ? object_sphere_ : spheres_[node][static_cast<std::size_t>(child)];
  }

  std::size_t bytes() const override { return spheres_.capacity() * sizeof(ChildSpheres); }

 private:
  SphereFit fit_;
  std::vector<ChildSpheres> spheres_;
  BoundingSphere object_sphere_;
};

}  // namespace

std::unique_ptr<NodeVolumes> make_spheres(SphereFit fit, std::size_t nodes) {
  return std::make_unique<Spheres>(fit, nodes);
}

}  // namespace supple
