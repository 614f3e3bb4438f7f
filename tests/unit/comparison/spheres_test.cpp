// Spheres around nodes: enclosing, smallest, and safe for degenerate positions.

#include "comparison/methods.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "inspect/validation.hpp"
#include "octree/object_octree.hpp"
#include "supple/models.hpp"
#include "support/soups.hpp"
#include "support/topologies.hpp"

namespace supple::spheres_test {

/// An octree of spheres at the positions of its mesh.
struct Tree {
  Tree(const TriangleMesh& mesh, SphereFit fit, const ObjectOctreeOptions& options = {},
       std::uint32_t threads = 1)
      : octree(mesh.positions, mesh.triangles, options, BoundingVolume::sphere, fit) {
    const Parallel parallel(threads);
    vertices.assign(mesh.positions, parallel);
    if (octree.refit(vertices, {}, parallel)) return;
    inert.assign(octree.triangles().size(), 0);
    for (std::size_t t = 0; t < inert.size(); ++t) {
      for (const std::uint32_t v : octree.triangles()[t]) inert[t] |= !is_finite(vertices[v]);
    }
    octree.refit(vertices, inert, parallel);
  }

  ObjectOctree octree;
  VertexBuffer vertices;
  std::vector<std::uint8_t> inert;
};

/// A mesh whose vertices are the points.
TriangleMesh mesh_of(const std::vector<Vec3d>& points) {
  TriangleMesh mesh{"points", points, {}};
  const auto count = static_cast<std::uint32_t>(points.size());
  for (std::uint32_t v = 0; v < count; ++v) mesh.triangles.push_back({v, (v + 1) % count, (v + 2) % count});
  return mesh;
}

BoundingSphere sphere_of(const std::vector<Vec3d>& points, SphereFit fit = SphereFit::minimal) {
  return Tree(mesh_of(points), fit).octree.sphere();
}

/// The radius of the smallest sphere around the points: the smallest one of all spheres through two, three or
/// four of them that enclose all. Solves for the centre by least squares in the span of the points.
double smallest_radius(const std::vector<Vec3d>& points) {
  double smallest = std::numeric_limits<double>::infinity();
  const auto consider = [&](const Vec3d& center) {
    double squared_radius = 0;
    for (const Vec3d& p : points) squared_radius = std::max(squared_radius, squared_norm(p - center));
    smallest = std::min(smallest, std::sqrt(squared_radius));
  };
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const Vec3d p = points[i], a = points[j] - p;
      consider(p + a / 2);
      for (std::size_t k = 0; k < j; ++k) {
        const Vec3d b = points[k] - p;
        // The centre s a + t b has the same distance to all three points.
        const double aa = dot(a, a), ab = dot(a, b), bb = dot(b, b), d = 2 * (aa * bb - ab * ab);
        if (d > 0) consider(p + (bb * (aa - ab) / d) * a + (aa * (bb - ab) / d) * b);
        for (std::size_t l = 0; l < k; ++l) {
          const Vec3d c = points[l] - p;
          // Cramer's rule for the planes half way to each point.
          const double determinant = dot(a, cross(b, c));
          const Vec3d right{dot(a, a) / 2, dot(b, b) / 2, dot(c, c) / 2};
          const auto column = [&](int axis) {
            Vec3d x = a, y = b, z = c;
            x[axis] = right.x;
            y[axis] = right.y;
            z[axis] = right.z;
            return dot(x, cross(y, z)) / determinant;
          };
          if (determinant != 0) consider(p + Vec3d{column(0), column(1), column(2)});
        }
      }
    }
  }
  return smallest;
}

TEST(SphereFit, KnownSpheres) {
  const std::vector<Vec3d> cube{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0},
                                {0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {1, 1, 1}};
  EXPECT_NEAR(sphere_of(cube).radius, std::sqrt(0.75), 1e-6);
  const std::vector<Vec3d> tetrahedron{{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
  EXPECT_NEAR(sphere_of(tetrahedron).radius, std::sqrt(3.0), 1e-6);
  // A right triangle and a point inside: the middle of the longest side.
  const std::vector<Vec3d> right{{0, 0, 5}, {6, 0, 5}, {0, 8, 5}, {1, 1, 5}};
  EXPECT_NEAR(sphere_of(right).radius, 5, 1e-5);
  EXPECT_NEAR(sphere_of(right).center.x, 3, 1e-5);
  EXPECT_NEAR(sphere_of(right).center.y, 4, 1e-5);
  // The middle of the box is not the best centre for three corners of a cube.
  const std::vector<Vec3d> corners{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  EXPECT_NEAR(sphere_of(corners).radius, std::sqrt(2.0 / 3), 1e-6);
  EXPECT_NEAR(sphere_of(corners, SphereFit::vertices).radius, std::sqrt(0.75), 1e-6);
}

TEST(SphereFit, MinimalIsSmallest) {
  RandomNumbers random(3);
  for (int round = 0; round < 300; ++round) {
    std::vector<Vec3d> points(3 + random.below(9));
    const std::uint32_t kind = random.below(5);
    for (Vec3d& p : points) {
      p = random.vector(1);
      if (kind == 1) p = {p.x, 2 * p.x, 3 * p.x};  // collinear
      if (kind == 2) p = {p.x, p.y, p.x + p.y};    // coplanar
      if (kind == 3) p = p / norm(p);              // on a sphere
      if (kind == 4)
        p = {std::nearbyint(2 * p.x), std::nearbyint(2 * p.y), std::nearbyint(2 * p.z)};  // equal points
    }
    const double expected = smallest_radius(points), found = sphere_of(points).radius;
    EXPECT_GE(found, expected * (1 - 1e-12)) << round << " kind " << kind;
    EXPECT_LE(found, expected * (1 + 2e-6) + 1e-30) << round << " kind " << kind;
    if (HasFailure()) return;
  }
}

/// The farthest vertex of the mesh from a point.
double farthest(const TriangleMesh& mesh, const Vec3f& from) {
  double squared = 0;
  for (const Triangle& triangle : mesh.triangles) {
    for (const std::uint32_t v : triangle)
      squared = std::max(squared, squared_norm(mesh.positions[v] - Vec3d{from.x, from.y, from.z}));
  }
  return std::sqrt(squared);
}

TEST(SphereFit, ReachesTheFarthestVertexOfModels) {
  for (const char* model : {"pawn", "fish", "rabbit", "human", "bike"}) {
    const TriangleMesh mesh = make_model(model);
    for (const auto build :
         {ObjectOctreeBuild::balanced, ObjectOctreeBuild::regular, ObjectOctreeBuild::bottom_up}) {
      for (const SphereFit fit : {SphereFit::vertices, SphereFit::minimal}) {
        const Tree tree(mesh, fit, {.leaf_size = 4, .build = build});
        ASSERT_EQ(fault_of(tree.octree, tree.vertices, {}), "") << model;
        const BoundingSphere sphere = tree.octree.sphere();
        const double exact = farthest(mesh, sphere.center);
        EXPECT_GE(sphere.radius, exact);
        EXPECT_LE(sphere.radius, exact * (1 + 1e-6));
      }
    }
  }
}

/// Every minimal sphere is at most as large as the sphere of equation 5, and most are smaller.
TEST(SphereFit, MinimalIsNeverLarger) {
  for (const char* model : {"fish", "human", "bike"}) {
    const TriangleMesh mesh = make_model(model);
    const Tree wide(mesh, SphereFit::vertices, {.leaf_size = 1}),
        tight(mesh, SphereFit::minimal, {.leaf_size = 1});
    std::size_t children = 0, smaller = 0;
    for (std::uint32_t n = 0; n < wide.octree.nodes().size(); ++n) {
      for (int child = 0; child < wide.octree.nodes()[n].child_count; ++child) {
        const float w = wide.octree.volumes()->sphere(n, child).radius,
                    t = tight.octree.volumes()->sphere(n, child).radius;
        ASSERT_LE(t, w);
        ++children;
        smaller += t < 0.98f * w ? 1 : 0;
      }
    }
    EXPECT_GT(4 * smaller, children) << model;
  }
}

TEST(SphereFit, EnclosesDegeneratePositions) {
  RandomNumbers random(9);
  for (std::uint32_t count = 1; count < 300; count += 1 + count / 2) {
    for (std::uint32_t way = 0; way < hard_ways; ++way) {
      for (const SphereFit fit : {SphereFit::vertices, SphereFit::minimal}) {
        const TriangleMesh mesh = hard_positions(random_soup(count, 1, 0.1, count), way, random);
        const Tree tree(mesh, fit,
                        {.leaf_size = 1 + random.below(9),
                         .arity = 2u << random.below(3),
                         .build = ObjectOctreeBuild::regular});
        EXPECT_EQ(fault_of(tree.octree, tree.vertices, tree.inert), "") << count << " way " << way;
        if (HasFailure()) return;
      }
    }
  }
}

TEST(SphereFit, FarFromTheOrigin) {
  // Floats near 1e6 differ by 1/16, so the centre moves by less than that.
  std::vector<Vec3d> points;
  RandomNumbers random(4);
  for (int i = 0; i < 40; ++i) points.push_back(random.vector(1));
  const double near = sphere_of(points).radius;
  for (Vec3d& p : points) p = p + Vec3d{1e6, -1e6, 1e6};
  EXPECT_LE(sphere_of(points).radius, near + 0.06);
  EXPECT_GE(sphere_of(points).radius, near - 1e-6);
}

TEST(SphereFit, IsTheSameForAnyNumberOfThreads) {
  const TriangleMesh mesh = make_model("bike");
  for (const SphereFit fit : {SphereFit::vertices, SphereFit::minimal}) {
    const Tree one(mesh, fit, {.leaf_size = 2}), four(mesh, fit, {.leaf_size = 2}, 4);
    EXPECT_EQ(one.octree.sphere(), four.octree.sphere());
    for (std::uint32_t n = 0; n < one.octree.nodes().size(); ++n) {
      for (int child = 0; child < node_width; ++child)
        ASSERT_EQ(one.octree.volumes()->sphere(n, child), four.octree.volumes()->sphere(n, child));
    }
  }
}

}  // namespace supple::spheres_test
