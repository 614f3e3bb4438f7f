// Real meshes whose near pairs are known from exact arithmetic: counts, and SHA-256 of the sorted lists.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "supple/scene.hpp"
#include "support/proximity_truth.hpp"

namespace supple::proximity_truth_test {

using nlohmann::json;

/// The pairs of one kind, such as "vf" or "VE", as numbers of proximity.json, with their distances.
using NumberedPairs = std::map<std::string, std::map<std::pair<std::uint32_t, std::uint32_t>, double>>;

using ProximityTruth = ProximityTruthTest;

/// One case of the section "proximity": one mesh with itself, or two placed meshes.
class Case {
 public:
  explicit Case(const json& expected) : expected_(expected), is_self_(expected.contains("mesh")) {
    const auto add = [&](const char* mesh, const char* placement) {
      meshes_.push_back(load_shared_mesh(expected[mesh].get<std::string>()));
      transform(meshes_.back(), expected[placement].get<std::string>());
      numbers_.push_back(edge_numbers(meshes_.back()));
    };
    if (is_self_) {
      add("mesh", "transform");
    } else {
      add("a", "ta");
      add("b", "tb");
    }
  }

  NumberedPairs find(ProximityListing listing, std::uint32_t threads) const {
    Scene scene({.contacts = ContactKinds::proximity, .proximity_listing = listing, .threads = threads});
    const double reach = std::strtod(expected_["D"].get<std::string>().c_str(), nullptr);
    for (const TriangleMesh& mesh : meshes_)
      scene.add(mesh, {.self_collision = is_self_, .margin = reach / 2});
    NumberedPairs pairs;
    for (const ProximityPair& pair : scene.detect().proximity_pairs) {
      std::uint32_t a = number(pair.object_a, pair.kind_a, pair.element_a);
      std::uint32_t b = number(pair.object_b, pair.kind_b, pair.element_b);
      if (is_self_ && pair.kind_a == pair.kind_b && b < a) std::swap(a, b);
      const std::string kinds{"VEF"[static_cast<int>(pair.kind_a)], "VEF"[static_cast<int>(pair.kind_b)]};
      EXPECT_TRUE(pairs[kinds].emplace(std::pair(a, b), pair.distance).second) << "twice: " << kinds;
      expect_consistent(scene, pair);
    }
    return pairs;
  }

 private:
  std::uint32_t number(ObjectId object, FeatureKind kind, const std::array<std::uint32_t, 2>& element) const {
    return kind == FeatureKind::edge ? numbers_[object.index].at({element[1], element[0]}) : element[0];
  }

  /// The points, the distance, the normal and the weights of a pair agree.
  static void expect_consistent(const Scene& scene, const ProximityPair& pair) {
    const Vec3d d = pair.point_a - pair.point_b;
    EXPECT_NEAR(std::hypot(d.x, d.y, d.z), pair.distance, 1e-12);
    EXPECT_NEAR(std::hypot(pair.normal.x, pair.normal.y, pair.normal.z), 1, 1e-12);
    if (pair.distance > 1e-9) {
      EXPECT_NEAR(d.x * pair.normal.x + d.y * pair.normal.y + d.z * pair.normal.z, pair.distance, 1e-12);
    }
    for (const ContactSide side : {ContactSide::a, ContactSide::b}) {
      const bool is_a = side == ContactSide::a;
      const ElementVertices vertices = scene.vertices_of(pair, side);
      Vec3d point{};
      for (std::size_t i = 0; i < vertices.size(); ++i) {
        point = point + (is_a ? pair.barycentric_a : pair.barycentric_b)[i] *
                            scene.position(is_a ? pair.object_a : pair.object_b, vertices[i]);
      }
      const Vec3d difference = point - (is_a ? pair.point_a : pair.point_b);
      EXPECT_LT(std::hypot(difference.x, difference.y, difference.z), 1e-12);
    }
  }

  const json& expected_;
  bool is_self_;
  std::vector<TriangleMesh> meshes_;
  std::vector<std::map<std::array<std::uint32_t, 2>, std::uint32_t>> numbers_;
};

void expect_list(const NumberedPairs& found, const std::string& kind, const json& expected) {
  const auto of_kind = found.find(kind);
  std::string list;
  std::size_t count = 0;
  if (of_kind != found.end()) {
    count = of_kind->second.size();
    for (const auto& [pair, distance] : of_kind->second)
      list += std::to_string(pair.first) + ' ' + std::to_string(pair.second) + '\n';
  }
  EXPECT_EQ(count, expected["pairs"].get<std::size_t>()) << kind;
  EXPECT_EQ(sha256(list), expected["sha256_of_sorted_pairs"].get<std::string>()) << kind;
}

TEST_F(ProximityTruth, EveryPairOfElementsAndOfFeatures) {
  for (const json& expected : truth["proximity"]) {
    SCOPED_TRACE(expected["name"].get<std::string>());
    const Case one(expected);
    const NumberedPairs elements = one.find(ProximityListing::elements, 2);
    expect_list(elements, "VF", expected["vf"]);
    expect_list(elements, "EE", expected["ee"]);
    if (expected.contains("fv")) expect_list(elements, "FV", expected["fv"]);
    const NumberedPairs features = one.find(ProximityListing::features, 1);
    for (const auto& [kind, list] : expected["features"].items()) expect_list(features, kind, list);

    double smallest = INFINITY;
    for (const auto& [kind, list] : elements) {
      if (kind == "EF" || kind == "FE") continue;  // the truth has no edges that go through faces
      for (const auto& [pair, distance] : list) smallest = std::min(smallest, distance);
    }
    const double expected_smallest = std::stod(expected["smallest"]["distance"].get<std::string>());
    EXPECT_NEAR(smallest, expected_smallest, 4 * 0x1p-52 * expected_smallest);
  }
}

TEST_F(ProximityTruth, EveryDistanceOfTheListedCases) {
  for (const json& expected : truth["proximity"]) {
    if (!expected.value("list", false)) continue;
    const std::string name = expected["name"].get<std::string>();
    SCOPED_TRACE(name);
    const NumberedPairs elements = Case(expected).find(ProximityListing::elements, 1);
    std::ifstream answers(shared_meshes() / "proximity" / (name + "-answers.txt"));
    std::size_t lines = 0;
    for (std::string line; std::getline(answers, line);) {
      std::istringstream words(line);
      std::string kind;
      std::uint32_t first = 0, second = 0;
      long double squared = 0;
      words >> kind >> first >> second >> squared;
      std::transform(kind.begin(), kind.end(), kind.begin(), [](char c) { return c - 'a' + 'A'; });
      const auto found = elements.at(kind).find({first, second});
      ASSERT_NE(found, elements.at(kind).end()) << line;
      const auto distance = static_cast<double>(std::sqrt(squared));
      EXPECT_NEAR(found->second, distance, 4 * 0x1p-52 * distance) << line;
      ++lines;
    }
    EXPECT_GT(lines, 0u);
  }
}

}  // namespace supple::proximity_truth_test
