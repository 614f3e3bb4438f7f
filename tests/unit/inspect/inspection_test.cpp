#include "supple/inspection.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "geometry/aabb.hpp"
#include "geometry/sphere.hpp"
#include "geometry/vector.hpp"
#include "supple/error.hpp"
#include "supple/models.hpp"
#include "support/golden_scenes.hpp"
#include "support/option_word.hpp"
#include "support/soups.hpp"

namespace supple::inspection_test {

constexpr double smallest = 0x1p-1060;  // the rounding error of denormals
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

/// Identifies a triangle by its object and number.
struct Named {
  ObjectId object;
  std::uint32_t triangle = 0;
  constexpr auto operator<=>(const Named&) const = default;
};
using NamedPair = std::pair<Named, Named>;

/// A scene with copies of its meshes for comparison with brute force.
struct Known {
  Scene scene;
  std::map<ObjectId, std::vector<Triangle>> triangles{};
  std::map<ObjectId, bool> self{}, is_static{};
  std::map<ObjectId, std::vector<Vec3d>> start{};  // for continuous contacts: start positions
  double separation = 0;

  explicit Known(const SceneOptions& options = {})
      : scene(options), separation(options.impact.min_separation) {}

  ObjectId add(const TriangleMesh& mesh, ObjectOptions options = {.self_collision = true},
               std::uint32_t leaf_size = 3) {
    options.octree.leaf_size = leaf_size;
    const ObjectId id = scene.add(mesh, options);
    triangles[id] = mesh.triangles;
    self[id] = options.self_collision;
    is_static[id] = options.is_static;
    return id;
  }
  void remove(ObjectId id) {
    scene.remove(id);
    triangles.erase(id);
  }

  std::vector<Named> all() const {
    std::vector<Named> names;
    for (const auto& [id, list] : triangles) {
      for (std::uint32_t t = 0; t < list.size(); ++t) names.push_back({id, t});
    }
    return names;
  }
  const Triangle& corners(const Named& named) const { return triangles.at(named.object)[named.triangle]; }
  std::array<Vec3d, 3> points(const Named& named) const {
    const Triangle& c = corners(named);
    return {scene.position(named.object, c[0]), scene.position(named.object, c[1]),
            scene.position(named.object, c[2])};
  }
  std::array<Vec3d, 3> starting_points(const Named& named) const {
    const auto found = start.find(named.object);
    if (found == start.end()) return points(named);
    const Triangle& c = corners(named);
    return {found->second[c[0]], found->second[c[1]], found->second[c[2]]};
  }
  bool is_inert(const Named& named) const {
    for (const auto& corners_then : {points(named), starting_points(named)}) {
      for (const Vec3d& p : corners_then) {
        if (!is_finite(p)) return true;
      }
    }
    return false;
  }
  bool share_vertex(const Named& p, const Named& q) const {
    if (p.object != q.object) return false;
    const std::set<std::uint32_t> of_p(corners(p).begin(), corners(p).end());
    return std::any_of(corners(q).begin(), corners(q).end(),
                       [&](std::uint32_t vertex) { return of_p.count(vertex) != 0; });
  }
  bool is_tested(const Named& p, const Named& q) const {
    if (p.object == q.object) return self.at(p.object);
    return !(is_static.at(p.object) && is_static.at(q.object));
  }
};

Aabb box_of(const std::array<Vec3d, 3>& points) {
  Aabb box;
  for (const Vec3d& p : points) extend(box, p);
  return box;
}

bool holds(const Aabb& box, const std::array<Vec3d, 3>& points) {
  return std::all_of(points.begin(), points.end(), [&](const Vec3d& p) {
    return box.min.x <= p.x && p.x <= box.max.x && box.min.y <= p.y && p.y <= box.max.y && box.min.z <= p.z &&
           p.z <= box.max.z;
  });
}

bool holds(const BoundingSphere& sphere, const std::array<Vec3d, 3>& points) {
  return std::all_of(points.begin(), points.end(), [&](const Vec3d& p) {
    const Vec3d from{p.x - sphere.center.x, p.y - sphere.center.y, p.z - sphere.center.z};
    return norm(from) <= sphere.radius * (1 + 1e-12) || std::isinf(sphere.radius);
  });
}

bool holds(const std::vector<Slab>& slabs, const std::array<Vec3d, 3>& points) {
  return std::all_of(slabs.begin(), slabs.end(), [&](const Slab& slab) {
    const Vec3d direction{slab.direction.x, slab.direction.y, slab.direction.z};
    return std::all_of(points.begin(), points.end(), [&](const Vec3d& p) {
      const double along = dot(direction, p), rounding = 1e-15 * dot(absolute(direction), absolute(p));
      return slab.low <= along + rounding && along <= slab.high + rounding;
    });
  });
}

/// The signed gap from triangle a to triangle b along the axis.
double gap_along(const Vec3d& axis, const std::array<Vec3d, 3>& a, const std::array<Vec3d, 3>& b) {
  double furthest_a = -INFINITY, nearest_b = INFINITY;
  for (const Vec3d& p : a) furthest_a = std::max(furthest_a, dot(axis, p));
  for (const Vec3d& p : b) nearest_b = std::min(nearest_b, dot(axis, p));
  return nearest_b - furthest_a;
}

double size_of(const std::array<Vec3d, 3>& a, const std::array<Vec3d, 3>& b) {
  double size = 0;
  for (const auto& points : {a, b}) {
    for (const Vec3d& p : points) size = std::max(size, largest_magnitude(p));
  }
  return size;
}

void expect_apart(const PairExplanation& e, const std::array<Vec3d, 3>& a, const std::array<Vec3d, 3>& b) {
  if (!e.sphere_a.empty()) {
    EXPECT_TRUE(holds(e.sphere_a, a));
    EXPECT_TRUE(holds(e.sphere_b, b));
    EXPECT_FALSE(overlap(e.sphere_a, e.sphere_b));
    EXPECT_TRUE(e.box_a.empty());
  } else {
    EXPECT_TRUE(holds(e.box_a, a));
    EXPECT_TRUE(holds(e.box_b, b));
    EXPECT_EQ(overlap(e.box_a, e.box_b), !e.slabs_a.empty());
    EXPECT_TRUE(holds(e.slabs_a, a));
    EXPECT_TRUE(holds(e.slabs_b, b));
  }
  EXPECT_GT(e.distance, 0);
  EXPECT_GE(gap_along(e.axis, a, b), e.distance - 1e-5 * size_of(a, b) - smallest);
}

/// Checks the result of `explain` for two triangles; `is_contact` is the result of `detect`.
void check_explanation(const Known& known, const Named& p, const Named& q, bool is_contact) {
  const PairExplanation e = SceneInspector(known.scene).explain(p.object, p.triangle, q.object, q.triangle);
  const auto a = known.points(p), b = known.points(q);
  ASSERT_EQ(e.stage == PairStage::contact, is_contact)
      << p.object.index << ':' << p.triangle << ' ' << q.object.index << ':' << q.triangle << " stage "
      << static_cast<int>(e.stage);
  const bool has_volumes = e.stage == PairStage::object_volumes || e.stage == PairStage::octree_volumes ||
                           e.stage == PairStage::triangle_boxes;
  EXPECT_EQ(has_volumes, !e.box_a.empty() || !e.sphere_a.empty());
  EXPECT_EQ(e.stage == PairStage::not_tested, !known.is_tested(p, q));
  if (is_contact || e.stage == PairStage::not_tested) return;
  EXPECT_EQ(e.stage == PairStage::shared_vertex, known.share_vertex(p, q));
  if (e.stage == PairStage::shared_vertex) return;
  EXPECT_EQ(e.stage == PairStage::inert, known.is_inert(p) || known.is_inert(q));
  if (e.stage == PairStage::inert) return;
  if (has_volumes) {
    expect_apart(e, a, b);
  } else {
    EXPECT_GE(e.distance, 0);
    EXPECT_NEAR(norm(e.axis), 1, 1e-12);
    // The closest points are subject to rounding: for slivers, the error is a small part of their size.
    EXPECT_GE(gap_along(e.axis, a, b), e.distance - 1e-6 * size_of(a, b) - smallest);
  }
  const PairExplanation back =
      SceneInspector(known.scene).explain(q.object, q.triangle, p.object, p.triangle);
  EXPECT_EQ(back.stage, e.stage);
  EXPECT_EQ(back.box_a, e.box_b);
  EXPECT_EQ(back.sphere_a, e.sphere_b);
  EXPECT_EQ(back.slabs_a, e.slabs_b);
  EXPECT_EQ(back.level_a, e.level_b);
  EXPECT_EQ(back.distance, e.distance);
}

std::set<NamedPair> contacts_of(const Scene& scene) {
  std::set<NamedPair> pairs;
  for (const Contact& c : scene.result().contacts)
    pairs.insert({{c.object_a, c.triangle_a}, {c.object_b, c.triangle_b}});
  return pairs;
}

void check_all_explanations(const Known& known) {
  const std::set<NamedPair> contacts = contacts_of(known.scene);
  const std::vector<Named> all = known.all();
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (std::size_t j = i; j < all.size(); j += 3) {  // each triangle with a third of the others
      check_explanation(known, all[i], all[j], contacts.count({all[i], all[j]}) != 0);
      if (testing::Test::HasFailure()) return;
    }
  }
}

bool boxes_meet(const Known& known, const Named& p, const Named& q) {
  if (known.start.empty()) return overlap(box_of(known.points(p)), box_of(known.points(q)));
  const Aabb a0 = box_of(known.starting_points(p)), a1 = box_of(known.points(p));
  const Aabb b0 = box_of(known.starting_points(q)), b1 = box_of(known.points(q));
  for (int axis = 0; axis < 3; ++axis) {
    const auto apart = [&](const Aabb& low, const Aabb& high) {
      return double{high.min[axis]} - low.max[axis] > known.separation;
    };
    if ((apart(a0, b0) && apart(a1, b1)) || (apart(b0, a0) && apart(b1, a1))) return false;
  }
  return true;
}

std::vector<CandidatePair> candidates_by_brute_force(const Known& known) {
  std::vector<CandidatePair> pairs;
  const std::vector<Named> all = known.all();
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (std::size_t j = i + 1; j < all.size(); ++j) {
      const Named &p = all[i], &q = all[j];
      if (!known.is_tested(p, q) || known.share_vertex(p, q) || known.is_inert(p) || known.is_inert(q))
        continue;
      if (boxes_meet(known, p, q)) pairs.push_back({p.object, q.object, p.triangle, q.triangle});
    }
  }
  std::sort(pairs.begin(), pairs.end(), [](const CandidatePair& p, const CandidatePair& q) {
    return std::tie(p.object_a, p.object_b, p.triangle_a, p.triangle_b) <
           std::tie(q.object_a, q.object_b, q.triangle_a, q.triangle_b);
  });
  return pairs;
}

constexpr std::size_t no_limit = std::size_t{1} << 40;

void check_candidates(const Known& known, bool are_boxes) {
  const auto [found, total] = SceneInspector(known.scene).candidates(no_limit);
  ASSERT_EQ(total, found.size());
  const std::vector<CandidatePair> expected = candidates_by_brute_force(known);
  if (are_boxes) {
    ASSERT_EQ(found, expected);
  } else {
    EXPECT_TRUE(std::includes(expected.begin(), expected.end(), found.begin(), found.end()));
    EXPECT_TRUE(std::is_sorted(found.begin(), found.end()));
  }
  for (const Contact& c : known.scene.result().contacts) {
    const CandidatePair pair{c.object_a, c.object_b, c.triangle_a, c.triangle_b};
    EXPECT_TRUE(std::binary_search(found.begin(), found.end(), pair));
  }
  for (const std::size_t limit : {std::size_t{0}, std::size_t{1}, found.size() / 3, found.size()}) {
    const CandidateList first = SceneInspector(known.scene).candidates(limit);
    EXPECT_EQ(first.total, found.size());
    EXPECT_TRUE(std::equal(first.pairs.begin(), first.pairs.end(), found.begin(),
                           found.begin() + static_cast<std::ptrdiff_t>(std::min(limit, found.size()))));
  }
}

/// The number of slabs of a cell.
std::size_t slabs_of(const SceneOptions& options) {
  if (options.contacts == ContactKinds::continuous) return 0;
  switch (options.bounding_volume) {
    case BoundingVolume::obb:
      return 3;
    case BoundingVolume::kdop14:
      return 7;
    case BoundingVolume::kdop18:
      return 9;
    case BoundingVolume::kdop26:
      return 13;
    default:
      return 0;
  }
}

void check_cells(const Known& known, ObjectId id, std::optional<std::uint32_t> level) {
  const std::vector<OctreeCell> cells = SceneInspector(known.scene).cells(id, level);
  const std::uint32_t depth = SceneInspector(known.scene).octree_depth(id);
  const std::vector<Triangle>& triangles = known.triangles.at(id);
  std::size_t counted = 0;
  std::vector<bool> held(triangles.size(), false);
  std::uint32_t last_level = 0;
  for (const OctreeCell& cell : cells) {
    counted += cell.triangle_count;
    EXPECT_GE(cell.level, last_level);
    last_level = cell.level;
    EXPECT_LE(cell.level, level ? std::min(*level, depth) : depth);
    if (level && cell.level < *level) {
      EXPECT_TRUE(cell.is_leaf);
    }
    if (!level) {
      EXPECT_TRUE(cell.is_leaf);
    }
    const bool is_sphere = known.scene.options().bounding_volume == BoundingVolume::sphere &&
                           known.scene.options().contacts != ContactKinds::continuous;
    EXPECT_EQ(cell.sphere.empty(), cell.box.empty() || !is_sphere);
    EXPECT_EQ(cell.slabs.size(), slabs_of(known.scene.options()));
    std::size_t inside = 0;
    for (std::uint32_t t = 0; t < triangles.size(); ++t) {
      const Named named{id, t};
      // Any cell may count an inert triangle.
      const bool is_held =
          known.is_inert(named) ||
          (holds(cell.box, known.points(named)) && (!is_sphere || holds(cell.sphere, known.points(named))) &&
           holds(cell.slabs, known.points(named)));
      inside += is_held ? 1 : 0;
      held[t] = held[t] || is_held;
    }
    EXPECT_GE(inside, cell.triangle_count);
    EXPECT_GE(cell.triangle_count, 1u);
  }
  EXPECT_EQ(counted, triangles.size());
  EXPECT_TRUE(std::all_of(held.begin(), held.end(), [](bool is_held) { return is_held; }));
  // The root has the smallest enclosing box, so it contains all leaf boxes.
  if (level == 0 && !cells.empty()) {
    ASSERT_EQ(cells.size(), 1u);
    for (const OctreeCell& leaf : SceneInspector(known.scene).cells(id, {})) {
      if (leaf.box.empty()) continue;
      EXPECT_TRUE(overlap(leaf.box, cells[0].box));
      for (int axis = 0; axis < 3; ++axis) {
        EXPECT_GE(leaf.box.min[axis], cells[0].box.min[axis]);
        EXPECT_LE(leaf.box.max[axis], cells[0].box.max[axis]);
      }
    }
  }
}

void check_all_cells(const Known& known) {
  for (const auto& [id, triangles] : known.triangles) {
    check_cells(known, id, std::nullopt);
    for (std::uint32_t level = 0; level <= SceneInspector(known.scene).octree_depth(id) + 1; ++level)
      check_cells(known, id, level);
  }
}

Known known_scene_of(const std::vector<TriangleMesh>& meshes, const SceneOptions& options) {
  Known known(options);
  for (const TriangleMesh& mesh : meshes) known.add(mesh);
  return known;
}

/// Limits each mesh to a number of triangles for which all pairs can be tested.
std::vector<TriangleMesh> cut(std::vector<TriangleMesh> meshes, std::size_t triangles) {
  for (TriangleMesh& mesh : meshes) mesh.triangles.resize(std::min(mesh.triangles.size(), triangles));
  return meshes;
}

class Inspection : public testing::TestWithParam<std::tuple<Family, OptionWord<BoundingVolume>>> {
 protected:
  std::vector<TriangleMesh> meshes(std::uint64_t seed) const { return std::get<0>(GetParam()).make(seed); }
  SceneOptions options() const {
    SceneOptions scene_options;
    scene_options.bounding_volume = std::get<1>(GetParam());
    return scene_options;
  }
  bool are_boxes() const { return std::get<1>(GetParam()) == BoundingVolume::aabb; }
};

TEST_P(Inspection, ExplanationsAgreeWithDetect) {
  Known known = known_scene_of(cut(meshes(1), 50), options());
  known.scene.detect();
  check_all_explanations(known);
}

TEST_P(Inspection, CandidatesAreThoseOfBruteForce) {
  Known known = known_scene_of(cut(meshes(2), 300), options());
  known.scene.detect();
  check_candidates(known, are_boxes());
  // The objects are at rest: the step reuses the contacts, and the candidates stay the same.
  known.scene.detect();
  check_candidates(known, are_boxes());
}

TEST_P(Inspection, CellsHoldTheirTriangles) {
  Known known = known_scene_of(meshes(3), options());
  known.scene.detect();
  check_all_cells(known);
}

TEST_P(Inspection, FollowsTranslatedAndStaticObjects) {
  const auto all = cut(meshes(4), 50);
  Known known(options());
  double size = 1;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const ObjectId id = known.add(all[i], {.self_collision = i % 2 == 0, .is_static = i % 3 == 2});
    for (const Vec3d& p : all[i].positions) {
      if (is_finite(p)) size = std::max(size, largest_magnitude(p));
    }
    if (i % 3 == 1) known.scene.translate(id, {0.0625 * size, -0.03125 * size, 0.001 * size});
    if (i % 3 == 0)
      known.scene.set_transform(id, {{0, -1, 0, 1, 0, 0, 0, 0, 1}, {0.01 * size, 0.02 * size, 0}});
  }
  known.scene.detect();
  check_all_cells(known);
  check_all_explanations(known);
  const auto [found, total] = SceneInspector(known.scene).candidates(no_limit);
  EXPECT_EQ(total, found.size());
  EXPECT_TRUE(std::is_sorted(found.begin(), found.end()));
  if (are_boxes()) {
    // The boxes of moving objects are enlarged for rounding, which adds a few candidates.
    const auto expected = candidates_by_brute_force(known);
    EXPECT_TRUE(std::includes(found.begin(), found.end(), expected.begin(), expected.end()));
  }
}

TEST_P(Inspection, ExplanationsAgreeWithContinuousDetect) {
  for (const double separation : {0.0, 0.01}) {
    SceneOptions continuous = options();
    continuous.contacts = ContactKinds::continuous;
    continuous.impact.min_separation = separation;
    // With a separation, exact arithmetic takes minutes in these scenes.
    continuous.impact.exact = separation == 0;
    const auto from = cut(meshes(6), 12), to = meshes(7);
    Known known = known_scene_of(from, continuous);
    const std::vector<ObjectId> ids = known.scene.objects();
    for (std::size_t i = 0; i < ids.size(); ++i) {
      known.scene.set_motion(ids[i], from[i].positions, to[i].positions);
      known.start[ids[i]] = from[i].positions;
    }
    known.scene.detect();
    std::set<NamedPair> touching;
    for (const Named& p : known.all()) {
      for (const Named& q : known.all()) {
        for (const ContinuousContact& c : known.scene.result().continuous_contacts) {
          const auto has = [&](const Named& t, ObjectId object, bool is_face,
                               const std::array<std::uint32_t, 2>& element) {
            if (t.object != object) return false;
            if (is_face) return t.triangle == element[0];
            const Triangle& corners = known.corners(t);
            return std::count(corners.begin(), corners.end(), element[0]) > 0 &&
                   std::count(corners.begin(), corners.end(), element[1]) > 0;
          };
          if (has(p, c.object_a, c.kind == ElementPairKind::face_vertex, c.element_a) &&
              has(q, c.object_b, c.kind == ElementPairKind::vertex_face, c.element_b)) {
            touching.insert(std::minmax(p, q));
          }
        }
      }
    }
    const std::vector<Named> all = known.all();
    for (std::size_t i = 0; i < all.size(); ++i) {
      for (std::size_t j = i; j < all.size(); j += 3) {
        const PairExplanation e =
            SceneInspector(known.scene)
                .explain(all[i].object, all[i].triangle, all[j].object, all[j].triangle);
        ASSERT_EQ(e.stage == PairStage::contact, touching.count({all[i], all[j]}) != 0);
        if (e.stage == PairStage::octree_volumes || e.stage == PairStage::triangle_boxes)
          expect_apart(e, known.points(all[i]), known.points(all[j]));
      }
    }
    check_all_cells(known);
    check_candidates(known, are_boxes());
  }
}

INSTANTIATE_TEST_SUITE_P(HardFamilies, Inspection,
                         testing::Combine(testing::ValuesIn(hard_families()),
                                          testing::ValuesIn(option_words(all_bounding_volumes))),
                         [](const auto& instance) {
                           return std::get<0>(instance.param).name + std::string("_") +
                                  name_of(std::get<1>(instance.param));
                         });

TEST(InspectionOfScenes, SmoothPartsThatAreNotLookedAtHaveCandidatesToo) {
  Known known;
  // The sheet is oblique to the axes, so the boxes of nearby triangles overlap.
  TriangleMesh sheet = make_cloth(12, 12);
  for (Vec3d& p : sheet.positions) p.y += p.x + p.z;
  const ObjectId id = known.add(sheet, {.self_collision = true}, 64);
  for (int step = 0; step < 3; ++step) {
    known.scene.set_positions(id, sheet.positions);
    known.scene.detect();
  }
  check_candidates(known, true);
  EXPECT_LT(known.scene.result().stats.candidate_pairs,
            SceneInspector(known.scene).candidates(no_limit).total);
}

TEST(InspectionOfScenes, SeesRebuiltOctrees) {
  Known known;
  const TriangleMesh soup = random_soup(400, 1, 0.1, 1);
  const ObjectId id = known.add(soup);
  // Each triangle moves in its own direction and ends far from its initial neighbours.
  RandomNumbers random(77);
  std::vector<Vec3d> ways, positions = soup.positions;
  for (std::size_t t = 0; t < soup.triangles.size(); ++t) ways.push_back(random.vector(0.05));
  for (int step = 0; step < 60; ++step) {
    for (std::size_t t = 0; t < soup.triangles.size(); ++t) {
      for (const std::uint32_t vertex : soup.triangles[t]) positions[vertex] = positions[vertex] + ways[t];
      if (step % 20 == 19) ways[t] = -1.0 * ways[t];
    }
    known.scene.set_positions(id, positions);
    known.scene.detect();
  }
  EXPECT_GT(SceneInspector(known.scene).octree_statistics(id).rebuilds, 0u);
  EXPECT_FALSE(known.scene.result().contacts.empty());
  check_all_cells(known);
  check_all_explanations(known);
  check_candidates(known, true);
}

TEST(InspectionOfScenes, FollowsTheGroupsOfVertices) {
  const TriangleMesh ball = make_icosphere(2);
  for (const ContactKinds kinds : {ContactKinds::intersection, ContactKinds::proximity}) {
    Scene scene({.contacts = kinds});
    const ObjectId a = scene.add(ball, {.margin = 1}), b = scene.add(ball, {.margin = 1});
    // Only the first vertex of each may touch the other one.
    std::vector<std::uint32_t> groups(ball.positions.size(), 1), masks(ball.positions.size(), 2);
    for (const ObjectId id : {a, b}) {
      scene.set_vertex_groups(id, groups, masks);
      groups[0] = 3;
      masks[0] = 3;
    }
    scene.detect();
    std::size_t not_tested = 0;
    for (std::uint32_t p = 0; p < ball.triangles.size(); ++p) {
      const auto stage = SceneInspector(scene).explain(a, p, b, p).stage;
      const Triangle& t = ball.triangles[p];
      const bool may_touch = std::find(t.begin(), t.end(), 0) != t.end();
      EXPECT_EQ(stage, may_touch ? PairStage::contact : PairStage::not_tested) << p;
      not_tested += stage == PairStage::not_tested;
    }
    EXPECT_GT(not_tested, 0u);
  }
}

/// A triangle that has all of these vertices.
std::uint32_t triangle_with(const TriangleMesh& mesh, const ElementVertices& element) {
  const auto found = std::ranges::find_if(mesh.triangles, [&](const Triangle& triangle) {
    return std::all_of(element.begin(), element.end(), [&](std::uint32_t vertex) {
      return std::ranges::find(triangle, vertex) != triangle.end();
    });
  });
  return static_cast<std::uint32_t>(found - mesh.triangles.begin());
}

/// Two waved sheets in one object, the upper one on its way down.
TEST(InspectionOfScenes, KnowsWhatTouchesOnTheWayOrIsNearWithinOneObject) {
  TriangleMesh sheets = make_cloth(6, 6, 6, 6);
  const auto count = static_cast<std::uint32_t>(sheets.positions.size());
  for (std::uint32_t v = 0; v < count; ++v) {
    const Vec3d p = sheets.positions[v];
    sheets.positions.push_back({p.x + 0.3, p.y + 0.5, p.z + 0.2});
    sheets.positions[v] = {p.x, p.y + 0.1 * static_cast<double>(v % 5), p.z};
  }
  const std::size_t triangles = sheets.triangles.size();
  for (std::size_t t = 0; t < triangles; ++t) {
    const Triangle ids = sheets.triangles[t];
    sheets.triangles.push_back({ids[0] + count, ids[1] + count, ids[2] + count});
  }
  std::vector<Vec3d> to = sheets.positions;
  for (std::uint32_t v = count; v < 2 * count; ++v) to[v].y -= 0.6;

  const auto check = [&](const Scene& scene, ObjectId id, const auto& pairs) {
    EXPECT_GT(pairs.size(), 20u);
    for (const auto& pair : pairs) {
      const std::uint32_t a = triangle_with(sheets, scene.vertices_of(pair, ContactSide::a)),
                          b = triangle_with(sheets, scene.vertices_of(pair, ContactSide::b));
      EXPECT_EQ(SceneInspector(scene).explain(id, a, id, b).stage, PairStage::contact) << a << " " << b;
    }
    // The first triangle lies beyond the end of the other sheet.
    EXPECT_NE(SceneInspector(scene).explain(id, 0, id, static_cast<std::uint32_t>(2 * triangles - 1)).stage,
              PairStage::contact);
  };
  Scene still({.contacts = ContactKinds::proximity});
  const ObjectId of_still = still.add(sheets, {.self_collision = true, .margin = 0.1});
  check(still, of_still, still.detect().proximity_pairs);
  Scene moving({.contacts = ContactKinds::continuous});
  const ObjectId of_moving = moving.add(sheets, {.self_collision = true});
  moving.set_motion(of_moving, sheets.positions, to);
  check(moving, of_moving, moving.detect().continuous_contacts);
}

TEST(InspectionOfScenes, KnowsTheGapBetweenObjectsThatAreFarFromEachOther) {
  for (const ContactKinds contacts : {ContactKinds::continuous, ContactKinds::proximity}) {
    Scene scene({.contacts = contacts});
    TriangleMesh box = make_box({1, 1, 1}, 1);
    const ObjectId a = scene.add(box, {.margin = 0.25});
    for (Vec3d& p : box.positions) p.x += 4;
    const ObjectId b = scene.add(box, {.margin = 0.25});
    scene.detect();
    const PairExplanation explanation = SceneInspector(scene).explain(a, 0, b, 0);
    EXPECT_EQ(explanation.stage, PairStage::object_volumes);
    EXPECT_NEAR(explanation.distance, 3, 1e-5) << "the gap between the objects, without margins";
    EXPECT_EQ(explanation.axis, (Vec3d{1, 0, 0}));
  }
}

TEST(InspectionOfScenes, KnowsNeighboursThatMeetElsewhere) {
  // A fan of three triangles around a vertex; the third one cuts through the first.
  TriangleMesh fan;
  fan.positions = {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {4, 2, -2}, {4, 1, 3}};
  fan.triangles = {{0, 1, 2}, {0, 3, 4}, {0, 2, 3}};
  for (const Neighbours neighbours : {Neighbours::skip, Neighbours::exact}) {
    Scene scene;
    const ObjectId id = scene.add(fan, {.self_collision = true, .neighbours = neighbours});
    const auto contacts = scene.detect().contacts;
    for (std::uint32_t p = 0; p < 3; ++p) {
      for (std::uint32_t q = 0; q < 3; ++q) {
        const bool listed = std::any_of(contacts.begin(), contacts.end(), [&](const Contact& c) {
          return c.triangle_a == std::min(p, q) && c.triangle_b == std::max(p, q);
        });
        EXPECT_EQ(SceneInspector(scene).explain(id, p, id, q).stage,
                  listed ? PairStage::contact : PairStage::shared_vertex);
      }
    }
    EXPECT_EQ(contacts.size(), neighbours == Neighbours::exact ? 1u : 0u);
  }
}

TEST(InspectionOfScenes, FollowsFiltersGroupsAndRemovals) {
  const TriangleMesh ball = make_icosphere(2);
  Known known;
  const ObjectId a = known.add(ball), b = known.add(ball), c = known.add(ball), d = known.add(ball);
  known.scene.set_options(b, {.group = 2, .mask = 2});
  known.scene.set_pair_filter([&](ObjectId p, ObjectId q) { return !(p == a && q == c); });
  known.scene.detect();
  EXPECT_EQ(SceneInspector(known.scene).explain(a, 0, b, 0).stage, PairStage::not_tested);
  EXPECT_EQ(SceneInspector(known.scene).explain(a, 0, c, 0).stage, PairStage::not_tested);
  EXPECT_EQ(SceneInspector(known.scene).explain(a, 0, d, 0).stage, PairStage::contact);
  EXPECT_EQ(SceneInspector(known.scene).explain(a, 3, a, 3).stage, PairStage::shared_vertex);
  known.scene.set_options(a, {.self_collision = false});
  known.remove(c);
  EXPECT_THROW(SceneInspector(known.scene).explain(a, 0, d, 0), Error) << "the scene changed since detect";
  EXPECT_THROW(SceneInspector(known.scene).candidates(1), Error);
  known.scene.detect();
  EXPECT_EQ(SceneInspector(known.scene).explain(a, 3, a, 4).stage, PairStage::not_tested);
  EXPECT_THROW(SceneInspector(known.scene).explain(a, 0, c, 0), Error);
  for (const CandidatePair& pair : SceneInspector(known.scene).candidates(no_limit).pairs) {
    EXPECT_NE(pair.object_a, c);
    EXPECT_NE(pair.object_b, c);
  }
  const ObjectId e = known.add(ball);
  EXPECT_EQ(e.index, c.index);
  known.scene.detect();
  EXPECT_EQ(SceneInspector(known.scene).explain(e, 0, d, 0).stage, PairStage::contact);
}

TEST(InspectionOfScenes, SaysWhatCannotBeAsked) {
  Known known;
  const ObjectId ball = known.add(make_icosphere(2)), nothing = known.add(TriangleMesh{});
  EXPECT_THROW(SceneInspector(known.scene).cells(ball, {}), Error) << "detect has not run yet";
  known.scene.detect();
  EXPECT_TRUE(SceneInspector(known.scene).cells(nothing, {}).empty());
  EXPECT_TRUE(SceneInspector(known.scene).cells(nothing, 0).empty());
  EXPECT_EQ(SceneInspector(known.scene).octree_depth(nothing), 0u);
  EXPECT_THROW(SceneInspector(known.scene).cells({7, 0}, {}), Error);
  EXPECT_THROW(SceneInspector(known.scene).octree_depth({7, 0}), Error);
  EXPECT_THROW(SceneInspector(known.scene).explain(ball, 0, nothing, 0), Error);
  EXPECT_THROW(SceneInspector(known.scene).explain(ball, 1u << 31, ball, 0), Error);
  try {
    SceneInspector(known.scene).explain(ball, 0, ball, 12345);
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("no triangle 12345; it has "), std::string::npos)
        << error.what();
  }
  known.scene.translate(ball, {1, 0, 0});
  EXPECT_THROW(SceneInspector(known.scene).cells(ball, {}), Error) << "the object moved";
}

TEST(InspectionOfScenes, AnObjectOfOneLeafIsItsRoot) {
  Known known;
  TriangleMesh two = make_icosphere(1);
  two.triangles.resize(2);
  const ObjectId id = known.add(two);
  known.scene.detect();
  EXPECT_EQ(SceneInspector(known.scene).octree_depth(id), 0u);
  for (const std::optional<std::uint32_t> level : {std::optional<std::uint32_t>{}, {0u}, {5u}}) {
    const std::vector<OctreeCell> cells = SceneInspector(known.scene).cells(id, level);
    ASSERT_EQ(cells.size(), 1u);
    EXPECT_EQ(cells[0].level, 0u);
    EXPECT_TRUE(cells[0].is_leaf);
    EXPECT_EQ(cells[0].triangle_count, 2u);
    EXPECT_EQ(cells[0].box, SceneInspector(known.scene).bounds(id));
  }
}

TEST(InspectionOfScenes, FarFromTheOriginDistancesStayTrue) {
  Known known;
  const TriangleMesh ball = make_icosphere(2);
  const ObjectId a = known.add(ball), b = known.add(ball);
  known.scene.translate(a, {1e6, 0, 0});
  known.scene.translate(b, {1e6 + 1.5, 1.5, 0});
  known.scene.detect();
  int told_by_cells = 0;
  for (std::uint32_t t = 0; t < ball.triangles.size(); t += 3) {
    const PairExplanation e = SceneInspector(known.scene).explain(a, t, b, 0);
    if (e.stage != PairStage::octree_volumes) continue;
    ++told_by_cells;
    EXPECT_GT(e.distance, 0);
    EXPECT_GE(gap_along(e.axis, known.points({a, t}), known.points({b, 0})), e.distance - 1e-6);
    EXPECT_TRUE(holds(e.box_a, known.points({a, t})));
    EXPECT_TRUE(holds(e.box_b, known.points({b, 0})));
  }
  EXPECT_GT(told_by_cells, 0);
}

TEST(InspectionOfScenes, InertTrianglesAreToldFromOthers) {
  Known known;
  TriangleMesh ball = make_icosphere(2);
  const ObjectId a = known.add(ball);
  ball.positions[0].y = not_a_number;
  const ObjectId b = known.add(ball);
  known.scene.detect();
  check_all_explanations(known);
  check_all_cells(known);
  check_candidates(known, true);
  bool some_inert = false;
  for (std::uint32_t t = 0; t < ball.triangles.size(); ++t)
    some_inert = some_inert || SceneInspector(known.scene).explain(a, 0, b, t).stage == PairStage::inert;
  EXPECT_TRUE(some_inert);
}

}  // namespace supple::inspection_test
