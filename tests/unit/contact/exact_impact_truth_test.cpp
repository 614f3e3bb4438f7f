// Published queries with their answers, and real moving meshes with the times of all contacts.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "contact/impact/exact_impact.hpp"
#include "supple/mesh.hpp"
#include "supple/mesh_file.hpp"
#include "support/shared_meshes.hpp"

namespace supple::exact_impact_truth_test {

struct PublishedQuery {
  EdgeEdgeMotion vertices;  ///< positions of two edges, or of a vertex and a face
  bool touch = false;
};

/// Each query has eight rows: numerators and denominators of x, y and z, and the answer.
std::vector<PublishedQuery> read_queries(const std::filesystem::path& path) {
  std::vector<PublishedQuery> queries;
  std::ifstream file(path);
  std::size_t row = 0;
  for (std::string line; std::getline(file, line); ++row) {
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream numbers(line);
    std::array<double, 7> n{};
    for (double& number : n) numbers >> number;
    if (row % 8 == 0) queries.emplace_back();
    PublishedQuery& query = queries.back();
    auto& points = row % 8 < 4 ? query.vertices.start : query.vertices.end;
    points[row % 4] = {n[0] / n[1], n[2] / n[3], n[4] / n[5]};
    query.touch = n[6] == 1;
  }
  return queries;
}

TEST(ExactImpactTruth, PublishedQueries) {
  const auto folder = shared_meshes() / "sample-queries";
  if (!exists(folder)) GTEST_SKIP() << "no " << folder << "; set SUPPLE_DATA to the folder above it";
  int count = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (entry.path().extension() != ".csv") continue;
    const bool edges = entry.path().parent_path().filename() == "edge-edge";
    int wrong = 0;
    for (const auto& [vertices, touch] : read_queries(entry.path())) {
      const auto first = edges ? exact_first_contact(vertices)
                               : exact_first_contact(VertexFaceMotion{vertices.start, vertices.end});
      wrong += first.has_value() != touch;
      ++count;
    }
    EXPECT_EQ(wrong, 0) << entry.path();
  }
  EXPECT_EQ(count, 1824);
}

struct Step {
  std::string name;
  std::filesystem::path start, end;
};

/// Edges in the order of the contact lists: by the larger vertex, then by the smaller one.
std::vector<std::array<std::uint32_t, 2>> numbered_edges(const TriangleMesh& mesh) {
  std::vector<std::array<std::uint32_t, 2>> edges;
  for (const Triangle& t : mesh.triangles) {
    for (std::size_t i = 0; i < 3; ++i)
      edges.push_back({std::max(t[i], t[(i + 1) % 3]), std::min(t[i], t[(i + 1) % 3])});
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  for (auto& edge : edges) std::swap(edge[0], edge[1]);
  return edges;
}

void expect_listed_times(const Step& step, std::size_t stride) {
  SCOPED_TRACE(step.name);
  const TriangleMesh start = load_mesh(shared_meshes() / step.start),
                     end = load_mesh(shared_meshes() / step.end);
  const auto edges = numbered_edges(start);
  std::ifstream list(shared_meshes() / "contacts" / (step.name + ".txt"));
  ASSERT_TRUE(list);
  std::size_t row = 0;
  std::string kind;
  double time = 0;
  for (std::size_t first = 0, second = 0; list >> kind >> first >> second >> time; ++row) {
    if (row % stride != 0) continue;
    std::array<std::uint32_t, 4> ids;
    if (kind == "vf") {
      const Triangle& face = start.triangles[second];
      ids = {static_cast<std::uint32_t>(first), face[0], face[1], face[2]};
    } else {
      ids = {edges[first][0], edges[first][1], edges[second][0], edges[second][1]};
    }
    EdgeEdgeMotion motion;
    for (std::size_t i = 0; i < 4; ++i) {
      motion.start[i] = start.positions[ids[i]];
      motion.end[i] = end.positions[ids[i]];
    }
    const auto bracket = kind == "vf" ? exact_first_contact(VertexFaceMotion{motion.start, motion.end})
                                      : exact_first_contact(motion);
    ASSERT_TRUE(bracket) << kind << ' ' << first << ' ' << second;
    EXPECT_NEAR(bracket->low, time, 1e-14) << kind << ' ' << first << ' ' << second;
    EXPECT_LE(bracket->high, std::nextafter(bracket->low, 2)) << kind << ' ' << first << ' ' << second;
  }
}

TEST(ExactImpactTruth, TimesOfRealMotion) {
  if (!exists(shared_meshes() / "contacts")) {
    GTEST_SKIP() << "no " << shared_meshes() / "contacts"
                 << "; set SUPPLE_DATA to the folder above it";
  }
  const std::filesystem::path ccd = "scalable-ccd";
  expect_listed_times(
      {"cloth-funnel-227-228", ccd / "cloth-funnel/frames/227.ply", ccd / "cloth-funnel/frames/228.ply"}, 1);
  expect_listed_times({"cloth-ball-92-93", ccd / "cloth-ball/frames/cloth_ball92.ply",
                       ccd / "cloth-ball/frames/cloth_ball93.ply"},
                      10);
  for (int frame = 43; frame < 52; ++frame) {
    const std::string from = std::to_string(frame), to = std::to_string(frame + 1);
    expect_listed_times({"kick-" + from + "-" + to, "kick/" + from + ".obj", "kick/" + to + ".obj"}, 1);
  }
}

}  // namespace supple::exact_impact_truth_test
