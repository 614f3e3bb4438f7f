// Real meshes on which the answers to queries are known from exact arithmetic.

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "supple/scene.hpp"
#include "support/proximity_truth.hpp"

namespace supple::queries_truth_test {

using nlohmann::json;

struct QueriesTruth : ProximityTruthTest {
  static std::ifstream file_of(const json& expected, const char* ending) {
    return std::ifstream(shared_meshes() / "proximity" / (expected["name"].get<std::string>() + ending));
  }
  static std::vector<Vec3d> points_of(const json& expected) {
    std::ifstream file = file_of(expected, ".txt");
    std::vector<Vec3d> points;
    for (std::string x, y, z; file >> x >> y >> z;)
      points.push_back({std::stod(x), std::stod(y), std::stod(z)});
    return points;
  }
};

TEST_F(QueriesTruth, NearestTriangles) {
  for (const json& expected : truth["closest"]) {
    SCOPED_TRACE(expected["name"].get<std::string>());
    Scene scene;
    scene.add(mesh_of(expected, "mesh", "transform"));
    const std::vector<Vec3d> points = points_of(expected);
    ASSERT_EQ(points.size(), expected["query_points"].get<std::size_t>());
    std::vector<std::optional<ClosestPoint>> found(points.size());
    scene.closest(points, found);
    std::ifstream answers = file_of(expected, "-answers.txt");
    std::size_t point = 0, read = 0;
    long double squared = 0;
    for (std::string line; std::getline(answers, line); ++read) {
      std::istringstream words(line);
      std::uint32_t triangle = 0;  // the smallest of the nearest triangles
      words >> point >> squared >> triangle;
      ASSERT_TRUE(found[point]);
      EXPECT_EQ(found[point]->triangle, triangle) << point;
      const auto distance = static_cast<double>(std::sqrt(squared));
      EXPECT_NEAR(found[point]->distance, distance, 4 * 0x1p-52 * distance) << point;
    }
    EXPECT_EQ(read, points.size());
  }
}

TEST_F(QueriesTruth, PointsInsideAndOn) {
  for (const json& expected : truth["containment"]) {
    SCOPED_TRACE(expected["name"].get<std::string>());
    Scene scene;
    scene.add(mesh_of(expected, "mesh", "transform"));
    const std::vector<Vec3d> points = points_of(expected);
    ASSERT_EQ(points.size(), expected["query_points"].get<std::size_t>());
    std::vector<Containment> found(points.size());
    scene.inside(points, found);
    std::string inside, on;
    for (std::size_t i = 0; i < found.size(); ++i) {
      if (found[i] == Containment::inside) inside += std::to_string(i) + '\n';
      if (found[i] == Containment::on) on += std::to_string(i) + '\n';
    }
    EXPECT_EQ(sha256(inside), expected["sha256_of_inside"].get<std::string>());
    EXPECT_EQ(sha256(on), expected["sha256_of_on"].get<std::string>());
  }
}

/// Depths of the vertices of one mesh inside another.
TEST_F(QueriesTruth, VerticesInsideAndTheirDepth) {
  for (const json& expected : truth["depth"]) {
    SCOPED_TRACE(expected["name"].get<std::string>());
    Scene scene;
    scene.add(mesh_of(expected, "b", "tb"));
    const std::vector<Vec3d> points = mesh_of(expected, "a", "ta").positions;
    std::vector<Containment> found(points.size());
    scene.inside(points, found);
    std::vector<std::optional<ClosestPoint>> closest(points.size());
    scene.closest(points, closest);
    std::string inside;
    double sum = 0;
    for (std::size_t i = 0; i < found.size(); ++i) {
      if (found[i] != Containment::inside) continue;
      inside += std::to_string(i) + '\n';
      sum += closest[i]->distance;
    }
    EXPECT_EQ(sha256(inside), expected["sha256_of_inside"].get<std::string>());
    const double expected_sum = std::stod(expected["depth"]["sum"].get<std::string>());
    EXPECT_NEAR(sum, expected_sum, 1e-13 * expected_sum);
    for (const json& sample : expected["depth"]["samples"]) {
      const ClosestPoint& nearest = *closest[sample[0].get<std::size_t>()];
      EXPECT_EQ(nearest.triangle, sample[2][0].get<std::uint32_t>()) << sample;
      const double depth = std::stod(sample[1].get<std::string>());
      EXPECT_NEAR(nearest.distance, depth, 4 * 0x1p-52 * depth) << sample;
    }
  }
}

TEST_F(QueriesTruth, FirstTrianglesOfRays) {
  for (const json& expected : truth["rays"]) {
    SCOPED_TRACE(expected["name"].get<std::string>());
    Scene scene;
    scene.add(mesh_of(expected, "mesh", "transform"));
    const std::vector<Vec3d> numbers = points_of(expected);
    std::vector<Ray> rays;
    for (std::size_t i = 0; i + 1 < numbers.size(); i += 2) rays.push_back({numbers[i], numbers[i + 1]});
    std::vector<std::optional<RayHit>> found(rays.size()), counted(rays.size());
    scene.cast(rays, found);
    scene.cast(rays, counted, {.count_hits = true});
    std::string counts;
    for (std::size_t i = 0; i < counted.size(); ++i)
      counts += std::to_string(i) + ' ' + std::to_string(counted[i] ? counted[i]->hits : 0) + '\n';
    EXPECT_EQ(sha256(counts), expected["sha256_of_counts"].get<std::string>());
    std::ifstream answers = file_of(expected, "-answers.txt");
    std::size_t read = 0;
    for (std::string line; std::getline(answers, line); ++read) {
      std::istringstream words(line);
      std::size_t ray = 0, hits = 0;
      std::string parameter;
      words >> ray >> hits >> parameter;
      ASSERT_EQ(found[ray].has_value(), parameter != "-") << line;
      if (!found[ray]) continue;
      std::uint32_t triangle = 0;
      words >> triangle;
      EXPECT_EQ(found[ray]->triangle, triangle) << line;
      const double t = std::stod(parameter);
      EXPECT_NEAR(found[ray]->t, t, 4 * 0x1p-52 * t) << line;
      EXPECT_EQ(counted[ray]->triangle, triangle) << line;
    }
    EXPECT_EQ(read, rays.size());
  }
}

}  // namespace supple::queries_truth_test
