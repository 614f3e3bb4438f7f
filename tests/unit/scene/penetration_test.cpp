// Vertices inside solids, contained parts and curves of intersection.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <stop_token>
#include <string>
#include <type_traits>
#include <vector>

#include "supple/error.hpp"
#include "supple/models.hpp"
#include "supple/scene.hpp"
#include "supple/triangle_intersection.hpp"
#include "supple/trigonometry.hpp"
#include "supple/verify.hpp"
#include "support/random.hpp"
#include "support/scenes.hpp"

namespace supple::penetration_test {

constexpr SceneOptions penetration{.contacts = ContactKinds::penetration, .curves = true};

TriangleMesh moved_mesh(TriangleMesh mesh, Vec3d offset, double scale = 1) {
  for (Vec3d& p : mesh.positions) p = p * scale + offset;
  return mesh;
}

TriangleMesh joined(TriangleMesh mesh, const TriangleMesh& other) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  mesh.positions.insert(mesh.positions.end(), other.positions.begin(), other.positions.end());
  for (const Triangle& t : other.triangles)
    mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  return mesh;
}

TriangleMesh tetrahedron(const std::array<Vec3d, 4>& corners) {
  return {"tetrahedron", {corners.begin(), corners.end()}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};
}

/// A box of edge 2 around the origin.
TriangleMesh box() {
  return make_box({2, 2, 2});
}

std::string message_of(Scene& scene, const TriangleMesh& mesh) {
  try {
    scene.add(mesh, {.solid = true});
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

std::vector<std::uint32_t> vertices_of(std::span<const Penetration> penetrations) {
  std::vector<std::uint32_t> vertices;
  for (const Penetration& p : penetrations) vertices.push_back(p.vertex);
  return vertices;
}

template <class Item>
std::vector<Item> list_of(std::span<const Item> items) {
  return {items.begin(), items.end()};
}

TEST(Penetration, HasDepthAndTheWayOut) {
  Scene scene(penetration);
  const ObjectId b = scene.add(box(), {.solid = true});
  const ObjectId a = scene.add(tetrahedron({{{0.25, 0.5, 0.75}, {0, 1, 3}, {-1, -1, 3}, {1, -1, 3}}}));
  const DetectResult& result = scene.detect();
  ASSERT_EQ(result.penetration_groups.size(), 1u);
  EXPECT_EQ(result.penetration_groups[0].a, a);
  EXPECT_EQ(result.penetration_groups[0].b, b);
  ASSERT_EQ(result.penetrations.size(), 1u);
  const Penetration& p = result.penetrations[0];
  EXPECT_EQ(p.object_a, a);
  EXPECT_EQ(p.vertex, 0u);
  EXPECT_EQ(p.depth, 0.25);
  EXPECT_EQ(p.point, (Vec3d{0.25, 0.5, 1}));
  EXPECT_EQ(p.normal, (Vec3d{0, 0, 1}));
  EXPECT_EQ(p.feature.kind, FeatureKind::face);
  EXPECT_FALSE(result.contacts.empty());
  EXPECT_TRUE(result.contained_parts.empty());
  EXPECT_EQ(result.stats.penetrations, 1u);
  EXPECT_TRUE(verify(scene).agrees());
  EXPECT_EQ(verify(scene).inside_vertices, 1u);
}

TEST(Penetration, VerticesOnTheSurfaceAreToldApart) {
  Scene scene(penetration);
  const ObjectId b = scene.add(box(), {.solid = true});
  scene.add(tetrahedron({{{0.25, 0.5, 1}, {0, 0, 3}, {-1, -1, 3}, {0, 0, -0.5}}}));
  const DetectResult& result = scene.detect();
  ASSERT_EQ(result.penetration_groups.size(), 1u);
  EXPECT_EQ(list_of(result.vertices_on_surface_of(result.penetration_groups[0])),
            (std::vector<std::uint32_t>{0}));
  EXPECT_EQ(vertices_of(result.penetrations), (std::vector<std::uint32_t>{3}));
  EXPECT_EQ(result.penetration_groups[0].b, b);
  EXPECT_TRUE(verify(scene).agrees());
}

TEST(Penetration, OnlySolidObjectsAreEntered) {
  Scene scene(penetration);
  scene.add(box());
  scene.add(moved_mesh(box(), {1.25, 0.5, 0.25}));
  EXPECT_TRUE(scene.detect().penetrations.empty());
  EXPECT_TRUE(scene.result().penetration_groups.empty());
  EXPECT_EQ(scene.result().curves.size(), 1u);
  scene.add(moved_mesh(box(), {1.25, 0.5, 0.25}), {.solid = true});
  EXPECT_FALSE(scene.detect().penetration_groups.empty());
}

TEST(Penetration, BothObjectsCanBeInEachOther) {
  Scene scene(penetration);
  scene.add(box(), {.solid = true});
  scene.add(moved_mesh(box(), {1.25, 0.5, 0.25}), {.solid = true});
  const DetectResult& result = scene.detect();
  ASSERT_EQ(result.penetration_groups.size(), 2u);
  EXPECT_LT(result.penetration_groups[0].a, result.penetration_groups[0].b);
  EXPECT_EQ(result.penetration_groups[1].a, result.penetration_groups[0].b);
  EXPECT_EQ(result.penetrations.size(), 2u);
  EXPECT_EQ(result.penetrations[0].depth, 0.25);
}

TEST(Penetration, KnowsContainedPartsAndWholeObjects) {
  const TriangleMesh ball = make_icosphere(4);
  Scene scene(penetration);
  const ObjectId outer = scene.add(moved_mesh(ball, {}, 2), {.solid = true});
  const ObjectId inner =
      scene.add(joined(moved_mesh(ball, {0.5, 0, 0}, 0.5), moved_mesh(ball, {-1, 0, 0}, 0.25)));
  const auto count = static_cast<std::uint32_t>(ball.positions.size());
  const DetectResult& result = scene.detect();
  EXPECT_TRUE(result.contacts.empty());
  ASSERT_EQ(result.contained_parts.size(), 2u);
  EXPECT_EQ(result.contained_parts[0], (ContainedPart{inner, outer, 0, count, true}));
  EXPECT_EQ(result.contained_parts[1], (ContainedPart{inner, outer, count, count, true}));
  EXPECT_EQ(result.penetrations.size(), 2u * count);
  EXPECT_TRUE(verify(scene).agrees());
  // One part leaves; it touches the surface on its way.
  for (const double x : {-2.0, -3.0}) {
    scene.set_positions(
        inner, joined(moved_mesh(ball, {0.5, 0, 0}, 0.5), moved_mesh(ball, {x, 0, 0}, 0.25)).positions);
    scene.detect();
    ASSERT_EQ(result.contained_parts.size(), 1u);
    EXPECT_EQ(result.contained_parts[0], (ContainedPart{inner, outer, 0, count, false}));
    EXPECT_EQ(result.penetrations.size() > count, x > -3);
    EXPECT_TRUE(verify(scene).agrees());
  }
}

TEST(Penetration, NeedsClosedSurfacesOrientedAlike) {
  Scene scene(penetration);
  TriangleMesh mesh = box();
  mesh.name = "crate";
  mesh.triangles.pop_back();
  const std::string open = message_of(scene, mesh);
  EXPECT_NE(open.find("crate is no solid: the surface is open at 3 edges"), std::string::npos) << open;
  mesh = box();
  std::swap(mesh.triangles[0][0], mesh.triangles[0][1]);
  const std::string turned = message_of(scene, mesh);
  EXPECT_NE(turned.find("turn against each other at 3 edges"), std::string::npos) << turned;
  EXPECT_TRUE(scene.objects().empty());
  EXPECT_EQ(message_of(scene, {}), "");
}

TEST(Penetration, RefusesALimitOfContacts) {
  Scene scene(penetration);
  EXPECT_THROW(scene.detect({.max_contacts = 5}), Error);
}

TEST(Penetration, IncludesIntersections) {
  Scene scene(penetration);
  EXPECT_TRUE(contains(scene.options().contacts, ContactKinds::intersection));
  scene.add(box(), {.solid = true});
  scene.add(moved_mesh(box(), {1.25, 0.5, 0.25}));
  EXPECT_FALSE(scene.detect({.contacts = ContactKinds::penetration}).contacts.empty());
  EXPECT_TRUE(scene.detect({.contacts = ContactKinds::intersection}).penetrations.empty());
  EXPECT_TRUE(scene.result().curves.empty());
}

TEST(Penetration, VerticesThatAreNotFiniteAreInert) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  const TriangleMesh ball = make_icosphere(3);
  Scene scene(penetration);
  const ObjectId outer = scene.add(moved_mesh(ball, {}, 3), {.solid = true});
  TriangleMesh small = ball;
  small.positions[5].y = nan;
  const ObjectId inner = scene.add(small, {.solid = true});
  const DetectResult& result = scene.detect();
  EXPECT_EQ(result.penetrations.size(), ball.positions.size() - 1);
  EXPECT_EQ(result.contained_parts.size(), 1u);
  EXPECT_TRUE(verify(scene).agrees());
  // A solid with a hole contains nothing.
  std::vector<Vec3d> positions = moved_mesh(ball, {}, 3).positions;
  positions[7].x = nan;
  scene.set_positions(outer, positions);
  scene.set_positions(inner, ball.positions);
  EXPECT_TRUE(scene.detect().penetrations.empty());
  EXPECT_TRUE(verify(scene).agrees());
}

TEST(Curves, OfABallThatDipsIntoACloth) {
  const TriangleMesh cloth = make_cloth(24, 24, 2, 2), ball = moved_mesh(make_icosphere(8), {}, 0.5);
  Scene scene(penetration);
  const ObjectId a = scene.add(moved_mesh(ball, {0.013, 0.3, 0.017}));
  const ObjectId b = scene.add(cloth);
  const DetectResult& result = scene.detect();
  ASSERT_EQ(result.curves.size(), 1u);
  const IntersectionCurve& curve = result.curves[0];
  EXPECT_EQ(curve.kind, CurveKind::closed);
  EXPECT_EQ(curve.a, a);
  EXPECT_EQ(curve.b, b);
  EXPECT_EQ(curve.contact_count, result.contacts.size());
  EXPECT_EQ(curve.point_count, curve.contact_count);
  // The cloth is at y = 0; its normals point up.
  const Vec3d cloth_normal =
      unit_normal({cloth.positions[cloth.triangles[0][0]], cloth.positions[cloth.triangles[0][1]],
                   cloth.positions[cloth.triangles[0][2]]});
  const double radius = std::sqrt(0.5 * 0.5 - 0.3 * 0.3), pi = 3.14159265358979;
  EXPECT_NEAR(curve.normal.y, cloth_normal.y, 1e-12);
  EXPECT_NEAR(std::fabs(curve.area.y), pi * radius * radius, 0.05 * pi * radius * radius);
  EXPECT_NEAR(curve.centroid.x, 0.013, 0.01);
  EXPECT_NEAR(curve.centroid.z, 0.017, 0.01);
  std::vector<std::uint32_t> below, within;
  double lowest = 0;
  for (std::uint32_t v = 0; v < ball.positions.size(); ++v) {
    const Vec3d p = scene.position(a, v);
    if (p.y >= 0) continue;
    below.push_back(v);
    lowest = std::min(lowest, p.y);
  }
  for (std::uint32_t v = 0; v < cloth.positions.size(); ++v) {
    const Vec3d p = scene.position(b, v);
    std::vector<Containment> where(1);
    scene.inside({{p}}, where, {.object = a});
    if (where[0] == Containment::inside) within.push_back(v);
  }
  scene.detect();
  EXPECT_EQ(list_of(result.enclosed_vertices_of(curve, ContactSide::a)), below);
  EXPECT_EQ(list_of(result.enclosed_vertices_of(curve, ContactSide::b)), within);
  EXPECT_NEAR(curve.depth, cloth_normal.y > 0 ? -lowest : 0, 1e-12);
}

TEST(Curves, HaveFiniteNumbersAtAnySize) {
  const auto curves_at = [](double size) {
    Scene scene(penetration);
    scene.add(moved_mesh(make_icosphere(4), {}, size));
    scene.add(moved_mesh(make_cloth(6, 6, 5, 5), {0.01 * size, 0.5 * size, 0.02 * size}, size));
    const auto curves = scene.detect().curves;
    return std::vector(curves.begin(), curves.end());
  };
  const auto of_unit = curves_at(1);
  ASSERT_EQ(of_unit.size(), 1u);
  ASSERT_EQ(of_unit[0].kind, CurveKind::closed);
  // 2^1021 is the largest power of two at which the meshes have finite coordinates.
  for (const int exponent : {-1000, -600, 300, 600, 1021}) {
    const double size = std::ldexp(1.0, exponent);
    const auto curves = curves_at(size);
    ASSERT_EQ(curves.size(), 1u) << exponent;
    EXPECT_EQ(curves[0].kind, CurveKind::closed) << exponent;
    const Vec3d of_one = of_unit[0].centroid, of_this = curves[0].centroid;
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(of_this[axis] / size, of_one[axis], 1e-9) << exponent;
      EXPECT_NEAR(curves[0].normal[axis], of_unit[0].normal[axis], 1e-9) << exponent;
      EXPECT_TRUE(std::isfinite(curves[0].area[axis])) << exponent;
    }
    EXPECT_NEAR(curves[0].depth / size, of_unit[0].depth, 1e-9) << exponent;
  }
}

TEST(Curves, AcrossACloth) {
  // A small cloth stands across a large one.
  TriangleMesh small = make_cloth(8, 8, 0.5, 0.5);
  for (Vec3d& p : small.positions) p = {p.x + 0.003, p.z + 0.0721, 0.0113 + 0.1 * p.x};
  Scene scene(penetration);
  const ObjectId a = scene.add(make_cloth(16, 16, 2, 2));
  scene.add(small);
  const DetectResult& result = scene.detect();
  ASSERT_EQ(result.curves.size(), 1u);
  const IntersectionCurve& curve = result.curves[0];
  EXPECT_EQ(curve.kind, CurveKind::open);
  EXPECT_EQ(curve.point_count, curve.contact_count + 1);
  EXPECT_EQ(curve.area, (Vec3d{}));
  EXPECT_NE(curve.normal, (Vec3d{}));
  // The curve divides the small cloth, but not the large one.
  EXPECT_TRUE(result.enclosed_vertices_of(curve, ContactSide::a).empty());
  std::vector<std::uint32_t> below;
  for (std::uint32_t v = 0; v < small.positions.size(); ++v) {
    if (small.positions[v].y < 0) below.push_back(v);
  }
  EXPECT_LT(below.size(), small.positions.size() / 2);
  EXPECT_EQ(list_of(result.enclosed_vertices_of(curve, ContactSide::b)), below);
  EXPECT_EQ(curve.a, a);
}

TEST(Curves, OfAnObjectWithItselfAreThoseOfItsParts) {
  const TriangleMesh first = make_icosphere(5), second = moved_mesh(make_torus(12, 8), {0.43, 0.11, 0.07});
  Scene apart(penetration), together(penetration);
  apart.add(first);
  apart.add(second);
  together.add(joined(first, second), {.self_collision = true});
  const DetectResult &p = apart.detect(), &q = together.detect();
  ASSERT_GT(p.curves.size(), 0u);
  ASSERT_EQ(p.curves.size(), q.curves.size());
  const auto offset = static_cast<std::uint32_t>(first.positions.size());
  for (std::size_t i = 0; i < p.curves.size(); ++i) {
    const IntersectionCurve &c = p.curves[i], &d = q.curves[i];
    EXPECT_EQ(d.a, d.b);
    EXPECT_EQ(c.kind, d.kind);
    EXPECT_EQ(list_of(p.contacts_of(c)), list_of(q.contacts_of(d)));
    EXPECT_EQ(c.area, d.area);
    EXPECT_EQ(c.depth, d.depth);
    EXPECT_EQ(list_of(p.enclosed_vertices_of(c, ContactSide::a)),
              list_of(q.enclosed_vertices_of(d, ContactSide::a)));
    std::vector<std::uint32_t> of_b = list_of(p.enclosed_vertices_of(c, ContactSide::b));
    for (std::uint32_t& v : of_b) v += offset;
    EXPECT_EQ(of_b, list_of(q.enclosed_vertices_of(d, ContactSide::b)));
  }
}

/// Surfaces of solids that are wavy without a pattern, so that they are in general position.
TriangleMesh wavy(TriangleMesh mesh, RandomNumbers& random) {
  const Vec3d offset = random.vector(0.35), turns = random.vector(1);
  for (Vec3d& p : mesh.positions)
    p = {p.x + 0.2 * sin_turns(p.y + turns.x) + offset.x,
         p.y + 0.2 * sin_turns(1.3 * p.z + turns.y) + offset.y,
         p.z + 0.2 * sin_turns(0.9 * p.x + turns.z) + offset.z};
  return mesh;
}

/// In general position, the closed curves divide each surface into parts that are inside and outside: a
/// vertex is inside when an odd number of curves enclose it, or the other way round for all.
TEST(Curves, EncloseWhatIsInside) {
  std::size_t curves = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    SCOPED_TRACE(seed);
    RandomNumbers random(seed);
    Scene scene(penetration);
    const std::vector<TriangleMesh> meshes{wavy(make_icosphere(6), random), wavy(make_icosphere(5), random)};
    for (const TriangleMesh& mesh : meshes) scene.add(mesh, {.solid = true});
    const DetectResult& result = scene.detect();
    curves += result.curves.size();
    std::array<std::vector<int>, 2> odd, inside;
    for (std::size_t i = 0; i < 2; ++i) {
      odd[i].resize(meshes[i].positions.size());
      inside[i] = odd[i];
    }
    for (const IntersectionCurve& curve : result.curves) {
      ASSERT_EQ(curve.kind, CurveKind::closed);
      for (const std::uint32_t v : result.enclosed_vertices_of(curve, ContactSide::a)) odd[0][v] ^= 1;
      for (const std::uint32_t v : result.enclosed_vertices_of(curve, ContactSide::b)) odd[1][v] ^= 1;
    }
    for (const Penetration& p : result.penetrations) inside[p.object_a.index][p.vertex] = 1;
    for (std::size_t i = 0; i < 2; ++i) {
      std::vector<int> reversed = odd[i];
      for (int& bit : reversed) bit ^= 1;
      EXPECT_TRUE(odd[i] == inside[i] || reversed == inside[i]) << i;
    }
  }
  EXPECT_GT(curves, 40u);
}

/// Closed surfaces with few different coordinates: many coplanar, coincident and zero-area triangles, and
/// surfaces that cross themselves.
TriangleMesh lattice_solid(RandomNumbers& random, int extent, double scale) {
  TriangleMesh mesh;
  const std::uint32_t parts = 1 + random.below(2);
  for (std::uint32_t i = 0; i < parts; ++i) {
    const std::uint32_t shape = random.below(4);
    TriangleMesh part = shape == 0   ? tetrahedron({})
                        : shape == 1 ? make_icosphere(1)
                        : shape == 2 ? make_box({1, 1, 1}, 2)
                                     : make_torus(3, 3);
    const bool keeps_shape = shape == 2 && random.below(2) == 0;
    const Vec3d corner{static_cast<double>(random.between(0, extent)),
                       static_cast<double>(random.between(0, extent)),
                       static_cast<double>(random.between(0, extent))};
    for (Vec3d& p : part.positions) {
      if (keeps_shape)
        p = (p + Vec3d{0.5, 0.5, 0.5}) * 2 + corner;
      else
        p = {static_cast<double>(random.between(0, extent)), static_cast<double>(random.between(0, extent)),
             static_cast<double>(random.between(0, extent))};
    }
    mesh = joined(mesh, part);
  }
  for (Vec3d& p : mesh.positions) p = p * scale;
  return mesh;
}

/// Inside a cell of the lattice.
TriangleMesh small_solid(RandomNumbers& random, int extent, double scale) {
  const auto place = [&] { return random.between(0, extent - 1) + 0.25; };
  const Vec3d corner{place(), place(), place()};
  TriangleMesh mesh = tetrahedron({{{}, {0.5, 0, 0}, {0, 0.5, 0}, {0, 0, 0.5}}});
  for (Vec3d& p : mesh.positions) p = (p + corner) * scale;
  return mesh;
}

TriangleMesh around_lattice(int extent, double scale) {
  const double size = extent + 2, middle = 0.5 * extent;
  return moved_mesh(make_box({size, size, size}), Vec3d{middle, middle, middle} * scale, scale);
}

class HardSolids : public testing::TestWithParam<double> {};

TEST_P(HardSolids, AgreeWithBruteForceAndWithQueries) {
#ifdef NDEBUG
  constexpr std::uint64_t seeds = 60;
#else
  constexpr std::uint64_t seeds = 12;  // rationals are slow in builds with sanitizers
#endif
  std::uint64_t inside = 0, on_surface = 0, parts = 0;
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    SCOPED_TRACE(seed);
    RandomNumbers random(seed);
    SceneOptions options = penetration;
    options.threads = 1 + random.below(3);
    Scene scene(options);
    const int extent = random.between(2, 6);
    std::vector<TriangleMesh> meshes;
    for (int i = 0; i < 3; ++i) {
      meshes.push_back(lattice_solid(random, extent, GetParam()));
      if (i == 2 && seed % 2 == 0) meshes.back() = small_solid(random, extent, GetParam());
      if (i == 1 && seed % 4 == 0) meshes.back() = around_lattice(extent, GetParam());
      scene.add(meshes.back(), {.solid = true, .octree = {.leaf_size = 1 + random.below(8)}});
    }
    const DetectResult& result = scene.detect();
    const VerifyReport report = verify(scene);
    EXPECT_TRUE(report.agrees()) << report.difference_count();
    inside += result.penetrations.size();
    on_surface += result.vertices_on_surface.size();
    parts += result.contained_parts.size();
    // Each contact is in one curve.
    std::vector<std::uint32_t> in_curves = list_of(result.curve_contacts);
    std::sort(in_curves.begin(), in_curves.end());
    ASSERT_EQ(in_curves.size(), result.contacts.size());
    for (std::uint32_t i = 0; i < in_curves.size(); ++i) ASSERT_EQ(in_curves[i], i);
    // Queries give the same answers.
    std::set<std::array<std::uint32_t, 3>> expected, found;
    for (const Penetration& p : result.penetrations)
      found.insert({p.object_a.index, p.object_b.index, p.vertex});
    for (const ObjectId a : scene.objects()) {
      std::set<std::uint32_t> used;
      for (const Triangle& t : meshes[a.index].triangles) used.insert(t.begin(), t.end());
      for (const ObjectId b : scene.objects()) {
        if (a == b) continue;
        std::vector<Containment> where(meshes[a.index].positions.size());
        scene.inside(meshes[a.index].positions, where, {.object = b});
        for (const std::uint32_t v : used) {
          if (where[v] == Containment::inside) expected.insert({a.index, b.index, v});
        }
      }
    }
    EXPECT_EQ(found, expected);
  }
  EXPECT_GT(inside, seeds / 2);
  EXPECT_GT(on_surface, seeds);
  EXPECT_GT(parts, 0u);
}

INSTANTIATE_TEST_SUITE_P(Scales, HardSolids, testing::Values(1.0, 0x1p-1000, 0x1p+900, 1e-3));

/// Copies rows. The object of index i in the fresh scene becomes `ids[i]`.
template <class Row>
std::vector<Row> renamed(std::span<const Row> rows, const std::vector<ObjectId>& ids) {
  std::vector<Row> copies(rows.begin(), rows.end());
  const auto rename = [&](ObjectId& id) { id = ids.at(id.index); };
  for (Row& row : copies) {
    if constexpr (std::is_same_v<Row, ContainedPart>) {
      rename(row.inner);
      rename(row.outer);
    } else if constexpr (std::is_same_v<Row, Penetration>) {
      rename(row.object_a);
      rename(row.object_b);
    } else {
      rename(row.a);
      rename(row.b);
    }
  }
  return copies;
}

/// A scene in which only some objects move in each step, so that it reuses the penetrations of others.
class LifeOfSolids {
 public:
  explicit LifeOfSolids(std::uint64_t seed) : random_(seed), scene_(options()) {}

  void step() {
    const std::vector<ObjectId> ids = scene_.objects();
    if (ids.size() < 6) add();
    for (const ObjectId id : ids) {
      if (random_.below(4) == 0) change(id);
    }
    // Steps that find other things, or nothing.
    switch (random_.below(8)) {
      case 0:
        scene_.detect({.contacts = ContactKinds::none});
        break;
      case 1:
        scene_.detect({.contacts = ContactKinds::intersection, .max_contacts = 3});
        break;
      case 2:
        scene_.detect({.contacts = ContactKinds::penetration | ContactKinds::proximity});
        break;
      case 3: {
        std::stop_source stopped;
        stopped.request_stop();
        scene_.detect({.stop = stopped.get_token()});
        break;
      }
      default:
        break;
    }
  }

  void expect_fresh_answers() {
    const DetectResult& result = scene_.detect();
    Scene fresh(options());
    const std::vector<ObjectId> ids = scene_.objects();
    for (const ObjectId id : ids) {
      const Body& body = bodies_[id.index];
      const ObjectId copy = fresh.add(body.mesh, body.options);
      fresh.set_positions(copy, body.positions);
      fresh.translate(copy, body.translation);
    }
    const DetectResult& expected = fresh.detect();
    EXPECT_EQ(list_of(result.penetration_groups), renamed(expected.penetration_groups, ids));
    EXPECT_EQ(list_of(result.penetrations), renamed(expected.penetrations, ids));
    EXPECT_EQ(list_of(result.vertices_on_surface), list_of(expected.vertices_on_surface));
    EXPECT_EQ(list_of(result.contained_parts), renamed(expected.contained_parts, ids));
    EXPECT_EQ(list_of(result.curves), renamed(expected.curves, ids));
    EXPECT_EQ(list_of(result.curve_contacts), list_of(expected.curve_contacts));
    EXPECT_EQ(list_of(result.curve_points), list_of(expected.curve_points));
    EXPECT_EQ(list_of(result.enclosed_vertices), list_of(expected.enclosed_vertices));
    inside += result.penetrations.size();
    on_surface += result.vertices_on_surface.size();
    parts += result.contained_parts.size();
    curves += result.curves.size();
  }

  std::size_t inside = 0, on_surface = 0, parts = 0, curves = 0;

 private:
  struct Body {
    TriangleMesh mesh;
    ObjectOptions options;
    std::vector<Vec3d> positions;
    Vec3d translation;
  };

  static SceneOptions options() {
    SceneOptions options = penetration;
    options.threads = 2;
    return options;
  }

  void add() {
    Body body;
    const std::uint32_t shape = random_.below(4);
    body.mesh = shape == 0   ? wavy(make_icosphere(4), random_)
                : shape == 1 ? moved_mesh(make_icosphere(1), {}, 0.2)
                             : lattice_solid(random_, 3, 0.5);
    body.options.solid = random_.below(4) != 0;
    body.options.self_collision = random_.below(2) == 0;
    body.positions = body.mesh.positions;
    const ObjectId id = scene_.add(body.mesh, body.options);
    bodies_.resize(std::max<std::size_t>(bodies_.size(), id.index + 1));
    bodies_[id.index] = body;
  }

  void change(ObjectId id) {
    Body& body = bodies_[id.index];
    switch (random_.below(8)) {
      case 0:
        return scene_.remove(id);
      case 1:
        body.options.self_collision = !body.options.self_collision;
        return scene_.set_options(id, {.self_collision = body.options.self_collision});
      case 2:
        body.options.group = 1 + random_.below(3);
        body.options.mask = 1 + random_.below(3);
        return scene_.set_options(id, {.group = body.options.group, .mask = body.options.mask});
      case 3:
        body.positions = body.mesh.positions;
        for (Vec3d& p : body.positions) p = p + random_.vector(0.1);
        if (random_.below(4) == 0) body.positions.front().x = std::numeric_limits<double>::quiet_NaN();
        body.translation = {};
        return scene_.set_positions(id, body.positions);
      default: {
        const Vec3d way = 0.5 * Vec3d{double(random_.between(-1, 1)), double(random_.between(-1, 1)), 0};
        body.translation = body.translation + way;
        return scene_.translate(id, way);
      }
    }
  }

  RandomNumbers random_;
  Scene scene_;
  std::vector<Body> bodies_;  // by slot
};

TEST(Penetration, ReusesOnlyWhatAFreshSceneFinds) {
#ifdef NDEBUG
  constexpr std::uint64_t seeds = 5;
#else
  constexpr std::uint64_t seeds = 4;
#endif
  std::size_t inside = 0, on_surface = 0, parts = 0, curves = 0;
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    LifeOfSolids life(seed);
    for (int step = 0; step < 60; ++step) {
      SCOPED_TRACE("seed " + std::to_string(seed) + ", step " + std::to_string(step));
      life.step();
      life.expect_fresh_answers();
      if (testing::Test::HasFailure()) return;
    }
    inside += life.inside;
    on_surface += life.on_surface;
    parts += life.parts;
    curves += life.curves;
  }
  EXPECT_GT(inside, 60 * seeds);
  EXPECT_GT(on_surface, 60 * seeds);
  EXPECT_GT(parts, 10 * seeds);
  EXPECT_GT(curves, 60 * seeds);
}

TEST(Penetration, OfASolidWithAHoleKnowsItsSurface) {
  for (const auto kinds : {ContactKinds::penetration, ContactKinds::penetration | ContactKinds::proximity}) {
    Scene scene({.contacts = kinds});
    TriangleMesh torn = box();
    const ObjectId outer = scene.add(torn, {.solid = true});
    // Six vertices on the faces of the box, and one vertex inside it.
    const ObjectId inner = scene.add(TriangleMesh{
        "octahedron",
        {{1, 0.1, 0.2}, {-1, 0.1, 0.2}, {0.1, 1, 0.2}, {0.1, -1, 0.2}, {0.1, 0.2, 1}, {0.1, 0.2, -1}},
        {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}}});
    const auto compare = [&] {
      std::vector<Containment> where(6);
      std::vector<Vec3d> points;
      for (std::uint32_t v = 0; v < 6; ++v) points.push_back(scene.position(inner, v));
      scene.inside(points, where, {.object = outer});
      std::vector<std::uint32_t> on_surface;
      for (std::uint32_t v = 0; v < 6; ++v) {
        EXPECT_NE(where[v], Containment::inside);
        if (where[v] == Containment::on) on_surface.push_back(v);
      }
      const DetectResult& result = scene.detect();
      EXPECT_TRUE(result.penetrations.empty());
      EXPECT_EQ(list_of(result.vertices_on_surface), on_surface);
      EXPECT_TRUE(verify(scene).agrees());
      return on_surface.size();
    };
    EXPECT_EQ(compare(), 6u);
    torn.positions[0].y = std::numeric_limits<double>::infinity();
    scene.set_positions(outer, torn.positions);
    EXPECT_LT(compare(), 6u);
    EXPECT_GT(compare(), 0u);
  }
}

TEST(Penetration, IsTheSameForAnyNumberOfThreads) {
  const auto hash_with = [](std::uint32_t threads) {
    RandomNumbers random(3);
    SceneOptions options = penetration;
    options.threads = threads;
    Scene scene(options);
    for (int i = 0; i < 5; ++i)
      scene.add(wavy(make_icosphere(8), random), {.self_collision = true, .solid = true});
    const DetectResult& result = scene.detect();
    EXPECT_GT(result.penetrations.size(), 100u);
    EXPECT_GT(result.curves.size(), 5u);
    return hash_of_penetrations(result);
  };
  const std::uint64_t hash = hash_with(1);
  for (const std::uint32_t threads : {2u, 3u}) EXPECT_EQ(hash_with(threads), hash);
}

}  // namespace supple::penetration_test
