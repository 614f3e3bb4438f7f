#pragma once

#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "supple/mesh.hpp"
#include "support/shared_meshes.hpp"
#include "support/truth_data.hpp"

namespace supple {

/// A test with the contents of proximity.json; skipped when the file is absent.
struct ProximityTruthTest : testing::Test {
  void SetUp() override {
    std::ifstream file(shared_meshes() / "proximity.json");
    if (!file) GTEST_SKIP() << "no " << shared_meshes() << "; set SUPPLE_DATA to the folder of truth.json";
    file >> truth;
  }
  static TriangleMesh mesh_of(const nlohmann::json& expected, const char* mesh, const char* placement) {
    TriangleMesh loaded = load_shared_mesh(expected[mesh].get<std::string>());
    transform(loaded, expected[placement].get<std::string>());
    return loaded;
  }
  nlohmann::json truth;
};

}  // namespace supple
