#include "octree/volumes/node_volumes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "inspect/polytope.hpp"
#include "inspect/validation.hpp"
#include "octree/object_octree.hpp"
#include "supple/inspection.hpp"
#include "supple/models.hpp"
#include "supple/trigonometry.hpp"
#include "support/random.hpp"
#include "support/scenes.hpp"
#include "support/soups.hpp"

namespace supple::node_volumes_test {

/// An octree of single triangles, refitted.
struct Built {
  Built(const TriangleMesh& mesh, BoundingVolume volume)
      : octree(mesh.positions, mesh.triangles, {.leaf_size = 1}, volume, SphereFit::vertices) {
    vertices.assign(mesh.positions, Parallel(1));
    EXPECT_TRUE(octree.refit(vertices, {}, Parallel(2)));
    EXPECT_EQ(fault_of(octree, vertices, {}), "");
  }
  /// Sum of the surfaces of all children.
  double surface() const {
    double sum = 0;
    for (std::uint32_t n = 0; n < octree.nodes().size(); ++n) {
      for (int child = 0; child < octree.nodes()[n].child_count; ++child) {
        const Aabb box = child_box(octree.boxes()[n], child);
        sum += Polytope(octree.volumes()->slabs(n, child, box, {})).surface();
      }
    }
    return sum;
  }
  double surface_of_boxes() const {
    double sum = 0;
    for (std::uint32_t n = 0; n < octree.nodes().size(); ++n) {
      for (int child = 0; child < octree.nodes()[n].child_count; ++child)
        sum += 2 * half_surface(child_box(octree.boxes()[n], child));
    }
    return sum;
  }

  ObjectOctree octree;
  VertexBuffer vertices;
};

TriangleMesh turned(TriangleMesh mesh, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  for (Vec3d& p : mesh.positions) {
    p = {c * p.x - s * p.y, s * p.x + c * p.y, p.z};
    p = {p.x, c * p.y - s * p.z, s * p.y + c * p.z};
  }
  return mesh;
}

/// A rod along x.
TriangleMesh rod() {
  TriangleMesh mesh = make_icosphere(4);
  for (Vec3d& p : mesh.positions) p = {8 * p.x, p.y, 0.5 * p.z};
  return mesh;
}

TEST(NodeVolumes, OrientedBoxesTurnWithTheObject) {
  const Built straight(rod(), BoundingVolume::obb), oblique(turned(rod(), 0.7), BoundingVolume::obb);
  const auto surface_of_object = [](const Built& built) {
    const NodeVolumes& volumes = *built.octree.volumes();
    return Polytope(volumes.slabs(volumes.object(), 0, built.octree.box(), {})).surface();
  };
  EXPECT_NEAR(surface_of_object(oblique) / surface_of_object(straight), 1, 1e-4);
  EXPECT_LT(surface_of_object(oblique), half_surface(oblique.octree.box()));
  // The children of the two octrees are not the same.
  EXPECT_LT(oblique.surface(), 0.8 * oblique.surface_of_boxes());
}

TEST(NodeVolumes, OrientedBoxesAreNeverLargerThanBoxes) {
  for (const TriangleMesh& mesh : {random_soup(500, 1, 0.2, 1), rod(), turned(rod(), 0.3)}) {
    const Built built(mesh, BoundingVolume::obb);
    for (std::uint32_t n = 0; n < built.octree.nodes().size(); ++n) {
      for (int child = 0; child < built.octree.nodes()[n].child_count; ++child) {
        const Aabb box = child_box(built.octree.boxes()[n], child);
        const double surface = Polytope(built.octree.volumes()->slabs(n, child, box, {})).surface();
        EXPECT_LE(surface, 2 * half_surface(box) * (1 + 1e-5));
      }
    }
  }
}

TEST(NodeVolumes, MoreDirectionsAreTighter) {
  const TriangleMesh mesh = turned(rod(), 0.4);
  const double s14 = Built(mesh, BoundingVolume::kdop14).surface();
  const double s18 = Built(mesh, BoundingVolume::kdop18).surface();
  const double s26 = Built(mesh, BoundingVolume::kdop26).surface();
  EXPECT_LT(s14, Built(mesh, BoundingVolume::kdop14).surface_of_boxes());
  EXPECT_LT(s26, s14);
  EXPECT_LT(s26, s18);
}

/// The extent along every direction is that of the vertices, except for rounding.
TEST(NodeVolumes, SlabsAreTight) {
  const TriangleMesh mesh = random_soup(300, 1, 0.2, 2);
  const Built built(mesh, BoundingVolume::kdop26);
  const NodeVolumes& volumes = *built.octree.volumes();
  for (const Slab& slab : volumes.slabs(volumes.object(), 0, built.octree.box(), {})) {
    const Vec3d direction{slab.direction.x, slab.direction.y, slab.direction.z};
    double low = INFINITY, high = -INFINITY;
    for (const Vec3d& p : mesh.positions) {
      low = std::min(low, dot(direction, p));
      high = std::max(high, dot(direction, p));
    }
    EXPECT_NEAR(slab.low, low, 1e-5);
    EXPECT_NEAR(slab.high, high, 1e-5);
    EXPECT_LE(slab.low, low);
    EXPECT_GE(slab.high, high);
  }
}

/// A leaf without a finite triangle must not enlarge the volumes above it.
TEST(NodeVolumes, InertTrianglesDoNotEnlargeVolumes) {
  for (const BoundingVolume volume : {BoundingVolume::obb, BoundingVolume::kdop14, BoundingVolume::kdop26}) {
    TriangleMesh mesh = turned(rod(), 0.6);
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(), 3, Vec3d{NAN, 0, 0});
    mesh.triangles.push_back({first, first + 1, first + 2});
    Scene scene({.bounding_volume = volume});
    for (int i = 0; i < 2; ++i) scene.add(mesh, ObjectOptions{.octree = {.leaf_size = 1}});
    scene.translate(scene.objects()[1], {-3.5, 4, 0});
    EXPECT_TRUE(scene.detect().object_pairs.empty()) << name_of(volume);
    EXPECT_EQ(SceneInspector(scene).validate(), "");
  }
}

TEST(NodeVolumes, DegenerateObjectsStayValid) {
  const std::vector<std::vector<Vec3d>> shapes{
      {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}},                                    // a point
      {{0, 0, 0}, {1, 1, 1}, {3, 3, 3}},                                    // a line
      {{0, 0, 0}, {1, 1, 1}, {3, 3, 3}, {5, 5, 5}},                         // two triangles on a line
      {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}},                         // a plane
      {{1e19, 0, 0}, {-1e19, 1, 0}, {0, 1e19, 0}, {1, 1, 1e30}},            // squares of areas overflow float
      {{1e38, 1e38, 1e38}, {-1e38, -1e38, 1e38}, {3e38, 0, 0}, {0, 1, 0}},  // sums overflow float
      {{1e300, 0, 0}, {0, -1e300, 0}, {0, 0, 1e300}, {1, 1, 1}},
      {{1e-310, 0, 0}, {0, 1e-320, 0}, {0, 0, 1e-300}, {0, 0, 0}},
      {{1e9, 1e9, 1e9}, {1e9 + 1e-6, 1e9, 1e9}, {1e9, 1e9 + 1e-6, 1e9}, {1e9, 1e9, 1e9 + 1e-6}}};
  for (const std::vector<Vec3d>& positions : shapes) {
    TriangleMesh mesh;
    mesh.positions = positions;
    for (std::uint32_t i = 2; i < positions.size(); ++i) mesh.triangles.push_back({i - 2, i - 1, i});
    for (const BoundingVolume volume : all_bounding_volumes) {
      SCOPED_TRACE(name_of(volume) + " " + std::to_string(&positions - shapes.data()));
      const Built built(mesh, volume);
      Scene scene({.bounding_volume = volume});
      scene.add(mesh);
      scene.add(mesh);
      scene.detect();
      EXPECT_EQ(differences(scene), "");
      EXPECT_EQ(scene.result().contacts.size(), mesh.triangles.size() * mesh.triangles.size());
    }
  }
}

/// Objects that touch or nearly touch, at oblique angles and far from the origin. Volumes that miss any
/// contact of brute force fail.
TEST(NodeVolumes, EveryContactOfTouchingObjectsIsFound) {
  RandomNumbers random(11);
  const auto number = [&] { return random.uniform(-1, 1); };
  for (int round = 0; round < 150; ++round) {
    const TriangleMesh shape = turned(rod(), 3 * number());
    TriangleMesh other = turned(rod(), 3 * number());
    // A vertex of the other object is moved onto a vertex of the first.
    const Vec3d onto = shape.positions[random.below(static_cast<std::uint32_t>(shape.positions.size()))];
    const Vec3d from = other.positions[random.below(static_cast<std::uint32_t>(other.positions.size()))];
    for (Vec3d& p : other.positions) p += onto - from;
    const double far = round % 3 == 0 ? 0 : round % 3 == 1 ? 1e4 : 1e9;
    const Vec3d place{far * number(), far * number(), far * number()};
    std::vector<Contact> expected;
    for (const BoundingVolume volume : all_bounding_volumes) {
      Scene scene({.bounding_volume = volume, .contact_points = false});
      const ObjectId a = scene.add(shape, {.octree = {.leaf_size = 4}});
      const ObjectId b = scene.add(other, {.octree = {.leaf_size = 4}});
      scene.translate(a, place);
      scene.translate(b, place);
      const auto contacts = scene.detect().contacts;
      if (volume == BoundingVolume::aabb) {
        expected.assign(contacts.begin(), contacts.end());
        ASSERT_EQ(differences(scene), "");
      }
      ASSERT_TRUE(std::equal(contacts.begin(), contacts.end(), expected.begin(), expected.end()))
          << name_of(volume) << ' ' << round;
    }
  }
}

TEST(NodeVolumes, TighterVolumesHaveFewerCandidatesAndPairs) {
  const TriangleMesh shape = turned(rod(), 0.6);
  std::uint64_t candidates_of_boxes = 0;
  for (const BoundingVolume volume : {BoundingVolume::aabb, BoundingVolume::obb, BoundingVolume::kdop26}) {
    Scene scene({.bounding_volume = volume});
    scene.add(shape, {.octree = {.leaf_size = 2}});
    scene.add(shape, {.octree = {.leaf_size = 2}});
    scene.translate(scene.objects()[1], {0.4, 0.7, -0.2});
    const StepStats& stats = scene.detect().stats;
    if (volume == BoundingVolume::aabb) {
      candidates_of_boxes = stats.candidate_pairs;
    } else {
      EXPECT_LT(stats.candidate_pairs, candidates_of_boxes) << name_of(volume);
    }
  }
  // Two oblique rods side by side: boxes overlap, the others are apart.
  for (const BoundingVolume volume : all_bounding_volumes) {
    Scene scene({.bounding_volume = volume});
    scene.add(shape);
    scene.add(shape);
    scene.translate(scene.objects()[1], {-3.5, 4, 0});
    EXPECT_EQ(scene.detect().object_pairs.empty(),
              volume != BoundingVolume::aabb && volume != BoundingVolume::sphere)
        << name_of(volume);
  }
}

}  // namespace supple::node_volumes_test
