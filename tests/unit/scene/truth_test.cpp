// Real meshes whose intersecting pairs are known from exact arithmetic: count and SHA-256 of the sorted list.

#include <gtest/gtest.h>
#include <openssl/evp.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

#include "support/scenes.hpp"
#include "unit/mesh/shared_meshes.hpp"

namespace supple {
namespace {

using nlohmann::json;

std::string sha256(const std::string& text) {
  unsigned char digest[EVP_MAX_MD_SIZE];
  unsigned int size = 0;
  EVP_Digest(text.data(), text.size(), digest, &size, EVP_sha256(), nullptr);
  std::string hex;
  for (unsigned int i = 0; i < size; ++i) {
    hex += "0123456789abcdef"[digest[i] >> 4];
    hex += "0123456789abcdef"[digest[i] & 15];
  }
  return hex;
}

/// A transform of truth.json: "s:K" scales, "p:+y-z+x" permutes with signs, "t:X:Y:Z" adds; left to right.
void transform(TriangleMesh& mesh, const std::string& steps) {
  std::istringstream stream(steps);
  for (std::string step; std::getline(stream, step, ',');) {
    if (step == "-") continue;
    if (step[0] == 't') {
      Vec3d offset;
      std::sscanf(step.c_str(), "t:%lf:%lf:%lf", &offset.x, &offset.y, &offset.z);
      for (Vec3d& p : mesh.positions) p = p + offset;
    } else if (step[0] == 's') {
      for (Vec3d& p : mesh.positions) p = p * std::stod(step.substr(2));
    } else {
      for (Vec3d& p : mesh.positions) {
        Vec3d q;
        for (int axis = 0; axis < 3; ++axis) {
          const double value = p[step[3 + 2 * axis] - 'x'];
          q[axis] = step[2 + 2 * axis] == '-' ? -value : value;
        }
        p = q;
      }
    }
  }
}

struct Truth : testing::Test {
  void SetUp() override {
    std::ifstream file(shared_meshes() / "truth.json");
    if (!file) GTEST_SKIP() << "no " << shared_meshes() << "; set SUPPLE_DATA to the folder of truth.json";
    file >> truth;
  }

  static TriangleMesh load(const json& mesh) { return load_mesh(shared_meshes() / mesh.get<std::string>()); }

  static void expect_pairs(const DetectResult& result, const json& expected) {
    EXPECT_EQ(result.contacts.size(), expected["intersecting_pairs"].get<std::size_t>());
    std::string list;
    for (const Contact& c : result.contacts) {
      list += std::to_string(c.triangle_a) + ' ' + std::to_string(c.triangle_b) + '\n';
    }
    EXPECT_EQ(sha256(list), expected["sha256_of_sorted_pairs"].get<std::string>());
  }

  /// Volumes are conservative: with boxes, no pair of triangles whose boxes overlap may be lost on the way.
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
    expect_candidates(scene.result(), expected);
  }
}

TEST_F(Truth, PairsOfPlacedMeshes) {
  for (const json& expected : truth["pairs"]) {
    SCOPED_TRACE(expected["name"].get<std::string>());
    for (const BoundingVolume volume : {BoundingVolume::aabb, BoundingVolume::sphere}) {
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

TEST_F(Truth, SequencesMoveOneObject) {
  Scene scene;
  const ObjectId figure = scene.add(load("kick/43.obj"), {.self_collision = true});
  for (const json& expected : truth["self"]) {
    if (expected["name"].get<std::string>().rfind("kick", 0) != 0) continue;
    SCOPED_TRACE(expected["name"].get<std::string>());
    scene.set_positions(figure, load(expected["mesh"]).positions);
    expect_pairs(scene.detect(), expected);
    EXPECT_EQ(scene.validate(), "");
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

}  // namespace
}  // namespace supple
