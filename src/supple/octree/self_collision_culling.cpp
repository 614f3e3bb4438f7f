#include "octree/self_collision_culling.hpp"
#include "octree/object_octree.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/vector.hpp"
#include "octree/refit_bottom_up.hpp"

namespace supple {
namespace {

/// Half an ulp of 1: the relative error of one rounding.
constexpr double rounding = 0x1p-53;
/// Covers what products lose below the range of double; useful coordinates are far larger.
constexpr double underflow = 1e-290;

double sum_of_sizes(const Vec3d& v) {
  return std::abs(v.x) + std::abs(v.y) + std::abs(v.z);
}

template <class Scalar>
Vec3d position(const VertexArray<Scalar>& vertices, std::uint32_t vertex) {
  const Scalar* const p = vertices[vertex];
  return {p[0], p[1], p[2]};
}

/// The boundary of a smooth patch is about as long as the square root of its size. With this limit the total
/// length of all boundaries is linear. Patches with longer boundaries would fail the test anyway.
std::size_t longest_boundary(std::uint32_t triangles) {
  return 16 + 8 * static_cast<std::size_t>(std::sqrt(triangles));
}

/// Removes pairs of an edge and its reverse.
void cancel_opposite(std::vector<Edge>& edges) {
  const auto undirected = [](const Edge& e) { return Edge{std::min(e[0], e[1]), std::max(e[0], e[1])}; };
  std::sort(edges.begin(), edges.end(), [&](const Edge& p, const Edge& q) {
    const Edge u = undirected(p), v = undirected(q);
    return u != v ? u < v : p < q;
  });
  std::size_t kept = 0;
  for (std::size_t i = 0; i < edges.size();) {
    const Edge edge = undirected(edges[i]);
    std::size_t forth = 0, back = 0;
    for (; i < edges.size() && undirected(edges[i]) == edge; ++i) ++(edges[i] == edge ? forth : back);
    const Edge left = forth > back ? edge : Edge{edge[1], edge[0]};
    // Writes at most as many edges as were read, so it overwrites no unread edge.
    for (std::size_t k = std::min(forth, back); k < std::max(forth, back); ++k) edges[kept++] = left;
  }
  edges.resize(kept);
}

}  // namespace

SelfCollisionCulling::SelfCollisionCulling(const ObjectOctree& octree, std::span<const Triangle> triangles)
    : boundaries_(octree.nodes().size() * node_width),
      node_normals_(octree.nodes().size()),
      masks_(octree.nodes().size(), 0) {
  std::vector<Edge> edges;
  const auto set_boundary = [&](std::uint32_t n, int child) {
    cancel_opposite(edges);
    if (edges.size() > longest_boundary(octree.nodes()[n].size(child))) return;
    const auto begin = static_cast<std::uint32_t>(boundary_edges_.size());
    boundary_edges_.insert(boundary_edges_.end(), edges.begin(), edges.end());
    boundaries_[std::size_t{n} * node_width + static_cast<std::size_t>(child)] = {
        begin, static_cast<std::uint32_t>(boundary_edges_.size())};
  };
  refit_bottom_up(
      octree.nodes().data(), 0, static_cast<std::uint32_t>(octree.nodes().size()),
      [&](std::uint32_t n, int child) {
        const OctreeNode& node = octree.nodes()[n];
        edges.clear();
        for (const Triangle& triangle : triangles.subspan(node.first_triangle[child], node.size(child))) {
          for (std::size_t corner = 0; corner < 3; ++corner)
            edges.push_back({triangle[corner], triangle[(corner + 1) % 3]});
        }
        set_boundary(n, child);
      },
      [&](std::uint32_t n) {
        const OctreeNode& node = octree.nodes()[n];
        if (node.parent == n) return;
        const auto parts = std::span(boundaries_).subspan(std::size_t{n} * node_width, node.child_count);
        // If a part has no boundary, neither has the whole: smooth surfaces rarely have such parts.
        if (std::ranges::any_of(parts, [](const Boundary& b) { return b.begin == b.end; })) return;
        edges.clear();
        for (const Boundary& part : parts)
          edges.insert(edges.end(), boundary_edges_.begin() + part.begin, boundary_edges_.begin() + part.end);
        set_boundary(node.parent, node.index_in_parent);
      });
  boundary_edges_.shrink_to_fit();
}

void SelfCollisionCulling::refit(const ObjectOctree& octree, std::span<const Triangle> triangles,
                                 const VertexBuffer& start, const VertexBuffer& end,
                                 const Parallel& parallel) {
  octree.for_nodes_bottom_up(parallel, 64, [&](std::uint32_t node_begin, std::uint32_t node_end) {
    if (start.is_double()) {
      refit_nodes(octree.nodes(), triangles, start.doubles(), end.doubles(), node_begin, node_end);
    } else {
      refit_nodes(octree.nodes(), triangles, start.floats(), end.floats(), node_begin, node_end);
    }
  });
}

template <class Scalar>
void SelfCollisionCulling::refit_nodes(std::span<const OctreeNode> nodes, std::span<const Triangle> triangles,
                                       const VertexArray<Scalar>& start, const VertexArray<Scalar>& end,
                                       std::uint32_t node_begin, std::uint32_t node_end) {
  Normals of_leaves[node_width];
  refit_bottom_up(
      nodes.data(), node_begin, node_end,
      [&](std::uint32_t n, int child) {
        const auto part = triangles.subspan(nodes[n].first_triangle[child], nodes[n].size(child));
        of_leaves[child] = normals_of(part, start, end);
      },
      [&](std::uint32_t n) {
        const OctreeNode& node = nodes[n];
        Normals all;
        std::uint32_t mask = 0;
        for (int child = 0; child < node.child_count; ++child) {
          const Normals& normals =
              node.is_inner(child) ? node_normals_[node.child_node(child)] : of_leaves[child];
          double least = 0, size = 0;
          const Vec3d direction = normals.sum * (1 / largest_magnitude(normals.sum));
          for (int axis = 0; axis < 3; ++axis) {
            all.sum[axis] += normals.sum[axis];
            all.low[axis] = std::min(all.low[axis], normals.low[axis]);
            all.high[axis] = std::max(all.high[axis], normals.high[axis]);
            least += std::min(direction[axis] * normals.low[axis], direction[axis] * normals.high[axis]);
            size += std::abs(direction[axis]);
          }
          // False for NaN. The error of the bounds is at most 2^-21 (`normals_of`), that of this sum far
          // less.
          const bool all_face = least > size * 0x1p-20;
          const Boundary& boundary =
              boundaries_[std::size_t{n} * node_width + static_cast<std::size_t>(child)];
          if (all_face && goes_round_once(boundary, direction, start, end)) mask |= 1u << child;
        }
        node_normals_[n] = all;
        masks_[n] = static_cast<std::uint8_t>(mask);
      });
}

/// Uses the three Bernstein coefficients of each triangle's normal, scaled. Let E and F be the largest
/// coordinates of two sides at both ends. The error of a coefficient is less than 16 roundings of E F. Its
/// largest coordinate m is compared with E F, so that the error is below 2^-21 m.
template <class Scalar>
SelfCollisionCulling::Normals SelfCollisionCulling::normals_of(std::span<const Triangle> triangles,
                                                               const VertexArray<Scalar>& start,
                                                               const VertexArray<Scalar>& end) {
  constexpr Normals hopeless{{}, {-1, -1, -1}, {1, 1, 1}};
  static_assert(16 * rounding <= 0x1p-21 * 0x1p-28);
  const bool at_rest = start.data == end.data;
  Normals normals;
  for (const Triangle& triangle : triangles) {
    const Vec3d a0 = position(start, triangle[0]), a1 = position(end, triangle[0]);
    const Vec3d e0 = position(start, triangle[1]) - a0, e1 = position(end, triangle[1]) - a1;
    const Vec3d f0 = position(start, triangle[2]) - a0, f1 = position(end, triangle[2]) - a1;
    const double least_size = std::max(largest_magnitude(e0), largest_magnitude(e1)) *
                                  std::max(largest_magnitude(f0), largest_magnitude(f1)) * 0x1p-28 +
                              underflow;
    const Vec3d coefficients[3] = {cross(e0, f0), (cross(e0, f1) + cross(e1, f0)) * 0.5, cross(e1, f1)};
    for (const Vec3d& coefficient : std::span(coefficients).first(at_rest ? 1 : 3)) {
      const double size = largest_magnitude(coefficient);
      const Vec3d normal = coefficient * (1 / size);
      // NaN and overflow fail this test. So does a normal that turns away from the others.
      const bool reliable = size > least_size && std::isfinite(dot(normal, {1, 1, 1}));
      if (!reliable || dot(normal, normals.sum) < 0) return hopeless;
      normals.sum = normals.sum + normal;
      for (int axis = 0; axis < 3; ++axis) {
        normals.low[axis] = std::min(normals.low[axis], normal[axis]);
        normals.high[axis] = std::max(normals.high[axis], normal[axis]);
      }
    }
  }
  return normals;
}

/// An edge from u to v turns around the centre by the sign of n · (u × v), which is quadratic in time. Let R
/// be the largest coordinate of any u, and |n| the sum of the magnitudes of n. The error of a coefficient is
/// less than 32 roundings of |n| R².
template <class Scalar>
bool SelfCollisionCulling::goes_round_once(const Boundary& boundary, const Vec3d& n,
                                           const VertexArray<Scalar>& start,
                                           const VertexArray<Scalar>& end) const {
  if (boundary.begin == boundary.end) return false;
  const auto edges =
      std::span<const Edge>(boundary_edges_).subspan(boundary.begin, boundary.end - boundary.begin);
  // The proof holds for any centre from which the boundary is star-shaped. The mean of the vertices often is.
  Vec3d center_0, center_1;
  for (const Edge& edge : edges) {
    center_0 = center_0 + position(start, edge[0]);
    center_1 = center_1 + position(end, edge[0]);
  }
  center_0 = center_0 * (1 / static_cast<double>(edges.size()));
  center_1 = center_1 * (1 / static_cast<double>(edges.size()));
  // The boundary goes around once if it crosses a line through the centre once in each direction. The sign of
  // the product with a direction across n tells the side of a vertex at the start. The direction is skewed,
  // because regular meshes have vertices on lines along the axes. The error of the direction and of the
  // product is less than 64 roundings.
  const Vec3d sizes{std::abs(n.x), std::abs(n.y), std::abs(n.z)};
  const int flat = sizes.x <= sizes.y ? (sizes.x <= sizes.z ? 0 : 2) : (sizes.y <= sizes.z ? 1 : 2);
  Vec3d slanted;
  slanted[flat] = 1;
  slanted[(flat + 1) % 3] = 0.37;
  slanted[(flat + 2) % 3] = 0.23;
  const Vec3d across = cross(n, slanted);

  double reach = 0, least_turn = std::numeric_limits<double>::infinity(), least_side = least_turn;
  int times_round = 0;
  for (const Edge& edge : edges) {
    const Vec3d u0 = position(start, edge[0]) - center_0, v0 = position(start, edge[1]) - center_0;
    const Vec3d u1 = position(end, edge[0]) - center_1, v1 = position(end, edge[1]) - center_1;
    const double turns[3] = {dot(n, cross(u0, v0)), (dot(n, cross(u0, v1)) + dot(n, cross(u1, v0))) * 0.5,
                             dot(n, cross(u1, v1))};
    for (const double turn : turns) {
      if (!(turn > 0)) return false;
      least_turn = std::min(least_turn, turn);
    }
    reach = std::max(
        {reach, largest_magnitude(u0), largest_magnitude(u1), largest_magnitude(v0), largest_magnitude(v1)});
    least_side = std::min(least_side, std::abs(dot(across, u0)));
    times_round += dot(across, u0) < 0 && dot(across, v0) >= 0 ? 1 : 0;
  }
  const double size = sum_of_sizes(n);
  return least_turn > 32 * rounding * size * reach * reach + underflow &&
         least_side > 64 * rounding * size * reach + underflow && times_round == 1;
}

std::size_t SelfCollisionCulling::bytes() const {
  return boundary_edges_.capacity() * sizeof(Edge) + boundaries_.capacity() * sizeof(Boundary) +
         node_normals_.capacity() * sizeof(Normals) + masks_.capacity();
}

}  // namespace supple
