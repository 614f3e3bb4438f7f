#include "supple/models.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "model_vectors.hpp"
#include "supple/error.hpp"
#include "support/golden_models.hpp"

namespace supple::models_test {

/// Triangles connected through shared vertices.
struct Component {
  std::size_t vertices = 0, edges = 0, border_edges = 0;
  std::vector<Triangle> triangles;
  double volume = 0;

  bool closed() const { return border_edges == 0; }
  long euler_characteristic() const {
    return static_cast<long>(vertices) - static_cast<long>(edges) + static_cast<long>(triangles.size());
  }
};

using DirectedEdges = std::map<std::pair<std::uint32_t, std::uint32_t>, int>;

DirectedEdges directed_edges(const TriangleMesh& mesh) {
  DirectedEdges edges;
  for (const Triangle& t : mesh.triangles)
    for (int corner = 0; corner < 3; ++corner) ++edges[{t[corner], t[(corner + 1) % 3]}];
  return edges;
}

std::vector<Component> components_of(const TriangleMesh& mesh) {
  std::vector<std::uint32_t> parent(mesh.positions.size());
  std::iota(parent.begin(), parent.end(), 0u);
  const auto root = [&](std::uint32_t v) {
    while (parent[v] != v) v = parent[v] = parent[parent[v]];
    return v;
  };
  for (const Triangle& t : mesh.triangles) {
    parent[root(t[1])] = root(t[0]);
    parent[root(t[2])] = root(t[0]);
  }

  std::map<std::uint32_t, Component> by_root;
  for (std::uint32_t v = 0; v < mesh.positions.size(); ++v) ++by_root[root(v)].vertices;
  for (const Triangle& t : mesh.triangles) {
    Component& component = by_root[root(t[0])];
    component.triangles.push_back(t);
    const auto& p = mesh.positions;
    component.volume += dot(p[t[0]], cross(p[t[1]], p[t[2]])) / 6;
  }
  const DirectedEdges edges = directed_edges(mesh);
  for (const auto& [edge, count] : edges) {
    const auto& [a, b] = edge;
    const bool border = !edges.contains({b, a});
    by_root[root(a)].border_edges += border;
    by_root[root(a)].edges += border || a < b;
  }

  std::vector<Component> components;
  for (const auto& [id, component] : by_root) components.push_back(component);
  return components;
}

/// No directed edge is used twice: at most two triangles share an edge, and their orientations agree.
void expect_oriented_manifold(const TriangleMesh& mesh) {
  for (const auto& [edge, count] : directed_edges(mesh))
    ASSERT_EQ(count, 1) << mesh.name << " edge " << edge.first << "-" << edge.second;
}

/// Six times the signed volume of a tetrahedron.
double volume_of(Vec3d a, Vec3d b, Vec3d c, Vec3d d) {
  return dot(b - a, cross(c - a, d - a));
}

/// Whether the segment passes through the interior of the triangle. Rounding may decide about touches.
bool crosses(Vec3d start, Vec3d end, Vec3d a, Vec3d b, Vec3d c) {
  if (volume_of(start, a, b, c) * volume_of(end, a, b, c) >= 0) return false;
  const double ab = volume_of(start, end, a, b);
  const double bc = volume_of(start, end, b, c);
  const double ca = volume_of(start, end, c, a);
  return (ab > 0 && bc > 0 && ca > 0) || (ab < 0 && bc < 0 && ca < 0);
}

/// Whether the boxes around the segment and the triangle are disjoint, as for most pairs.
bool far_apart(Vec3d start, Vec3d end, Vec3d a, Vec3d b, Vec3d c) {
  for (int axis = 0; axis < 3; ++axis) {
    const auto [low, high] = std::minmax(start[axis], end[axis]);
    if (std::max({a[axis], b[axis], c[axis]}) < low || high < std::min({a[axis], b[axis], c[axis]}))
      return true;
  }
  return false;
}

/// Expects that no edge passes through a triangle of the same component.
void expect_no_self_crossing(const TriangleMesh& mesh, const Component& component) {
  const auto& p = mesh.positions;
  for (const Triangle& edges : component.triangles) {
    for (int corner = 0; corner < 3; ++corner) {
      const std::uint32_t a = edges[corner];
      const std::uint32_t b = edges[(corner + 1) % 3];
      if (component.closed() && a > b) continue;  // the other triangle has the same edge as (b, a)
      for (const Triangle& t : component.triangles) {
        if (far_apart(p[a], p[b], p[t[0]], p[t[1]], p[t[2]])) continue;
        if (std::find(t.begin(), t.end(), a) != t.end()) continue;
        if (std::find(t.begin(), t.end(), b) != t.end()) continue;
        ASSERT_FALSE(crosses(p[a], p[b], p[t[0]], p[t[1]], p[t[2]]))
            << mesh.name << " edge " << a << "-" << b << " and triangle " << t[0] << " " << t[1] << " "
            << t[2];
      }
    }
  }
}

/// 1 for an equilateral triangle, 0 for a triangle without area.
double roundness(const TriangleMesh& mesh, const Triangle& t) {
  const Vec3d a = mesh.positions[t[0]];
  const Vec3d b = mesh.positions[t[1]];
  const Vec3d c = mesh.positions[t[2]];
  const double longest = std::max({norm(b - a), norm(c - b), norm(a - c)});
  return norm(cross(b - a, c - a)) / (longest * longest) * (2 / std::numbers::sqrt3);
}

void expect_clean(const TriangleMesh& mesh, double least_roundness) {
  std::set<std::tuple<double, double, double>> distinct;
  for (const Vec3d& p : mesh.positions) distinct.insert({p.x, p.y, p.z});
  EXPECT_EQ(distinct.size(), mesh.positions.size()) << mesh.name << " has coincident vertices";

  std::set<std::uint32_t> used;
  for (const Triangle& t : mesh.triangles) {
    used.insert(t.begin(), t.end());
    ASSERT_GE(roundness(mesh, t), least_roundness)
        << mesh.name << " triangle " << t[0] << " " << t[1] << " " << t[2];
  }
  EXPECT_EQ(used.size(), mesh.positions.size()) << mesh.name << " has unused vertices";
}

TEST(SelfCrossing, IsSeenByTheTestBelow) {
  const Vec3d a{0, 0, 0};
  const Vec3d b{1, 0, 0};
  const Vec3d c{0, 1, 0};
  EXPECT_TRUE(crosses({0.2, 0.2, -1}, {0.2, 0.2, 1}, a, b, c));
  EXPECT_TRUE(crosses({0.2, 0.2, 1}, {0.2, 0.2, -1}, a, b, c));
  EXPECT_FALSE(crosses({0.8, 0.8, -1}, {0.8, 0.8, 1}, a, b, c)) << "beside the triangle";
  EXPECT_FALSE(crosses({0.2, 0.2, 1}, {0.2, 0.2, 2}, a, b, c)) << "above the triangle";
}

struct Expected {
  const char* name;
  std::size_t vertices, triangles;
  std::size_t spheres, tori, sheets;  // components: closed with no handle, closed with one, open discs
  std::size_t border_edges;
  int longest_axis;
  double least_roundness;
};
/// GoogleTest calls this function; ctest shows the name.
void PrintTo(const Expected& model, std::ostream* out) {
  *out << model.name;
}

class Models : public testing::TestWithParam<Expected> {};

TEST_P(Models, HasThePapersCountsAndTheRightParts) {
  const TriangleMesh mesh = make_model(GetParam().name);
  EXPECT_EQ(mesh.name, GetParam().name);
  EXPECT_EQ(mesh.positions.size(), GetParam().vertices);
  EXPECT_EQ(mesh.triangles.size(), GetParam().triangles);
  for (const Triangle& t : mesh.triangles)
    for (const std::uint32_t v : t) ASSERT_LT(v, mesh.positions.size());

  expect_oriented_manifold(mesh);
  std::size_t spheres = 0;
  std::size_t tori = 0;
  std::size_t sheets = 0;
  std::size_t border_edges = 0;
  for (const Component& component : components_of(mesh)) {
    expect_no_self_crossing(mesh, component);
    border_edges += component.border_edges;
    spheres += component.closed() && component.euler_characteristic() == 2;
    tori += component.closed() && component.euler_characteristic() == 0;
    sheets += !component.closed() && component.euler_characteristic() == 1;
    EXPECT_TRUE(!component.closed() || component.volume > 0) << "inside out";
  }
  EXPECT_EQ(spheres, GetParam().spheres);
  EXPECT_EQ(tori, GetParam().tori);
  EXPECT_EQ(sheets, GetParam().sheets);
  EXPECT_EQ(components_of(mesh).size(), spheres + tori + sheets);
  EXPECT_EQ(border_edges, GetParam().border_edges);
}

TEST_P(Models, FillsAUnitBoxWithoutSliversOrWastedVertices) {
  const TriangleMesh mesh = make_model(GetParam().name);
  for (int axis = 0; axis < 3; ++axis) {
    const auto [low, high] =
        std::minmax_element(mesh.positions.begin(), mesh.positions.end(),
                            [axis](const Vec3d& a, const Vec3d& b) { return a[axis] < b[axis]; });
    EXPECT_NEAR((*low)[axis] + (*high)[axis], 0, 1e-15) << "axis " << axis;
    if (axis == GetParam().longest_axis) {
      EXPECT_EQ((*low)[axis], -0.5);
      EXPECT_EQ((*high)[axis], 0.5);
    } else {
      EXPECT_LT((*high)[axis] - (*low)[axis], 1) << "axis " << axis;
    }
  }
  expect_clean(mesh, GetParam().least_roundness);
}

INSTANTIATE_TEST_SUITE_P(All, Models,
                         testing::Values(Expected{"pawn", 154, 304, 1, 0, 0, 0, 1, 0.2},
                                         Expected{"fish", 216, 338, 3, 0, 7, 68, 0, 0.2},
                                         Expected{"rabbit", 453, 902, 1, 0, 0, 0, 1, 0.2},
                                         Expected{"human", 1250, 2500, 0, 1, 0, 0, 1, 0.2},
                                         Expected{"bike", 9543, 18238, 212, 8, 0, 0, 0, 0.1}),
                         [](const testing::TestParamInfo<Expected>& model) {
                           return std::string(model.param.name);
                         });

TEST(ModelGoldenHash, IsTheSameEverywhere) {
  for (const GoldenModel& model : golden_models)
    EXPECT_EQ(hash_of(make_model(model.name)), model.value) << model.name;
}

TEST(ModelNames, AreThePapersInItsOrder) {
  const std::vector<std::string_view> names(model_names().begin(), model_names().end());
  EXPECT_EQ(names, (std::vector<std::string_view>{"pawn", "fish", "rabbit", "human", "bike"}));
}

TEST(ModelNames, AreListedWhenOneIsUnknown) {
  try {
    make_model("Pawn");
    FAIL() << "names are case-sensitive";
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(),
                 "unknown model 'Pawn'; the built-in models are pawn, fish, rabbit, human, bike");
  }
}

void expect_one_closed_part(const TriangleMesh& mesh, long euler_characteristic, double volume) {
  expect_oriented_manifold(mesh);
  const std::vector<Component> components = components_of(mesh);
  ASSERT_EQ(components.size(), 1u);
  EXPECT_TRUE(components[0].closed());
  EXPECT_EQ(components[0].euler_characteristic(), euler_characteristic);
  EXPECT_NEAR(components[0].volume, volume, 0.02 * volume);
}

TEST(Icosphere, HasItsCountsAndIsClosed) {
  for (const std::uint32_t frequency : {1u, 2u, 3u, 7u, 16u}) {
    const TriangleMesh mesh = make_icosphere(frequency);
    EXPECT_EQ(mesh.name, "icosphere");
    EXPECT_EQ(mesh.triangles.size(), 20u * frequency * frequency);
    EXPECT_EQ(mesh.positions.size(), 10u * frequency * frequency + 2);
    for (const Vec3d& p : mesh.positions) ASSERT_NEAR(norm(p), 1, 1e-15);
    expect_oriented_manifold(mesh);
    expect_clean(mesh, 0.6);
  }
  expect_one_closed_part(make_icosphere(16), 2, 4 * std::numbers::pi / 3);
}

TEST(Torus, HasItsCountsAndIsClosed) {
  EXPECT_EQ(make_torus(3, 3).triangles.size(), 18u);
  EXPECT_EQ(make_torus(3, 3).positions.size(), 9u);
  const TriangleMesh mesh = make_torus(64, 32, 2, 0.5);
  EXPECT_EQ(mesh.triangles.size(), 4096u);
  expect_one_closed_part(mesh, 0, 2 * std::numbers::pi * 2 * std::numbers::pi * 0.25);
  expect_clean(mesh, 0.3);
  for (const Vec3d& p : mesh.positions)
    ASSERT_NEAR(std::hypot(std::hypot(p.x, p.z) - 2, p.y), 0.5, 1e-14) << "not about the y axis";
}

TEST(Box, HasItsCountsAndIsClosed) {
  for (const std::uint32_t resolution : {1u, 2u, 3u, 10u}) {
    const TriangleMesh mesh = make_box({1, 2, 3}, resolution);
    EXPECT_EQ(mesh.triangles.size(), 12u * resolution * resolution);
    EXPECT_EQ(mesh.positions.size(), 6u * resolution * resolution + 2);
    expect_one_closed_part(mesh, 2, 6);
    expect_clean(mesh, 0.2);
    for (const Vec3d& p : mesh.positions) {
      EXPECT_TRUE(std::abs(p.x) == 0.5 || std::abs(p.y) == 1 || std::abs(p.z) == 1.5);
      EXPECT_TRUE(std::abs(p.x) <= 0.5 && std::abs(p.y) <= 1 && std::abs(p.z) <= 1.5);
    }
  }
}

TEST(Cloth, IsASheetThatFacesUp) {
  const TriangleMesh mesh = make_cloth(5, 3, 2, 1);
  EXPECT_EQ(mesh.triangles.size(), 30u);
  EXPECT_EQ(mesh.positions.size(), 24u);
  EXPECT_EQ(mesh.positions.front(), (Vec3d{-1, 0, -0.5}));
  EXPECT_EQ(mesh.positions.back(), (Vec3d{1, 0, 0.5}));
  expect_oriented_manifold(mesh);
  expect_clean(mesh, 0.3);
  double area = 0;
  for (const Triangle& t : mesh.triangles) {
    const Vec3d normal =
        cross(mesh.positions[t[1]] - mesh.positions[t[0]], mesh.positions[t[2]] - mesh.positions[t[0]]);
    EXPECT_GT(normal.y, 0);
    area += normal.y / 2;
  }
  EXPECT_NEAR(area, 2, 1e-14);
}

TEST(Cloth, AlternatesItsDiagonals) {
  // Four diagonals meet at the inner vertex of a 2 × 2 sheet, so all eight triangles use it.
  const TriangleMesh mesh = make_cloth(2, 2);
  const auto around_middle =
      std::count_if(mesh.triangles.begin(), mesh.triangles.end(),
                    [](const Triangle& t) { return std::find(t.begin(), t.end(), 4u) != t.end(); });
  EXPECT_EQ(around_middle, 8);
}

std::string message_of(auto&& make) {
  try {
    make();
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(Primitives, RefuseCountsAndSizesThatMakeNoMesh) {
  EXPECT_EQ(message_of([] { make_icosphere(0); }), "icosphere: frequency is 0; give at least 1");
  EXPECT_EQ(message_of([] { make_torus(2, 3); }), "torus: rings is 2; give at least 3");
  EXPECT_EQ(message_of([] { make_torus(3, 2); }), "torus: sides is 2; give at least 3");
  EXPECT_THROW(make_torus(3, 3, 0, 1), Error);
  EXPECT_THROW(make_torus(3, 3, 1, -1), Error);
  EXPECT_EQ(message_of([] { make_box({1, 1, 1}, 0); }), "box: resolution is 0; give at least 1");
  EXPECT_THROW(make_box({1, 0, 1}), Error);
  EXPECT_THROW(make_box({1, 1, std::nan("")}), Error);
  EXPECT_EQ(message_of([] { make_cloth(0, 1); }), "cloth: columns is 0; give at least 1");
  EXPECT_EQ(message_of([] { make_cloth(1, 0); }), "cloth: rows is 0; give at least 1");
  EXPECT_THROW(make_cloth(1, 1, HUGE_VAL, 1), Error);
}

TEST(Primitives, RefuseMeshesThatIdsCannotNumber) {
  EXPECT_THROW(make_icosphere(100'000), Error);
  EXPECT_THROW(make_torus(1'000'000, 1'000'000), Error);
  EXPECT_THROW(make_box({1, 1, 1}, 100'000), Error);
  EXPECT_THROW(make_cloth(4'000'000'000, 4'000'000'000), Error);
}

}  // namespace supple::models_test
