// Published queries and real moving meshes with contacts and times known from exact arithmetic.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "supple/continuous.hpp"
#include "supple/mesh.hpp"
#include "supple/mesh_file.hpp"
#include "support/shared_meshes.hpp"

namespace supple::contact_truth_test {

struct Query {
  std::array<Vec3d, 4> start, end;
  bool edges = false;
  bool touches = false;
};

std::optional<TimeBracket> answer(const Query& query) {
  if (query.edges) return first_contact_by_algebra(EdgeEdgeMotion{query.start, query.end});
  return first_contact_by_algebra(VertexFaceMotion{query.start, query.end});
}

/// A query has eight rows: numerators and denominators of x, y and z, and the answer. Quotients are doubles.
std::vector<Query> read_queries(const std::filesystem::path& path, bool edges) {
  std::ifstream file(path);
  std::vector<Query> queries;
  std::string line;
  for (std::size_t row = 0; std::getline(file, line); ++row) {
    std::ranges::replace(line, ',', ' ');
    std::istringstream fields(line);
    Vec3d point;
    for (int axis = 0; axis < 3; ++axis) {
      double numerator = 0, denominator = 0;
      fields >> numerator >> denominator;
      point[axis] = numerator / denominator;
    }
    if (row % 8 == 0) queries.emplace_back().edges = edges;
    Query& query = queries.back();
    (row % 8 < 4 ? query.start : query.end)[row % 4] = point;
    fields >> query.touches;
    EXPECT_TRUE(fields) << path << ", row " << row;
  }
  return queries;
}

struct ContactTruth : testing::Test {
  void SetUp() override {
    if (!std::filesystem::exists(shared_meshes() / "truth.json")) {
      GTEST_SKIP() << "no " << shared_meshes() << "; set SUPPLE_DATA to the folder of truth.json";
    }
  }
};

TEST_F(ContactTruth, SampleQueries) {
  std::size_t queries = 0;
  for (const char* scene :
       {"unit-tests", "erleben-cube-cliff-edges", "erleben-sliding-spike", "erleben-spike-wedge"}) {
    for (const bool edges : {false, true}) {
      for (const char* name : {"data_0_0.csv", "data_0_1.csv"}) {
        const auto path =
            shared_meshes() / "sample-queries" / scene / (edges ? "edge-edge" : "vertex-face") / name;
        for (const Query& query : read_queries(path, edges)) {
          EXPECT_EQ(answer(query).has_value(), query.touches) << path << ", query " << queries;
          ++queries;
        }
      }
    }
  }
  EXPECT_EQ(queries, 1824u);
}

struct Step {
  TriangleMesh start, end;
  std::vector<std::array<std::uint32_t, 2>> edges;
};

Step load_step(const std::string& first, const std::string& second) {
  Step step{load_mesh(shared_meshes() / first), load_mesh(shared_meshes() / second), {}};
  for (const Triangle& t : step.start.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t a = t[i], b = t[(i + 1) % 3];
      step.edges.push_back({std::max(a, b), std::min(a, b)});
    }
  }
  // The contact lists number the edges by their larger vertex, then by the smaller one.
  std::ranges::sort(step.edges);
  step.edges.erase(std::unique(step.edges.begin(), step.edges.end()), step.edges.end());
  return step;
}

/// Checks every `stride`-th line of `vf VERTEX FACE TIME` or `ee EDGE EDGE TIME`; times have 15 digits.
/// Returns the number of lines checked.
std::size_t expect_times(const Step& step, const std::string& list, std::size_t stride) {
  std::ifstream file(shared_meshes() / "contacts" / list);
  std::string line;
  std::size_t checked = 0;
  for (std::size_t row = 0; std::getline(file, line); ++row) {
    if (row % stride != 0) continue;
    std::istringstream fields(line);
    std::string kind;
    std::uint32_t a = 0, b = 0;
    double time = 0;
    fields >> kind >> a >> b >> time;
    EXPECT_TRUE(fields) << line;
    std::array<std::uint32_t, 4> ids;
    if (kind == "ee") {
      ids = {step.edges.at(a)[1], step.edges[a][0], step.edges.at(b)[1], step.edges[b][0]};
    } else {
      const Triangle& t = step.start.triangles.at(b);
      ids = {a, t[0], t[1], t[2]};
    }
    Query query;
    query.edges = kind == "ee";
    for (std::size_t i = 0; i < 4; ++i) {
      query.start[i] = step.start.positions.at(ids[i]);
      query.end[i] = step.end.positions.at(ids[i]);
    }
    const auto found = answer(query);
    EXPECT_TRUE(found) << line;
    if (!found) continue;
    EXPECT_NEAR(found->low, time, 1e-14) << line;
    EXPECT_NEAR(found->high, time, 1e-14) << line;
    ++checked;
  }
  return checked;
}

TEST_F(ContactTruth, TimesInTheFunnel) {
  const Step step =
      load_step("scalable-ccd/cloth-funnel/frames/227.ply", "scalable-ccd/cloth-funnel/frames/228.ply");
  EXPECT_EQ(expect_times(step, "cloth-funnel-227-228.txt", 1), 134u);
}

TEST_F(ContactTruth, TimesOfTheBallOnTheCloth) {
  const Step step = load_step("scalable-ccd/cloth-ball/frames/cloth_ball92.ply",
                              "scalable-ccd/cloth-ball/frames/cloth_ball93.ply");
  EXPECT_EQ(expect_times(step, "cloth-ball-92-93.txt", 100), 1139u);
}

TEST_F(ContactTruth, TimesOfTheKick) {
  std::size_t checked = 0;
  for (const int frame : {43, 44, 45, 48, 49, 50, 51}) {
    const std::string first = std::to_string(frame), second = std::to_string(frame + 1);
    const Step step = load_step("kick/" + first + ".obj", "kick/" + second + ".obj");
    checked += expect_times(step, "kick-" + first + "-" + second + ".txt", 1);
  }
  EXPECT_EQ(checked, 34u);
}

}  // namespace supple::contact_truth_test
