#include "support/shared_meshes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "supple/mesh.hpp"
#include "supple/mesh_file.hpp"
#include "supple/topology.hpp"
#include "unit/files/mesh_files.hpp"

namespace supple::shared_meshes_test {

TEST(SharedMeshes, CountsAreTheKnownOnes) {
  const std::filesystem::path folder = shared_meshes();
  std::ifstream file(folder / "truth.json");
  if (!file) GTEST_SKIP() << "no " << folder;
  const nlohmann::json meshes = nlohmann::json::parse(file).at("meshes");
  ASSERT_GE(meshes.size(), 20u);
  for (const auto& [name, truth] : meshes.items()) {
    SCOPED_TRACE(name);
    const TriangleMesh mesh = load_mesh(folder / name);
    const MeshTopology topology = compute_topology(mesh);
    EXPECT_EQ(topology.vertices, truth.at("vertices"));
    EXPECT_EQ(topology.triangles, truth.at("faces"));
    EXPECT_EQ(topology.edges, truth.at("edges"));
    EXPECT_EQ(topology.boundary_edges, truth.at("border_edges"));
    EXPECT_EQ(topology.non_manifold_edges, truth.at("edges_of_more_than_2_faces"));
    EXPECT_EQ(topology.degenerate_triangles, truth.at("faces_repeating_an_id"));
    EXPECT_EQ(topology.unused_vertices, truth.at("unused_vertices"));
    // The truth counts each unused vertex as a component.
    EXPECT_EQ(topology.components + topology.unused_vertices, truth.at("components"));
    for (int axis = 0; axis < 3; ++axis) {
      const auto less = [axis](const Vec3d& a, const Vec3d& b) { return a[axis] < b[axis]; };
      const auto [low, high] = std::minmax_element(mesh.positions.begin(), mesh.positions.end(), less);
      EXPECT_NEAR((*low)[axis], truth.at("lo")[axis], 1e-6 * std::abs((*low)[axis]));
      EXPECT_NEAR((*high)[axis], truth.at("hi")[axis], 1e-6 * std::abs((*high)[axis]));
    }
  }
}

TEST(SharedMeshes, SavedAgainTheyAreTheSame) {
  const std::filesystem::path folder = shared_meshes();
  if (!std::filesystem::exists(folder / "truth.json")) GTEST_SKIP() << "no " << folder;
  const TemporaryFolder saved;
  for (const char* name : {"models/spot.obj", "scalable-ccd/cloth-ball/frames/cloth_ball92.ply"}) {
    const TriangleMesh mesh = load_mesh(folder / name);
    for (const char* copy : {"a.obj", "a.off", "a.ply"}) {
      save_mesh(mesh, saved / copy);
      expect_same_mesh(load_mesh(saved / copy), mesh);
    }
  }
}

}  // namespace supple::shared_meshes_test
