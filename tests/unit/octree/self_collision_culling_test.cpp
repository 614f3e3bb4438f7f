// Checks exactly that culled children have no self-collisions. All coordinates are multiples of small powers
// of two, so positions at eighths of the step are not rounded.

#include "octree/self_collision_culling.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "supple/triangle_intersection.hpp"
#include "support/moving_objects.hpp"

namespace supple::self_collision_culling_test {

constexpr double pi = 3.14159265358979323846;

struct Culled {
  /// An empty `end` means that the mesh is at rest.
  Culled(const TriangleMesh& mesh, const std::vector<Vec3d>& end, const ObjectOctreeOptions& options = {},
         bool floats = false)
      : object(mesh, end, options, floats), culling(object.octree, object.elements.faces()) {
    culling.refit(object.octree, object.elements.faces(), object.start, object.end_positions(), Parallel(1));
  }
  /// The number of culled children.
  std::size_t count() const {
    std::size_t result = 0;
    for (const std::uint8_t mask : culling.masks()) result += static_cast<std::size_t>(std::popcount(mask));
    return result;
  }
  TrianglePoints points(std::uint32_t triangle, double time) const {
    TrianglePoints result;
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const std::uint32_t vertex = object.elements.faces()[triangle][corner];
      result[corner] = object.start[vertex] * (1 - time) + object.end_positions()[vertex] * time;
    }
    return result;
  }
  bool touches_itself(std::uint32_t first, std::uint32_t last) const {
    const auto triangles = object.elements.faces();
    for (std::uint32_t s = first; s < last; ++s) {
      for (std::uint32_t t = s + 1; t < last; ++t) {
        const Triangle &p = triangles[s], &q = triangles[t];
        if (std::find_first_of(p.begin(), p.end(), q.begin(), q.end()) != p.end()) continue;
        for (double time = 0; time <= 1; time += 0.125) {
          if (intersect_triangles(points(s, time), points(t, time)).intersects) return true;
        }
      }
    }
    return false;
  }
  void expect_true_claims() const {
    const auto nodes = object.octree.nodes();
    for (std::uint32_t n = 0; n < nodes.size(); ++n) {
      for (int child = 0; child < node_width; ++child) {
        if ((culling.masks()[n] >> child & 1) == 0) continue;
        ASSERT_LT(child, nodes[n].child_count);
        EXPECT_FALSE(touches_itself(nodes[n].first_triangle[child], nodes[n].first_triangle[child + 1]));
      }
    }
  }
  MovingObject object;
  SelfCollisionCulling culling;
};

/// Whether a mesh in a single leaf is culled. If it is, the claim is verified.
bool is_culled(const TriangleMesh& mesh, const std::vector<Vec3d>& end = {}) {
  const Culled one_leaf(mesh, end, {.leaf_size = 100000});
  one_leaf.expect_true_claims();
  return one_leaf.count() == 1;
}

double on_grid(double value) {
  return std::round(value * 0x1p20) * 0x1p-20;
}

template <class Map>
std::vector<Vec3d> mapped(const TriangleMesh& mesh, const Map& map) {
  std::vector<Vec3d> positions;
  for (const Vec3d& p : mesh.positions) {
    const Vec3d q = map(p);
    positions.push_back({on_grid(q.x), on_grid(q.y), on_grid(q.z)});
  }
  return positions;
}

/// columns × rows squares over the unit square of x and z.
TriangleMesh sheet(std::uint32_t columns, std::uint32_t rows) {
  TriangleMesh mesh = crumpled_sheet(columns, rows, 0, 1);
  mesh.positions = mapped(mesh, [](const Vec3d& p) { return p; });
  return mesh;
}

TriangleMesh sheet(std::uint32_t columns, std::uint32_t rows, const auto& map) {
  TriangleMesh mesh = sheet(columns, rows);
  mesh.positions = mapped(mesh, map);
  return mesh;
}

auto turned(double angle) {
  return [=](const Vec3d& p) {
    return Vec3d{std::cos(angle) * p.x - std::sin(angle) * p.z, p.y,
                 std::sin(angle) * p.x + std::cos(angle) * p.z};
  };
}

/// A fan around a central vertex that climbs by `climb`. Every 2 π of `angle` is one full turn; the first and
/// last vertices differ.
TriangleMesh fan(std::uint32_t parts, double angle, double climb) {
  TriangleMesh mesh{"", {{0, 0, 0}}, {}};
  for (std::uint32_t i = 0; i <= parts; ++i) {
    const double part = i / double(parts);
    mesh.positions.push_back({std::cos(angle * part), std::sin(angle * part), climb * part});
    if (i > 0) mesh.triangles.push_back({0, i, i + 1});
  }
  mesh.positions = mapped(mesh, [](const Vec3d& p) { return p; });
  return mesh;
}

TEST(SelfCollisionCulling, OfNothing) {
  EXPECT_EQ(Culled({}, {}).count(), 0u);
}

TEST(SelfCollisionCulling, SmoothSheets) {
  const auto wavy = [](const Vec3d& p) {
    return Vec3d{p.x, 0.1 * std::sin(5 * p.x) * std::cos(4 * p.z), p.z};
  };
  EXPECT_TRUE(is_culled(TriangleMesh{"", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}}));
  EXPECT_TRUE(is_culled(sheet(7, 5)));
  EXPECT_TRUE(is_culled(sheet(7, 5, wavy)));
  EXPECT_TRUE(is_culled(sheet(7, 5), mapped(sheet(7, 5), wavy)));
  EXPECT_TRUE(is_culled(sheet(7, 5), mapped(sheet(7, 5), turned(pi / 3))));
  EXPECT_TRUE(is_culled(fan(7, 2 * pi * 0.4, 0.1)));
}

TEST(SelfCollisionCulling, MostChildrenOfALargeSmoothSheet) {
  const auto bent = [](const Vec3d& p) { return Vec3d{p.x, 0.3 * p.x * p.x + 0.1 * p.z * p.x, p.z}; };
  for (const bool floats : {false, true}) {
    const Culled large(sheet(40, 40), mapped(sheet(40, 40), bent), {}, floats);
    std::size_t children = 0;
    for (const OctreeNode& node : large.object.octree.nodes()) {
      children += node.child_count;
    }
    EXPECT_GT(children, 20u);
    // Some children have boundaries that are too jagged.
    EXPECT_GT(3 * large.count(), 2 * children);
    if (floats) large.expect_true_claims();
  }
}

TEST(SelfCollisionCulling, ABalloonWithinALargeSheet) {
  // The small children of the balloon are smooth and the sheet around it is flat, but the large child that
  // contains the balloon must not be culled.
  const auto balloon = [](const Vec3d& p) {
    const double x = p.x - 0.25, z = p.z - 0.25, distance = std::sqrt(x * x + z * z);
    if (distance >= 0.2) return p;
    const double angle = distance / 0.2 * 2.6, radius = 0.08;
    const double out = distance > 0 ? radius * std::sin(angle) / distance : 0;
    return Vec3d{0.25 + x * out, radius * (std::cos(angle) - std::cos(2.6)), 0.25 + z * out};
  };
  const auto root_children = [](const Culled& sheet_children) {
    const OctreeNode& root = sheet_children.object.octree.nodes()[0];
    EXPECT_EQ(root.child_count, 4);
    return sheet_children.culling.masks()[0];
  };
  // In a regular octree, the four children of the root are the quarters of the sheet.
  const ObjectOctreeOptions quarters{.build = ObjectOctreeBuild::regular};
  EXPECT_EQ(root_children({sheet(40, 40), {}, quarters}), 0xf);
  EXPECT_EQ(root_children({sheet(40, 40, balloon), {}, quarters}), 0xe);
  EXPECT_EQ(root_children({sheet(40, 40), mapped(sheet(40, 40), balloon), quarters}), 0xe);
}

TEST(SelfCollisionCulling, SurfacesThatCloseOrOverlap) {
  const TriangleMesh tetrahedron{
      "", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};
  EXPECT_FALSE(is_culled(tetrahedron));
  TriangleMesh twice = sheet(3, 3);
  twice.triangles.push_back(twice.triangles[4]);
  EXPECT_FALSE(is_culled(twice));
  // Spiral ramps: all triangles face upwards, but some lie above others.
  EXPECT_FALSE(is_culled(fan(25, 2 * pi * 1.5, 1)));
  EXPECT_FALSE(is_culled(fan(40, 2 * pi * 2.7, 0)));
  const auto ramp = [](const Vec3d& p) {
    return Vec3d{(1 + p.x) * std::cos(9 * p.z), (1 + p.x) * std::sin(9 * p.z), p.z};
  };
  EXPECT_FALSE(is_culled(sheet(3, 40, ramp)));
  // A rolled sheet, and a sheet twisted by half a turn.
  const auto roll = [](const Vec3d& p) { return Vec3d{p.x, std::cos(7 * p.z), std::sin(7 * p.z)}; };
  EXPECT_FALSE(is_culled(sheet(3, 30, roll)));
  const auto twist = [](const Vec3d& p) {
    return Vec3d{(p.x - 0.5) * std::cos(pi * p.z), (p.x - 0.5) * std::sin(pi * p.z), 3 * p.z};
  };
  EXPECT_FALSE(is_culled(sheet(4, 20, twist)));
}

TEST(SelfCollisionCulling, SeamsThatTouch) {
  // A disc cut along a ray, with duplicate vertices along the cut.
  TriangleMesh cut_disc = fan(12, 2 * pi, 0);
  cut_disc.positions[13] = cut_disc.positions[1];
  EXPECT_FALSE(is_culled(cut_disc));
  // Two adjacent sheets with duplicate vertices along the common side.
  TriangleMesh pair = sheet(2, 2);
  const TriangleMesh left = pair;
  for (const Vec3d& p : left.positions) pair.positions.push_back(p + Vec3d{1, 0, 0});
  for (const Triangle& t : left.triangles) pair.triangles.push_back({t[0] + 9, t[1] + 9, t[2] + 9});
  EXPECT_FALSE(is_culled(pair));
  // A vertex at the middle of the side of another triangle.
  const TriangleMesh junction{
      "", {{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {1, 0, 0}, {2, -1, 0}, {1, -1, 0}}, {{0, 1, 2}, {3, 5, 4}}};
  EXPECT_FALSE(is_culled(junction));
  // Two triangles that share only a vertex.
  const TriangleMesh bow{
      "", {{0, 0, 0}, {1, 1, 0}, {1, -1, 0}, {-1, 1, 0}, {-1, -1, 0}}, {{0, 2, 1}, {0, 3, 4}}};
  EXPECT_FALSE(is_culled(bow));
}

TEST(SelfCollisionCulling, MotionsThatFoldOnTheWay) {
  // The sheet is flat at both ends; half-way all its vertices are in one point.
  EXPECT_FALSE(is_culled(sheet(4, 4), mapped(sheet(4, 4), turned(pi))));
  EXPECT_FALSE(is_culled(sheet(4, 4), mapped(sheet(4, 4), turned(pi / 2))));
  // A fan that spreads until it overlaps itself, and the reverse.
  const TriangleMesh open_fan = fan(12, 2 * pi * 0.9, 0), spread_fan = fan(12, 2 * pi * 1.1, 0);
  EXPECT_TRUE(is_culled(open_fan));
  EXPECT_FALSE(is_culled(open_fan, spread_fan.positions));
  EXPECT_FALSE(is_culled(spread_fan, open_fan.positions));
  // A sheet that is turned over.
  EXPECT_FALSE(is_culled(sheet(4, 4), mapped(sheet(4, 4), [](const Vec3d& p) {
                           return Vec3d{-p.x, p.y, p.z};
                         })));
}

TEST(SelfCollisionCulling, DegenerateTriangles) {
  TriangleMesh repeated = sheet(3, 3);
  repeated.triangles.push_back({0, 0, 1});
  EXPECT_FALSE(is_culled(repeated));
  TriangleMesh flat = sheet(3, 3);
  flat.positions.push_back(flat.positions[0]);
  flat.triangles.push_back({0, 1, 16});
  EXPECT_FALSE(is_culled(flat));
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    for (int axis = 0; axis < 3; ++axis) {
      TriangleMesh lost = sheet(3, 3);
      lost.positions[5][axis] = bad;
      EXPECT_EQ(Culled(lost, {}, {.leaf_size = 100}).count(), 0u);
      EXPECT_EQ(Culled(sheet(3, 3), lost.positions, {.leaf_size = 100}).count(), 0u);
    }
  }
  TriangleMesh huge = sheet(3, 3), tiny = sheet(3, 3);
  for (Vec3d& p : huge.positions) p = p * 1e200;
  for (Vec3d& p : tiny.positions) p = p * 1e-200;
  EXPECT_EQ(Culled(huge, {}, {.leaf_size = 100}).count(), 0u);
  EXPECT_EQ(Culled(tiny, {}, {.leaf_size = 100}).count(), 0u);
}

/// A few vertices on a coarse grid cover all kinds of touches.
TEST(SelfCollisionCulling, SmallMeshesOnAGrid) {
  const std::vector<std::vector<Triangle>> shapes = {
      {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}, {0, 5, 1}},             // a disc
      {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}},                        // a fan
      {{0, 1, 2}, {2, 1, 3}, {2, 3, 4}, {4, 3, 5}, {4, 5, 6}, {6, 5, 7}},  // a strip
      {{0, 1, 2}, {3, 4, 5}},
      {{0, 1, 2}, {2, 1, 3}, {3, 1, 4}, {3, 5, 2}},
      {{0, 1, 2}, {0, 2, 3}, {3, 4, 5}},
  };
  RandomNumbers random(21);
  std::size_t culled = 0;
  for (int round = 0; round < 40000; ++round) {
    TriangleMesh mesh;
    std::vector<Vec3d> end;
    // Usually a slightly perturbed regular polygon or strip, so that some children are culled.
    const std::vector<Triangle>& shape = shapes[round % shapes.size()];
    const bool strip = round % shapes.size() == 2;
    const double height = random.below(3) * 0.5;
    for (int v = 0; v < 8; ++v) {
      const auto shaken = [&](double by) {
        return Vec3d{std::round(random.uniform(-by, by)), std::round(random.uniform(-by, by)),
                     std::round(random.uniform(-height, height))};
      };
      Vec3d p = strip ? Vec3d{3.0 * (v / 2), v % 2 ? 3.0 : 0.0, 0}
                      : Vec3d{std::round(4 * std::cos(1.26 * v)), std::round(4 * std::sin(1.26 * v)), 0};
      if (!strip && v == 0) p = {};
      mesh.positions.push_back(p + shaken(1.6));
      end.push_back(p + shaken(1.6));
    }
    mesh.triangles = shape;
    culled += is_culled(mesh, random.below(2) == 0 ? std::vector<Vec3d>{} : end) ? 1 : 0;
  }
  EXPECT_GT(culled, 2000u);
}

TEST(SelfCollisionCulling, CrumpledSheets) {
  std::size_t culled = 0, children = 0;
  for (int round = 0; round < 12; ++round) {
    TriangleMesh mesh = crumpled_sheet(24, 20, 0.004 * round, static_cast<std::uint64_t>(round));
    const auto fold = [&](const Vec3d& p) {
      return Vec3d{p.x + 0.05 * round * std::sin(12 * p.x),
                   0.15 * std::sin(7 * p.x + round) * std::cos(4 * p.z), p.z};
    };
    const std::vector<Vec3d> end = mapped(mesh, fold);
    mesh.positions = mapped(mesh, [](const Vec3d& p) { return p; });
    const Culled sheet_children(mesh, end, {.leaf_size = 6});
    sheet_children.expect_true_claims();
    culled += sheet_children.count();
    for (const OctreeNode& node : sheet_children.object.octree.nodes()) {
      children += node.child_count;
    }
  }
  EXPECT_GT(culled, 20u);
  EXPECT_LT(culled, children);
}

}  // namespace supple::self_collision_culling_test
