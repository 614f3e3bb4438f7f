// Compares the candidates of continuous contacts with all pairs of elements, and with the known contacts of
// real meshes.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <limits>
#include <map>
#include <set>
#include <tuple>

#include "octree/self_collision_culling.hpp"
#include "supple/mesh_file.hpp"
#include "support/instruction_sets.hpp"
#include "support/moving_objects.hpp"
#include "support/shared_meshes.hpp"

namespace supple::element_candidates_test {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double inf = std::numeric_limits<double>::infinity();

/// Ids in the user's numbering: {v, v}, {p, q} with p < q, or {t, t}.
using ElementId = std::array<std::uint32_t, 2>;
using Candidate = std::tuple<ElementPairKind, ElementId, ElementId>;
using CandidateSet = std::set<Candidate>;

ElementId vertex_id(const MovingObject& object, std::uint32_t v) {
  return {object.elements.vertex_ids()[v], object.elements.vertex_ids()[v]};
}
ElementId face_id(const MovingObject& object, std::uint32_t f) {
  return {object.octree.triangle_ids()[f], object.octree.triangle_ids()[f]};
}
ElementId edge_id(const MovingObject& object, std::uint32_t e) {
  const Edge& edge = object.elements.edges()[e];
  const auto [p, q] =
      std::minmax(object.elements.vertex_ids()[edge[0]], object.elements.vertex_ids()[edge[1]]);
  return {p, q};
}

Candidate candidate(const MovingObject& a, const MovingObject& b, bool same, ElementPairKind kind,
                    ElementPair pair) {
  switch (kind) {
    case ElementPairKind::vertex_face:
      return {kind, vertex_id(a, pair.a), face_id(b, pair.b)};
    case ElementPairKind::face_vertex:
      return {kind, face_id(a, pair.a), vertex_id(b, pair.b)};
    default:
      break;
  }
  const ElementId p = edge_id(a, pair.a), q = edge_id(b, pair.b);
  return same && q < p ? Candidate{kind, q, p} : Candidate{kind, p, q};
}

ObjectPairView pair_view(const MovingObject& a, const MovingObject& b, double separation) {
  const OctreeView view = a.view();
  return &a == &b ? pair_of(view, view, separation) : pair_of(view, b.view(), separation);
}

/// Fails if a pair is found twice.
CandidateSet find_candidates(const MovingObject& a, const MovingObject& b, double separation,
                             int refinements) {
  const ObjectPairView pair = pair_view(a, b, separation);
  Traversal traversal;
  TraversalStats stats;
  std::vector<NodePair> roots{{}};
  for (int round = 0; round < refinements; ++round) {
    std::vector<NodePair> finer;
    for (const NodePair& root : roots) traversal.refine(pair, root, finer);
    roots = finer;
  }
  CandidateSet found;
  for (const NodePair& root : roots) {
    traversal.find_element_pairs(pair, root, stats,
                                 [&](ElementPairKind kind, std::span<const ElementPair> pairs) {
                                   EXPECT_LE(pairs.size(), ElementPairBatches::capacity);
                                   for (const ElementPair& p : pairs) {
                                     EXPECT_TRUE(found.insert(candidate(a, b, &a == &b, kind, p)).second);
                                   }
                                 });
  }
  EXPECT_EQ(stats.vertex_face_candidates + stats.edge_edge_candidates, found.size());
  return found;
}

/// An element in the brute-force search: its id and its exact boxes at both ends of the step.
struct BruteElement {
  ElementId id;
  std::vector<std::uint32_t> vertices;
  Vec3d min[2], max[2];
};

/// Appends the element unless a coordinate is not finite.
void add_element(const MovingObject& object, ElementId id, std::vector<std::uint32_t> vertices,
                 std::vector<BruteElement>& elements) {
  BruteElement element{
      id, vertices, {{inf, inf, inf}, {inf, inf, inf}}, {{-inf, -inf, -inf}, {-inf, -inf, -inf}}};
  for (const std::uint32_t vertex : vertices) {
    for (int at_end = 0; at_end < 2; ++at_end) {
      const Vec3d p = object.position(vertex, at_end == 1);
      for (int axis = 0; axis < 3; ++axis) {
        if (!std::isfinite(p[axis])) return;
        element.min[at_end][axis] = std::min(element.min[at_end][axis], p[axis]);
        element.max[at_end][axis] = std::max(element.max[at_end][axis], p[axis]);
      }
    }
  }
  elements.push_back(element);
}

struct BruteElements {
  explicit BruteElements(const MovingObject& object) {
    std::set<std::uint32_t> used;
    std::set<ElementId> pairs;
    for (std::uint32_t t = 0; t < object.mesh.triangles.size(); ++t) {
      const Triangle& triangle = object.mesh.triangles[t];
      add_element(object, {t, t}, {triangle.begin(), triangle.end()}, faces);
      for (int corner = 0; corner < 3; ++corner) {
        const auto [p, q] = std::minmax(triangle[corner], triangle[(corner + 1) % 3]);
        used.insert({p, q});
        if (p != q) pairs.insert({p, q});
      }
    }
    for (const std::uint32_t v : used) add_element(object, {v, v}, {v}, vertices);
    for (const ElementId& edge : pairs) add_element(object, edge, {edge[0], edge[1]}, edges);
  }
  std::vector<BruteElement> vertices, edges, faces;
};

bool meet(const BruteElement& p, const BruteElement& q, double separation) {
  for (int axis = 0; axis < 3; ++axis) {
    bool below = true, above = true;
    for (int at_end = 0; at_end < 2; ++at_end) {
      below = below && q.min[at_end][axis] - p.max[at_end][axis] > separation;
      above = above && p.min[at_end][axis] - q.max[at_end][axis] > separation;
    }
    if (below || above) return false;
  }
  return true;
}

void add_meeting(ElementPairKind kind, const std::vector<BruteElement>& a, const std::vector<BruteElement>& b,
                 bool same, double separation, CandidateSet& found) {
  for (const BruteElement& p : a) {
    for (const BruteElement& q : b) {
      if (same && kind == ElementPairKind::edge_edge && !(p.id < q.id)) continue;
      if (same && std::find_first_of(p.vertices.begin(), p.vertices.end(), q.vertices.begin(),
                                     q.vertices.end()) != p.vertices.end()) {
        continue;
      }
      if (meet(p, q, separation)) found.insert({kind, p.id, q.id});
    }
  }
}

CandidateSet brute_force(const MovingObject& a, const MovingObject& b, double separation) {
  const bool same = &a == &b;
  const BruteElements of_a(a), of_b(b);
  CandidateSet found;
  add_meeting(ElementPairKind::vertex_face, of_a.vertices, of_b.faces, same, separation, found);
  if (!same) add_meeting(ElementPairKind::face_vertex, of_a.faces, of_b.vertices, same, separation, found);
  add_meeting(ElementPairKind::edge_edge, of_a.edges, of_b.edges, same, separation, found);
  return found;
}

/// Expects no missing candidate, and additional ones only within `slack`, the rounding of the boxes.
void expect_candidates(const MovingObject& a, const MovingObject& b, double separation, double slack) {
  ASSERT_EQ(a.validate(), "");
  ASSERT_EQ(b.validate(), "");
  const CandidateSet must = brute_force(a, b, separation * (1 - 1e-12)),
                     may = brute_force(a, b, separation + slack);
  for (const int refinements : {0, 3}) {
    const CandidateSet found = find_candidates(a, b, separation, refinements);
    EXPECT_TRUE(std::includes(found.begin(), found.end(), must.begin(), must.end()));
    EXPECT_TRUE(std::includes(may.begin(), may.end(), found.begin(), found.end()));
  }
}

struct ElementCandidates : testing::TestWithParam<std::tuple<bool, std::uint32_t, double>> {
  bool floats() const { return std::get<0>(GetParam()); }
  ObjectOctreeOptions options() const { return {.leaf_size = std::get<1>(GetParam())}; }
  double separation() const { return std::get<2>(GetParam()); }
  double slack() const { return floats() && separation() == 0 ? 0 : 1e-5; }
  MovingObject moving(const TriangleMesh& mesh, double distance, std::uint64_t seed,
                      Vec3d common = {}) const {
    return {mesh, displaced(mesh, distance, seed, common), options(), floats()};
  }
  MovingObject resting(const TriangleMesh& mesh) const { return {mesh, {}, options(), floats()}; }
};

TEST_P(ElementCandidates, OfTwoSoups) {
  const MovingObject a = moving(random_soup(300, 1, 0.1, 1), 0.1, 11);
  const MovingObject b = moving(random_soup(250, 1, 0.1, 2), 0.1, 12, {1, 0, 0});
  ASSERT_GT(brute_force(a, b, 0).size(), 100u);
  expect_candidates(a, b, separation(), slack());
}

TEST_P(ElementCandidates, OfMovingAndResting) {
  const MovingObject a = moving(random_soup(4, 1, 1, 3), 0.3, 13);
  const MovingObject b = resting(random_soup(400, 0.7, 0.1, 4));
  expect_candidates(a, b, separation(), slack());
  expect_candidates(b, a, separation(), slack());
  expect_candidates(b, b, separation(), slack());
}

TEST_P(ElementCandidates, OfACrumpledSheetWithItself) {
  const MovingObject sheet = moving(crumpled_sheet(18, 15, 0.03, 5), 0.05, 14);
  ASSERT_GT(brute_force(sheet, sheet, 0).size(), 100u);
  expect_candidates(sheet, sheet, separation(), slack());
}

TEST_P(ElementCandidates, OfOneObjectWithRepeatedIds) {
  TriangleMesh mesh;
  RandomNumbers random(6);
  for (int v = 0; v < 90; ++v) mesh.positions.push_back(random.vector(1));
  for (int t = 0; t < 60; ++t)
    mesh.triangles.push_back({random.below(40), random.below(40), random.below(40)});
  for (std::uint32_t v = 0; v < 6; ++v) mesh.triangles.push_back({v, v, v + 1});
  for (std::uint32_t v = 0; v < 6; ++v) mesh.triangles.push_back({v, v, v});
  const MovingObject object = moving(mesh, 0.2, 15);
  expect_candidates(object, object, separation(), slack());
}

TEST_P(ElementCandidates, OfNonFiniteVertices) {
  TriangleMesh sheet = crumpled_sheet(12, 11, 0.03, 7);
  std::vector<Vec3d> end = displaced(sheet, 0.2, 16);
  sheet.positions[12].x = nan;
  sheet.positions[40].z = inf;
  end[41].y = -inf;
  end[0].x = nan;
  const MovingObject a(sheet, end, options(), floats());
  const MovingObject b = moving(random_soup(120, 1, 0.2, 8), 0.1, 17);
  expect_candidates(a, a, separation(), slack());
  expect_candidates(a, b, separation(), slack());
  expect_candidates(b, a, separation(), slack());
}

TEST_P(ElementCandidates, OfTouchingBoxes) {
  // Triangles on a grid of small integers: many bounds are equal, at one end of the step or at both.
  RandomNumbers random(9);
  TriangleMesh mesh;
  std::vector<Vec3d> end;
  const auto grid_point = [&] {
    return Vec3d{double(random.below(6)), double(random.below(6)), double(random.below(6))};
  };
  for (std::uint32_t t = 0; t < 90; ++t) {
    for (int corner = 0; corner < 3; ++corner) {
      mesh.positions.push_back(grid_point());
      end.push_back(grid_point());
    }
    mesh.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
  }
  const MovingObject object(mesh, end, options(), floats());
  expect_candidates(object, object, separation(), slack());
}

INSTANTIATE_TEST_SUITE_P(PrecisionsLeavesAndSeparations, ElementCandidates,
                         testing::Combine(testing::Bool(), testing::Values(1u, 8u, 100u),
                                          testing::Values(0.0, 1e-3, 0.1)));

TEST(ElementCandidates, OfNothing) {
  const MovingObject nothing({}, {});
  const MovingObject soup(random_soup(5, 1, 1, 1), {});
  EXPECT_TRUE(find_candidates(nothing, soup, 0, 0).empty());
  EXPECT_TRUE(find_candidates(soup, nothing, 0, 3).empty());
  EXPECT_TRUE(find_candidates(nothing, nothing, 0, 0).empty());
}

TEST(ElementCandidates, BeyondTheRangeOfFloatAreKept) {
  // In single precision, all of these coordinates round to ±FLT_MAX. Inert elements must still be excluded.
  TriangleMesh mesh;
  for (const double x : {1e39, 1e300, -1e39, -1e300}) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (int corner = 0; corner < 3; ++corner) mesh.positions.push_back({x, x, x});
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  mesh.positions.push_back({nan, 0, 0});
  mesh.triangles.push_back({12, 12, 12});
  const MovingObject object(mesh, {}, {}, false);
  for (const double separation : {0.0, 1.0, 1e38, 1e300}) {
    const CandidateSet must = brute_force(object, object, separation),
                       found = find_candidates(object, object, separation, 0);
    EXPECT_TRUE(std::includes(found.begin(), found.end(), must.begin(), must.end()));
    for (const auto& [kind, p, q] : found) {
      EXPECT_NE(p[0], 12u);
      EXPECT_FALSE(kind == ElementPairKind::vertex_face && q[0] == 4);
    }
  }
}

TEST(ElementCandidates, OfElementsAtOnePlaceComeInBatches) {
  TriangleMesh mesh;
  for (std::uint32_t t = 0; t < 150; ++t) {
    for (int corner = 0; corner < 3; ++corner) mesh.positions.push_back({1, 2, 3});
    mesh.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
  }
  const MovingObject object(mesh, {});
  const CandidateSet found = find_candidates(object, object, 0, 0);
  EXPECT_EQ(found.size(), 450u * 149 + 450u * (450 - 3) / 2);
}

TEST(ElementCandidates, OfElementsThatPassEachOther) {
  // They pass through each other along x: at both ends they are apart, but on opposite sides.
  const TriangleMesh left{"", {{0, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 1, 2}}};
  const TriangleMesh right{"", {{1, 0, 0}, {1, 1, 0}, {1, 0, 1}}, {{0, 1, 2}}};
  const MovingObject a(left, right.positions), b(right, left.positions),
      c(right, {{2, 0, 0}, {2, 1, 0}, {2, 0, 1}});
  EXPECT_FALSE(find_candidates(a, b, 0, 0).empty());
  // c moves ahead of a in the same direction: the swept boxes overlap, but the boxes never do.
  EXPECT_TRUE(find_candidates(a, c, 0, 0).empty());
  EXPECT_FALSE(find_candidates(a, c, 1, 0).empty());
}

TEST(ElementCandidates, AreTheSameOnEveryInstructionSet) {
  const TriangleMesh sheet = crumpled_sheet(40, 30, 0.02, 5);
  const TriangleMesh soup = random_soup(300, 1, 0.1, 2);
  using Found = std::vector<std::pair<ElementPairKind, ElementPair>>;
  const auto all_candidates = [&](double separation) {
    const MovingObject a(sheet, displaced(sheet, 0.05, 1), {.leaf_size = 40}), b(soup, {}, {}, false);
    Found found;
    Traversal traversal;
    TraversalStats stats;
    for (const ObjectPairView& pair : {pair_view(a, a, separation), pair_view(a, b, separation)}) {
      traversal.find_element_pairs(pair, {}, stats,
                                   [&](ElementPairKind kind, std::span<const ElementPair> pairs) {
                                     for (const ElementPair& p : pairs) found.push_back({kind, p});
                                   });
    }
    found.push_back({{}, {static_cast<std::uint32_t>(stats.volumes_tested), 0}});
    return found;
  };
  for (const double separation : {0.0, 0.01}) {
    const Found expected = all_candidates(separation);
    ASSERT_GT(expected.size(), 1000u);
    for_each_target([&](const char* name) { EXPECT_EQ(all_candidates(separation), expected) << name; });
  }
}

/// Frames with known contacts from `contacts/NAME.txt` of the shared data.
void expect_known_contacts(const std::string& name, const std::string& frame_0, const std::string& frame_1,
                           std::uint64_t vertex_face, std::uint64_t edge_edge) {
  std::ifstream contacts(shared_meshes() / "contacts" / (name + ".txt"));
  if (!contacts) GTEST_SKIP() << "no " << shared_meshes() << "; set SUPPLE_DATA to the folder of truth.json";
  const TriangleMesh start = load_mesh(shared_meshes() / frame_0), end = load_mesh(shared_meshes() / frame_1);
  const MovingObject object(start, end.positions);
  std::set<ElementId> ordered;
  for (const Triangle& triangle : start.triangles) {
    for (int corner = 0; corner < 3; ++corner) {
      const auto [p, q] = std::minmax(triangle[corner], triangle[(corner + 1) % 3]);
      ordered.insert({q, p});  // the order of the data: by the larger id, then by the smaller one
    }
  }
  std::vector<ElementId> edges;
  for (const ElementId& edge : ordered) edges.push_back({edge[1], edge[0]});
  CandidateSet touching;
  std::string kind, time;
  for (std::uint32_t a, b; contacts >> kind >> a >> b >> time;) {
    if (kind == "vf") {
      touching.insert({ElementPairKind::vertex_face, {a, a}, {b, b}});
    } else {
      touching.insert(
          {ElementPairKind::edge_edge, std::min(edges[a], edges[b]), std::max(edges[a], edges[b])});
    }
  }
  ASSERT_FALSE(touching.empty());
  SelfCollisionCulling culled(object.octree, object.elements.faces());
  culled.refit(object.octree, object.elements.faces(), object.start, object.end, Parallel(1));
  for (const bool skip_culled : {false, true}) {
    OctreeView view = object.view();
    if (skip_culled) view.culled = culled.masks().data();
    CandidateSet not_found = touching;
    Traversal traversal;
    TraversalStats stats;
    traversal.find_element_pairs(pair_of(view, view), {}, stats,
                                 [&](ElementPairKind pair_kind, std::span<const ElementPair> pairs) {
                                   for (const ElementPair& p : pairs)
                                     not_found.erase(candidate(object, object, true, pair_kind, p));
                                 });
    EXPECT_TRUE(not_found.empty()) << not_found.size() << " contacts are not among the candidates";
    if (skip_culled) {
      EXPECT_LT(stats.edge_edge_candidates, edge_edge);
    } else {
      EXPECT_EQ(stats.vertex_face_candidates, vertex_face);
      EXPECT_EQ(stats.edge_edge_candidates, edge_edge);
    }
  }
}

/// Every omitted candidate is inside one child that is marked as free of self-collisions.
TEST(ElementCandidates, LeaveOutWhatCulledChildrenCannotTouch) {
  const TriangleMesh mesh = crumpled_sheet(40, 30, 0.004, 5);
  const MovingObject object(mesh, displaced(mesh, 0.004, 6));
  SelfCollisionCulling culled(object.octree, object.elements.faces());
  culled.refit(object.octree, object.elements.faces(), object.start, object.end, Parallel(1));
  const auto candidates = [&](bool skip_culled, double separation) {
    OctreeView view = object.view();
    if (skip_culled) view.culled = culled.masks().data();
    CandidateSet found;
    Traversal traversal;
    TraversalStats stats;
    std::vector<NodePair> roots;
    const ObjectPairView pair = pair_of(view, view, separation);
    traversal.refine(pair, {}, roots);
    for (const NodePair& root : roots) {
      traversal.find_element_pairs(pair, root, stats,
                                   [&](ElementPairKind kind, std::span<const ElementPair> pairs) {
                                     for (const ElementPair& p : pairs) {
                                       found.insert(candidate(object, object, true, kind, p));
                                     }
                                   });
    }
    return found;
  };
  const CandidateSet all = candidates(false, 0), fewer = candidates(true, 0);
  EXPECT_LT(fewer.size(), all.size());
  EXPECT_TRUE(std::includes(all.begin(), all.end(), fewer.begin(), fewer.end()));
  // The culling makes no claim about elements that only come close.
  EXPECT_EQ(candidates(true, 1e-6).size(), candidates(false, 1e-6).size());
}

TEST(ElementCandidates, HoldAllContactsOfClothAndBall) {
  const std::string frames = "scalable-ccd/cloth-ball/frames/cloth_ball";
  expect_known_contacts("cloth-ball-92-93", frames + "92.ply", frames + "93.ply", 363448, 1404249);
}

TEST(ElementCandidates, HoldAllContactsOfClothInAFunnel) {
  const std::string frames = "scalable-ccd/cloth-funnel/frames/";
  expect_known_contacts("cloth-funnel-227-228", frames + "227.ply", frames + "228.ply", 4181, 18897);
}

TEST(ElementCandidates, HoldAllContactsOfAKick) {
  expect_known_contacts("kick-43-44", "kick/43.obj", "kick/44.obj", 4535, 35197);
}

}  // namespace supple::element_candidates_test
