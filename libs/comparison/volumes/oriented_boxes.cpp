#include "comparison/methods.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "comparison/volumes/volume_kernels.hpp"
#include "core/float_rounding.hpp"
#include "geometry/aabb.hpp"
#include "geometry/vector.hpp"
#include "octree/refit_bottom_up.hpp"

namespace supple {
namespace {

using Matrix = std::array<std::array<double, 3>, 3>;

/// Calls `visit(place, p[i] q[i])` for the six products of second moments.
template <class Visit>
void for_each_product(Vec3d p, Vec3d q, const Visit& visit) {
  visit(0, p.x * q.x);
  visit(1, p.y * q.y);
  visit(2, p.z * q.z);
  visit(3, p.x * q.y);
  visit(4, p.y * q.z);
  visit(5, p.z * q.x);
}

/// Area, centre of area and second moments about it of some triangles. Sums are those of the union. There is
/// no common origin, so nothing cancels far away from it, and moments depend on nothing but their triangles.
struct SurfaceMoments {
  double area = 0;
  Vec3d center{};
  std::array<double, 6> second{};  ///< integrals of xx, yy, zz, xy, yz, zx

  /// The parallel axis theorem.
  SurfaceMoments& operator+=(const SurfaceMoments& other) {
    if (!(other.area > 0)) return *this;
    if (!(area > 0)) return *this = other;
    const Vec3d between = other.center - center;
    const double sum = area + other.area, share = other.area / sum;
    for (std::size_t i = 0; i < second.size(); ++i) second[i] += other.second[i];
    for_each_product(between, between,
                     [&](std::size_t place, double product) { second[place] += area * share * product; });
    center += share * between;
    area = sum;
    return *this;
  }
};

Matrix covariance(const SurfaceMoments& moments) {
  const auto& [xx, yy, zz, xy, yz, zx] = moments.second;
  return {{{xx, xy, zx}, {xy, yy, yz}, {zx, yz, zz}}};
}

/// Sets the entry (i, j) of a symmetric matrix to zero by a rotation, and rotates the vectors likewise.
void rotate(Matrix& m, std::array<Vec3d, 3>& vectors, std::size_t i, std::size_t j) {
  if (m[i][j] == 0) return;
  const double theta = (m[j][j] - m[i][i]) / (2 * m[i][j]);
  const double t = (theta < 0 ? -1 : 1) / (std::abs(theta) + std::sqrt(theta * theta + 1));
  const double c = 1 / std::sqrt(t * t + 1), s = t * c;
  for (std::size_t k = 0; k < 3; ++k) {
    const double p = m[k][i], q = m[k][j];
    m[k][i] = c * p - s * q;
    m[k][j] = s * p + c * q;
  }
  for (std::size_t k = 0; k < 3; ++k) {
    const double p = m[i][k], q = m[j][k];
    m[i][k] = c * p - s * q;
    m[j][k] = s * p + c * q;
  }
  const Vec3d p = vectors[i], q = vectors[j];
  vectors[i] = c * p - s * q;
  vectors[j] = s * p + c * q;
}

/// The eigenvectors of a symmetric matrix by Jacobi's method, orthonormal except for rounding. Converges
/// quadratically: five sweeps are enough for double, and fewer when the matrix is nearly diagonal for float.
std::array<Vec3d, 3> eigenvectors(Matrix m) {
  std::array<Vec3d, 3> vectors{Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}};
  const double negligible = 0x1p-30 * (m[0][0] + m[1][1] + m[2][2]);
  for (int sweep = 0; sweep < 5; ++sweep) {
    if (std::max({std::abs(m[0][1]), std::abs(m[1][2]), std::abs(m[0][2])}) <= negligible) break;
    rotate(m, vectors, 0, 1);
    rotate(m, vectors, 1, 2);
    rotate(m, vectors, 0, 2);
  }
  return vectors;
}

double half_surface(Vec3f h) {
  return double{h.x} * h.y + double{h.y} * h.z + double{h.z} * h.x;
}

Vec3f in_float(Vec3d v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

/// The points c + t0 h0 a0 + t1 h1 a1 + t2 h2 a2 with |t| <= 1. The axes are of unit length and at right
/// angles, except for their rounding to float.
struct OrientedBox {
  Vec3f center{};
  std::array<Vec3f, 3> axes{Vec3f{1, 0, 0}, Vec3f{0, 1, 0}, Vec3f{0, 0, 1}};
  Vec3f half_lengths{};
};

/// Three axes at right angles, of unit length except for rounding, the point where distances along them
/// begin, and the lowest and the highest distance along each axis; inverted without points.
struct AxisExtents {
  static constexpr float inverted = std::numeric_limits<float>::infinity();
  std::array<Vec3f, 3> axes{};
  Vec3d origin{};
  std::array<float, 3> low{inverted, inverted, inverted}, high{-inverted, -inverted, -inverted};

  /// The distance of a point has an error of at most 2^-21 of the distance between the point and the origin.
  void extend(const Vec3d& point) {
    const Vec3f p = in_float(point - origin);
    for (std::size_t k = 0; k < 3; ++k) {
      const float along = dot(p, axes[k]);
      low[k] = std::min(low[k], along);
      high[k] = std::max(high[k], along);
    }
  }
};

OrientedBox aligned_box(const Aabb& box) {
  OrientedBox result;
  for (int axis = 0; axis < 3; ++axis) {
    const double low = box.min[axis], high = box.max[axis];
    result.center[axis] = static_cast<float>((low + high) / 2);
    result.half_lengths[axis] = round_up(std::max(high - result.center[axis], result.center[axis] - low));
  }
  return result;
}

/// Returns the moments of the triangles [begin, end) of the octree that are not inert. It sums about the
/// first corner, then moves the sums to the centre, which needs no division for each triangle.
SurfaceMoments moments_of(const RefittedOctree& octree, std::uint32_t begin, std::uint32_t end) {
  std::optional<Vec3d> origin;
  SurfaceMoments sum;
  for (std::uint32_t t = begin; t < end; ++t) {
    if (!octree.inert.empty() && octree.inert[t] != 0) continue;
    const auto [first, second, third] = octree.triangles[t];
    if (!origin) origin = octree.vertices[first];
    const Vec3d p = octree.vertices[first] - *origin, q = octree.vertices[second] - *origin,
                r = octree.vertices[third] - *origin;
    const double area = norm(cross(q - p, r - p)) / 2;
    const Vec3d corners = p + q + r;
    sum.area += area;
    sum.center += area / 3 * corners;
    // The mean of a b over a triangle is the sum of a b over its corners and their sum, divided by 12.
    for (const Vec3d& corner : {p, q, r, corners}) {
      for_each_product(corner, corner,
                       [&](std::size_t place, double product) { sum.second[place] += area / 12 * product; });
    }
  }
  if (!(sum.area > 0)) return {};
  const Vec3d center = sum.center * (1 / sum.area);
  for_each_product(center, center,
                   [&](std::size_t place, double product) { sum.second[place] -= sum.area * product; });
  sum.center = *origin + center;
  return sum;
}

/// Fits an oriented box to triangles with these moments and this box. `extend(extents)` extends extents by
/// all of their vertices. The growth covers the errors of the extents and the rounding of the axes, which
/// makes them up to 2^-22 oblique.
template <class Extend>
OrientedBox fitted_box(const SurfaceMoments& moments, const Aabb& box, const Extend& extend) {
  if (box.empty()) return {};
  constexpr float largest = 0x1p60f;  // squares of areas do not overflow
  for (int axis = 0; axis < 3; ++axis) {
    constexpr float inf = std::numeric_limits<float>::infinity();
    if (!(box.min[axis] >= -largest && box.max[axis] <= largest)) return {.half_lengths = {inf, inf, inf}};
  }
  const OrientedBox aligned = aligned_box(box);
  if (!(moments.area > 0)) return aligned;
  const std::array<Vec3d, 3> axes = eigenvectors(covariance(moments));
  AxisExtents extents{.axes = {in_float(axes[0]), in_float(axes[1]), in_float(axes[2])},
                      .origin = in_double(aligned.center)};
  extend(extents);
  OrientedBox fitted{{}, extents.axes, {}};
  Vec3d center = extents.origin;
  double reach = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const double low = extents.low[k], high = extents.high[k];
    center += (low + high) / 2 * in_double(extents.axes[k]);
    reach += std::max(std::abs(low), std::abs(high));
  }
  fitted.center = in_float(center);
  const double growth = 0x1p-19 * reach + std::numeric_limits<float>::min();
  for (std::size_t k = 0; k < 3; ++k) {
    const double along = dot(in_double(extents.axes[k]), in_double(fitted.center) - extents.origin);
    fitted.half_lengths[static_cast<int>(k)] =
        round_up(std::max(extents.high[k] - along, along - extents.low[k]) + growth);
  }
  return half_surface(fitted.half_lengths) < half_surface(aligned.half_lengths) ? fitted : aligned;
}

void set_child(ChildOrientedBoxes& boxes, int child, const OrientedBox& box) {
  for (int coordinate = 0; coordinate < 3; ++coordinate) {
    boxes.center[coordinate][child] = box.center[coordinate];
    boxes.half_lengths[coordinate][child] = box.half_lengths[coordinate];
    for (std::size_t axis = 0; axis < 3; ++axis)
      boxes.axes[axis][coordinate][child] = box.axes[axis][coordinate];
  }
}

/// Extends the extents by the vertices of a child.
void extend_by_child(const RefittedOctree& octree, std::uint32_t n, int child, AxisExtents& extents) {
  const OctreeNode& node = octree.nodes[n];
  if (node.is_inner(child) && octree.inert.empty()) {
    const std::uint32_t below = node.child_node(child);
    for (int k = 0; k < octree.nodes[below].child_count; ++k) extend_by_child(octree, below, k, extents);
    return;
  }
  for_each_vertex(octree, n, child, [&](std::uint32_t vertex) { extents.extend(octree.vertices[vertex]); });
}

class OrientedBoxes final : public NodeVolumes {
 public:
  explicit OrientedBoxes(std::size_t nodes)
      : NodeVolumes(BoundingVolume::obb, nodes), boxes_(nodes == 0 ? 0 : nodes + 1), moments_(nodes) {}

  void refit(const RefittedOctree& octree, std::uint32_t begin, std::uint32_t end) override {
    std::array<SurfaceMoments, node_width> of_leaves;
    refit_bottom_up(
        octree.nodes.data(), begin, end,
        [&](std::uint32_t n, int child) {
          const std::uint32_t* const first = octree.nodes[n].first_triangle + child;
          of_leaves[static_cast<std::size_t>(child)] = moments_of(octree, first[0], first[1]);
        },
        [&](std::uint32_t n) {
          const OctreeNode& node = octree.nodes[n];
          moments_[n] = {};
          for (int child = 0; child < node.child_count; ++child) {
            const SurfaceMoments& moments = node.is_inner(child) ? moments_[node.child_node(child)]
                                                                 : of_leaves[static_cast<std::size_t>(child)];
            moments_[n] += moments;
            set_child(boxes_[n], child,
                      fitted_box(moments, child_box(octree.boxes[n], child),
                                 [&](AxisExtents& extents) { extend_by_child(octree, n, child, extents); }));
          }
        });
  }

  void refit_object(const RefittedOctree& octree, const Aabb& box) override {
    set_child(boxes_.back(), 0, fitted_box(moments_[0], box, [&](AxisExtents& extents) {
                for (int child = 0; child < octree.nodes[0].child_count; ++child)
                  extend_by_child(octree, 0, child, extents);
              }));
  }

  void clear_apart(std::span<const NodePair> pairs, const NodeVolumes& b, const RelativePlacement& placement,
                   std::uint64_t* masks) const override {
    clear_boxes_apart(pairs, boxes_.data(), static_cast<const OrientedBoxes&>(b).boxes_.data(), placement,
                      masks);
  }

  std::vector<Slab> slabs(std::uint32_t node, int child, const Aabb&, Vec3d translation) const override {
    const ChildOrientedBoxes& boxes = boxes_[node];
    const auto vector_of = [&](const float(&numbers)[3][node_width]) {
      return Vec3f{numbers[0][child], numbers[1][child], numbers[2][child]};
    };
    const Vec3d center = in_double(vector_of(boxes.center));
    std::vector<Slab> result;
    for (int k = 0; k < 3; ++k) {
      const Vec3f axis = vector_of(boxes.axes[k]);
      const double along = dot(in_double(axis), center), half = boxes.half_lengths[k][child];
      result.push_back(moved_slab(axis, along - half, along + half, translation));
    }
    return result;
  }

  std::size_t bytes() const override {
    return boxes_.capacity() * sizeof(ChildOrientedBoxes) + moments_.capacity() * sizeof(SurfaceMoments);
  }

 private:
  std::vector<ChildOrientedBoxes> boxes_;
  std::vector<SurfaceMoments> moments_;  // of the nodes
};

}  // namespace

std::unique_ptr<NodeVolumes> make_oriented_boxes(std::size_t nodes) {
  return std::make_unique<OrientedBoxes>(nodes);
}

}  // namespace supple
