// Real meshes on which the vertices inside solids and the curves of intersection are known from exact
// arithmetic.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "supple/scene.hpp"
#include "support/proximity_truth.hpp"

namespace supple::penetration_truth_test {

using nlohmann::json;

using PenetrationTruth = ProximityTruthTest;

TEST_F(PenetrationTruth, VerticesInsideAndTheirDepths) {
  for (const json& expected : truth["depth"]) {
    SCOPED_TRACE(expected["name"].get<std::string>());
    Scene scene({.contacts = ContactKinds::penetration, .curves = true});
    scene.add(mesh_of(expected, "a", "ta"));
    scene.add(mesh_of(expected, "b", "tb"), {.solid = true});
    const DetectResult& result = scene.detect();
    std::string inside;
    long double sum = 0;
    for (const Penetration& p : result.penetrations) {
      inside += std::to_string(p.vertex) + '\n';
      sum += p.depth;
    }
    EXPECT_EQ(sha256(inside), expected["sha256_of_inside"].get<std::string>());
    EXPECT_TRUE(result.vertices_on_surface.empty());
    const double expected_sum = std::stod(expected["depth"]["sum"].get<std::string>());
    EXPECT_NEAR(static_cast<double>(sum), expected_sum, 1e-14 * expected_sum);
    for (const json& sample : expected["depth"]["samples"]) {
      const auto vertex = sample[0].get<std::uint32_t>();
      const auto found = std::find_if(result.penetrations.begin(), result.penetrations.end(),
                                      [&](const Penetration& p) { return p.vertex == vertex; });
      ASSERT_NE(found, result.penetrations.end()) << sample;
      EXPECT_EQ(found->triangle, sample[2][0].get<std::uint32_t>()) << sample;
      const double depth = std::stod(sample[1].get<std::string>());
      EXPECT_NEAR(found->depth, depth, 4 * 0x1p-52 * depth) << sample;
    }
    const bool is_within = inside.size() > 0 && result.contacts.empty();
    ASSERT_EQ(result.contained_parts.size(), is_within ? 1u : 0u);
    if (is_within) {
      EXPECT_TRUE(result.contained_parts[0].is_whole);
      EXPECT_EQ(result.contained_parts[0].vertex_count, result.penetrations.size());
    }
  }
}

TEST_F(PenetrationTruth, Curves) {
  for (const json& expected : truth["contours"]) {
    SCOPED_TRACE(expected["name"].get<std::string>());
    Scene scene({.contacts = ContactKinds::penetration, .curves = true});
    scene.add(mesh_of(expected, "a", "ta"));
    scene.add(mesh_of(expected, "b", "tb"));
    const DetectResult& result = scene.detect();
    json curves = json::array();
    for (const IntersectionCurve& curve : result.curves) {
      const auto contacts = result.contacts_of(curve);
      const Contact& first = result.contacts[*std::min_element(contacts.begin(), contacts.end())];
      curves.push_back({first.triangle_a, first.triangle_b, contacts.size(), word_of(curve.kind)});
      // Each segment goes from one point of the curve to the next.
      const auto points = result.points_of(curve);
      ASSERT_EQ(points.size(), contacts.size() + (curve.kind == CurveKind::open ? 1 : 0));
      for (std::size_t i = 0; i < contacts.size(); ++i) {
        const auto ends = result.points_of(result.contacts[contacts[i]]);
        const auto is_end = [&](const Vec3d& p) {
          return std::any_of(ends.begin(), ends.end(), [&](const ContactPoint& end) {
            const Vec3d gap{end.position.x - p.x, end.position.y - p.y, end.position.z - p.z};
            return std::hypot(gap.x, gap.y, gap.z) < 1e-12;
          });
        };
        EXPECT_TRUE(is_end(points[i])) << i;
        EXPECT_TRUE(is_end(points[(i + 1) % points.size()])) << i;
      }
    }
    EXPECT_EQ(curves, expected["curve_list"]);
  }
}

}  // namespace supple::penetration_truth_test
