// Spheres around nodes: enclosing, smallest, and safe for degenerate positions.

#include "comparison/methods.hpp"
#include "comparison/volumes/medial_axis.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "geometry/vector.hpp"
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
    refit(mesh.positions, threads);
  }

  void refit(const std::vector<Vec3d>& positions, std::uint32_t threads = 1) {
    const Parallel parallel(threads);
    vertices.assign(positions, parallel);
    inert.clear();
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

/// Calls `visit(n, child)` for the children of all nodes and for the whole object.
template <class Visit>
void for_each_sphere(const ObjectOctree& octree, const Visit& visit) {
  const auto nodes = static_cast<std::uint32_t>(octree.nodes().size());
  for (std::uint32_t n = 0; n < nodes; ++n) {
    for (int child = 0; child < octree.nodes()[n].child_count; ++child) visit(n, child);
  }
  visit(nodes, 0);
}

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
      for (const SphereFit fit : {SphereFit::vertices, SphereFit::minimal, SphereFit::medial}) {
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

/// Every minimal sphere is at most as large as the sphere of equation 5, and many are smaller. So are medial
/// spheres, which are not smaller than minimal ones.
TEST(SphereFit, MinimalAndMedialAreNeverLarger) {
  for (const char* model : {"fish", "human", "bike"}) {
    for (const std::uint32_t leaf_size : {1u, 64u}) {
      const TriangleMesh mesh = make_model(model);
      const Tree wide(mesh, SphereFit::vertices, {.leaf_size = leaf_size}),
          tight(mesh, SphereFit::minimal, {.leaf_size = leaf_size}),
          medial(mesh, SphereFit::medial, {.leaf_size = leaf_size});
      std::size_t all = 0, smaller = 0, medial_smaller = 0;
      for_each_sphere(wide.octree, [&](std::uint32_t n, int child) {
        const float w = wide.octree.volumes()->sphere(n, child).radius,
                    t = tight.octree.volumes()->sphere(n, child).radius,
                    m = medial.octree.volumes()->sphere(n, child).radius;
        EXPECT_LE(t, w);
        EXPECT_LE(m, w);
        EXPECT_GE(m, t * (1 - 1e-6f));
        ++all;
        smaller += t < 0.98f * w ? 1 : 0;
        medial_smaller += m < 0.98f * w ? 1 : 0;
      });
      EXPECT_GT(4 * smaller, all) << model;
      // Medial centres are far from small leaves.
      EXPECT_GT((leaf_size == 1 ? 200 : 25) * medial_smaller, all) << model;
    }
  }
}

/// The axis of a torus is the circle in its tube.
TEST(MedialAxis, OfATorus) {
  const TriangleMesh mesh = make_torus(60, 24, 0.5, 0.2);
  const Tree tree(mesh, SphereFit::vertices);
  const RefittedOctree octree{tree.octree.nodes(),
                              tree.octree.boxes(),
                              tree.octree.triangles(),
                              tree.octree.leaf_vertices(),
                              tree.vertices,
                              {},
                              {}};
  const std::vector<double> depths = medial_depths(octree);
  ASSERT_EQ(depths.size(), mesh.triangles.size());
  for (std::uint32_t t = 0; t < depths.size(); ++t) {
    const Vec3d at = MedialCenter{t, depths[t]}.position(octree);
    EXPECT_NEAR(std::hypot(at.x, at.z), 0.5, 0.03);
    EXPECT_NEAR(at.y, 0, 0.03);
  }
}

/// A cone in the direction of an axis, with rings of vertices.
TriangleMesh cone(const Vec3d& axis, double radius) {
  constexpr std::uint32_t sides = 48, rings = 20;
  const Vec3d u = normalized(cross(axis, {0, 0, 1})), v = cross(normalized(axis), u);
  TriangleMesh mesh{"cone", {{0, 0, 0}, axis}, {}};
  for (std::uint32_t ring = 0; ring < rings; ++ring) {
    for (std::uint32_t side = 0; side < sides; ++side) {
      const double angle = 2 * std::numbers::pi * side / sides, height = double{1} * ring / rings;
      mesh.positions.push_back(height * axis +
                               radius * (1 - height) * (std::cos(angle) * u + std::sin(angle) * v));
      const std::uint32_t next = (side + 1) % sides, low = 2 + ring * sides, high = low + sides;
      if (ring == 0) mesh.triangles.push_back({0, low + next, low + side});
      if (ring + 1 == rings) {
        mesh.triangles.push_back({low + side, low + next, 1});
        continue;
      }
      mesh.triangles.push_back({low + side, low + next, high + side});
      mesh.triangles.push_back({low + next, high + next, high + side});
    }
  }
  return mesh;
}

/// The sphere through the circle and the tip of a cone is around a point of its medial axis, which is not
/// the middle of the box.
TEST(SphereFit, MedialCenterOfACone) {
  const Vec3d axis{2, 1, 0.5};
  const TriangleMesh mesh = cone(axis, 1);
  const BoundingSphere medial = Tree(mesh, SphereFit::medial).octree.sphere(),
                       minimal = Tree(mesh, SphereFit::minimal).octree.sphere(),
                       vertices = Tree(mesh, SphereFit::vertices).octree.sphere();
  EXPECT_LT(medial.radius, 1.04f * minimal.radius);
  EXPECT_GT(vertices.radius, 1.06f * minimal.radius);
  EXPECT_LT(norm(cross(in_double(medial.center), axis)) / norm(axis), 0.05);
}

/// Turned by 90 degrees, twice as large and elsewhere: so are the spheres.
TEST(SphereFit, MedialCentersMoveWithTheObject) {
  TriangleMesh mesh = make_model("rabbit");
  Tree tree(mesh, SphereFit::medial, {.leaf_size = 8});
  const Tree rest(mesh, SphereFit::medial, {.leaf_size = 8}),
      wide(mesh, SphereFit::vertices, {.leaf_size = 8});
  const auto moved = [](const Vec3d& p) { return Vec3d{3 - 2 * p.y, 2 * p.x + 1, 2 * p.z}; };
  std::ranges::transform(mesh.positions, mesh.positions.begin(), moved);
  tree.refit(mesh.positions);
  std::size_t elsewhere = 0;
  for_each_sphere(rest.octree, [&](std::uint32_t n, int child) {
    const BoundingSphere before = rest.octree.volumes()->sphere(n, child),
                         after = tree.octree.volumes()->sphere(n, child);
    EXPECT_NEAR(after.radius, 2 * before.radius, 1e-5);
    EXPECT_LT(norm(in_double(after.center) - moved(in_double(before.center))), 1e-5);
    elsewhere += before != wide.octree.volumes()->sphere(n, child) ? 1 : 0;
  });
  EXPECT_GT(elsewhere, 20u);
}

TEST(SphereFit, MedialEnclosesAfterDeformations) {
  RandomNumbers random(5);
  TriangleMesh mesh = make_torus(40, 16);
  Tree tree(mesh, SphereFit::medial, {.leaf_size = 4}), wide(mesh, SphereFit::vertices, {.leaf_size = 4});
  for (int step = 0; step < 20; ++step) {
    for (Vec3d& p : mesh.positions)
      p = Vec3d{p.x + 0.1 * p.y * p.y, 1.1 * p.y, 0.9 * p.z} + random.vector(0.02);
    if (step % 5 == 1) mesh.positions[random.below(100)] = {std::nan(""), 0, 0};
    if (step % 5 == 2) mesh.positions = std::vector<Vec3d>(mesh.positions.size(), Vec3d{1, 2, 3});
    if (step % 5 == 3) mesh.positions = make_torus(40, 16).positions;
    tree.refit(mesh.positions);
    wide.refit(mesh.positions);
    ASSERT_EQ(fault_of(tree.octree, tree.vertices, tree.inert), "") << step;
    for_each_sphere(tree.octree, [&](std::uint32_t n, int child) {
      EXPECT_LE(tree.octree.volumes()->sphere(n, child).radius,
                wide.octree.volumes()->sphere(n, child).radius);
    });
  }
}

TEST(SphereFit, EnclosesDegeneratePositions) {
  RandomNumbers random(9);
  for (std::uint32_t count = 1; count < 300; count += 1 + count / 2) {
    for (std::uint32_t way = 0; way < hard_ways; ++way) {
      for (const SphereFit fit : {SphereFit::vertices, SphereFit::minimal, SphereFit::medial}) {
        const TriangleMesh mesh_at_rest = random_soup(count, 1, 0.1, count);
        const TriangleMesh mesh = hard_positions(mesh_at_rest, way, random);
        Tree tree(mesh, fit,
                  {.leaf_size = 1 + random.below(9),
                   .arity = 2u << random.below(3),
                   .build = ObjectOctreeBuild::regular});
        EXPECT_EQ(fault_of(tree.octree, tree.vertices, tree.inert), "") << count << " way " << way;
        tree.refit(hard_positions(mesh_at_rest, (way + 3) % hard_ways, random).positions);
        EXPECT_EQ(fault_of(tree.octree, tree.vertices, tree.inert), "") << count << " after way " << way;
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
  for (const SphereFit fit : {SphereFit::vertices, SphereFit::minimal, SphereFit::medial}) {
    const Tree one(mesh, fit, {.leaf_size = 2}), four(mesh, fit, {.leaf_size = 2}, 4);
    for_each_sphere(one.octree, [&](std::uint32_t n, int child) {
      EXPECT_EQ(one.octree.volumes()->sphere(n, child), four.octree.volumes()->sphere(n, child));
    });
  }
}

}  // namespace supple::spheres_test
