// Real meshes whose intersecting pairs are known from exact arithmetic. The truth has the count and the
// SHA-256 of the sorted list.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "supple/inspection.hpp"
#include "support/configurations.hpp"
#include "support/scenes.hpp"
#include "support/shared_meshes.hpp"
#include "support/truth_data.hpp"

namespace supple::truth_test {

using nlohmann::json;

struct Truth : testing::Test {
  void SetUp() override {
    std::ifstream file(shared_meshes() / "truth.json");
    if (!file) GTEST_SKIP() << "no " << shared_meshes() << "; set SUPPLE_DATA to the folder of truth.json";
    file >> truth;
  }

  static TriangleMesh load(const json& mesh) { return load_shared_mesh(mesh.get<std::string>()); }

  static void expect_pairs(const DetectResult& result, const json& expected) {
    EXPECT_EQ(result.contacts.size(), expected["intersecting_pairs"].get<std::size_t>());
    std::string list;
    for (const Contact& c : result.contacts) {
      list += std::to_string(c.triangle_a) + ' ' + std::to_string(c.triangle_b) + '\n';
    }
    EXPECT_EQ(sha256(list), expected["sha256_of_sorted_pairs"].get<std::string>());
  }

  /// With boxes, the search must keep every pair of triangles whose boxes overlap.
  static void expect_candidates(const DetectResult& result, const json& expected) {
    EXPECT_GE(result.stats.candidate_pairs, expected["box_overlapping_pairs"].get<std::uint64_t>());
  }

  json truth;
};

TEST_F(Truth, SelfIntersections) {
  for (const json& expected : truth["self"]) {
    SCOPED_TRACE(expected["name"].get<std::string>());
    Scene scene;
    scene.add(load(expected["mesh"]), {.self_collision = true});
    expect_pairs(scene.detect(), expected);
  }
}

TEST_F(Truth, PairsOfPlacedMeshes) {
  for (const json& expected : truth["pairs"]) {
    SCOPED_TRACE(expected["name"].get<std::string>());
    for (const BoundingVolume volume : all_bounding_volumes) {
      Scene scene({.bounding_volume = volume});
      for (const auto& [mesh, placement] : {std::pair{"a", "ta"}, std::pair{"b", "tb"}}) {
        TriangleMesh placed = load(expected[mesh]);
        transform(placed, expected[placement]);
        scene.add(placed);
      }
      expect_pairs(scene.detect(), expected);
      if (volume == BoundingVolume::aabb) expect_candidates(scene.result(), expected);
    }
  }
}

/// Each configuration once, in turn over the pairs of meshes.
TEST_F(Truth, EveryConfigurationFindsThePairsOfPlacedMeshes) {
  const std::vector<Configuration> configurations = all_configurations();
  const std::size_t pair_count = truth["pairs"].size();
  for (std::size_t pair = 0; pair < pair_count; ++pair) {
    const json& expected = truth["pairs"][pair];
    SCOPED_TRACE(expected["name"].get<std::string>());
    std::vector<TriangleMesh> meshes;
    for (const auto& [mesh, placement] : {std::pair{"a", "ta"}, std::pair{"b", "tb"}}) {
      meshes.push_back(load(expected[mesh]));
      transform(meshes.back(), expected[placement]);
    }
    for (std::size_t i = pair; i < configurations.size(); i += pair_count) {
      SCOPED_TRACE(configurations[i].name());
      Scene scene(configurations[i].scene);
      for (const TriangleMesh& mesh : meshes) scene.add(mesh, {.octree = configurations[i].octree});
      expect_pairs(scene.detect(), expected);
    }
  }
}

/// Removes the triangles that cross the plane x = c in the middle of the mesh, searches, and adds them again.
/// Returns the number that each triangle had before.
std::vector<std::uint32_t> cut_and_sew(Scene& scene, ObjectId id, const TriangleMesh& mesh) {
  std::vector<double> xs;
  for (const Vec3d& p : mesh.positions) xs.push_back(p.x);
  std::ranges::nth_element(xs, xs.begin() + static_cast<std::ptrdiff_t>(xs.size() / 2));
  const double middle = xs[xs.size() / 2];
  std::vector<std::uint32_t> cut, before(mesh.triangles.size());
  std::vector<Triangle> sewn;
  std::iota(before.begin(), before.end(), 0u);
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto [p, q, r] = mesh.triangles[t];
    const auto [low, high] = std::minmax({mesh.positions[p].x, mesh.positions[q].x, mesh.positions[r].x});
    if (low > middle || high < middle) continue;
    cut.push_back(t);
    sewn.push_back(mesh.triangles[t]);
  }
  scene.edit(id, {.removed = cut});
  scene.detect();
  EXPECT_EQ(SceneInspector(scene).validate(), "");
  scene.edit(id, {.added = sewn});
  before.insert(before.end(), cut.begin(), cut.end());
  return before;
}

TEST_F(Truth, MeshesCutByAPlaneAndSewnTouchAsBefore) {
  for (const char* const kind : {"self", "pairs"}) {
    for (const json& expected : truth[kind]) {
      SCOPED_TRACE(expected["name"].get<std::string>());
      Scene scene;
      std::array<std::vector<std::uint32_t>, 2> before;
      if (kind == std::string("self")) {
        const TriangleMesh mesh = load(expected["mesh"]);
        before[0] = before[1] = cut_and_sew(scene, scene.add(mesh, {.self_collision = true}), mesh);
      } else {
        for (std::size_t side = 0; side < 2; ++side) {
          TriangleMesh placed = load(expected[side == 0 ? "a" : "b"]);
          transform(placed, expected[side == 0 ? "ta" : "tb"]);
          before[side] = cut_and_sew(scene, scene.add(placed), placed);
        }
      }
      std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
      for (const Contact& c : scene.detect().contacts) {
        pairs.emplace_back(before[0][c.triangle_a], before[1][c.triangle_b]);
        if (kind == std::string("self") && pairs.back().first > pairs.back().second)
          std::swap(pairs.back().first, pairs.back().second);
      }
      std::ranges::sort(pairs);
      std::string list;
      for (const auto& [a, b] : pairs) list += std::to_string(a) + ' ' + std::to_string(b) + '\n';
      EXPECT_EQ(sha256(list), expected["sha256_of_sorted_pairs"].get<std::string>());
    }
  }
}

TEST_F(Truth, SequencesMoveOneObject) {
  Scene scene;
  const ObjectId figure = scene.add(load("kick/43.obj"), {.self_collision = true});
  for (const json& expected : truth["self"]) {
    if (expected["name"].get<std::string>().rfind("kick", 0) != 0) continue;
    SCOPED_TRACE(expected["name"].get<std::string>());
    scene.set_positions(figure, load(expected["mesh"]).positions);
    expect_pairs(scene.detect(), expected);
    EXPECT_EQ(SceneInspector(scene).validate(), "");
  }
}

TEST_F(Truth, VerifyAgreesOnRealMeshes) {
  Scene scene;
  scene.add(load("scalable-ccd/cloth-funnel/frames/228.ply"), {.self_collision = true});
  scene.detect();
  EXPECT_EQ(differences(scene), "");
  Scene touching;
  touching.add(load("models/mat40x40.obj"));
  TriangleMesh turned = load("models/mat40x40.obj");
  transform(turned, "p:+x-z+y");
  touching.add(turned);
  touching.detect();
  EXPECT_EQ(differences(touching), "");
}

/// Sorted pairs of element numbers with their times.
using TouchingTimes = std::map<std::pair<std::uint32_t, std::uint32_t>, double>;

void expect_touching(const TouchingTimes& found, const json& expected) {
  EXPECT_EQ(found.size(), expected["pairs"].get<std::size_t>());
  std::string list;
  for (const auto& [pair, time] : found)
    list += std::to_string(pair.first) + ' ' + std::to_string(pair.second) + '\n';
  EXPECT_EQ(sha256(list), expected["sha256_of_sorted_pairs"].get<std::string>());
}

TEST_F(Truth, StepsTouchWhereAndWhenExactArithmeticSays) {
  constexpr double printed = 1e-15;  // the listed times have 15 digits
  for (const json& expected : truth["steps"]) {
    SCOPED_TRACE(expected["name"].get<std::string>());
    const TriangleMesh from = load(expected["frame0"]), to = load(expected["frame1"]);
    SceneOptions options;
    options.contacts = ContactKinds::continuous;
    Scene scene(options);
    scene.set_motion(scene.add(from, {.self_collision = true}), from.positions, to.positions);
    const auto numbers = edge_numbers(from);
    const auto number = [&](const std::array<std::uint32_t, 2>& edge) {
      return numbers.at({edge[1], edge[0]});
    };
    std::map<std::string, TouchingTimes> found;
    for (const ContinuousContact& contact : scene.detect().continuous_contacts) {
      if (contact.kind == ElementPairKind::edge_edge) {
        const std::uint32_t a = number(contact.element_a), b = number(contact.element_b);
        found["ee"][std::minmax(a, b)] = contact.toi;
      } else {
        found["vf"][{contact.element_a[0], contact.element_b[0]}] = contact.toi;
      }
    }
    expect_touching(found["vf"], expected["touching_vf"]);
    expect_touching(found["ee"], expected["touching_ee"]);
    const auto earliest = scene.earliest_impact();
    EXPECT_EQ(earliest.has_value(), found["vf"].size() + found["ee"].size() != 0);

    std::ifstream list(shared_meshes() / "contacts" / (expected["name"].get<std::string>() + ".txt"));
    std::string kind;
    std::uint32_t first = 0, second = 0;
    double time = 0;
    while (list >> kind >> first >> second >> time) {
      const auto contact = found[kind].find({first, second});
      ASSERT_NE(contact, found[kind].end()) << kind << ' ' << first << ' ' << second;
      EXPECT_LE(contact->second, time + printed) << kind << ' ' << first << ' ' << second;
      EXPECT_GE(contact->second, time - toi_tolerance - printed) << kind << ' ' << first << ' ' << second;
      EXPECT_LE(earliest->toi, time + printed);
    }
  }
}

/// A line search goes a part of the safe step at a time. It always advances, down to gaps of rounding.
TEST_F(Truth, SafeStepsOfRealFramesAlwaysAdvance) {
#ifdef NDEBUG
  constexpr int parts = 20;
#else
  constexpr int parts = 4;
#endif
  for (const json& step : truth["steps"]) {
    SCOPED_TRACE(step["name"].get<std::string>());
    const TriangleMesh from = load(step["frame0"]), to = load(step["frame1"]);
    Scene scene({.contacts = ContactKinds::continuous});
    const ObjectId object = scene.add(from, {.self_collision = true});
    std::vector<Vec3d> positions = from.positions;
    for (int i = 0; i < parts; ++i) {
      scene.set_motion(object, positions, to.positions);
      const auto impact = scene.earliest_impact();
      if (!impact) break;
      ASSERT_FALSE(impact->touching_at_start) << i;
      ASSERT_GT(impact->toi, 0) << i;
      ASSERT_GT(impact->start_distance, 0) << i;
      for (std::size_t v = 0; v < positions.size(); ++v)
        positions[v] = positions[v] + (impact->toi / 2) * (to.positions[v] - positions[v]);
    }
  }
}

}  // namespace supple::truth_test
