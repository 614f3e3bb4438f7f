// The check of curves finds wrong depths and normals.

#include <gtest/gtest.h>

#include <vector>

#include "supple/models.hpp"
#include "supple/scene.hpp"
#include "supple/verify.hpp"
#include "verify/brute_force.hpp"

namespace supple::verify_curves_test {

PlainObject plain(const TriangleMesh& mesh) {
  return {mesh.positions, mesh.positions, mesh.triangles};
}

std::vector<ExactPenetration> vertices_inside(const PlainObject& inner, const PlainObject& outer) {
  auto found = find_penetrations_by_brute_force(inner, outer, {}, Parallel(1)).vertices;
  std::erase_if(found, [](const ExactPenetration& p) { return p.where != Containment::inside; });
  return found;
}

TEST(VerifyCurves, FindsWrongDepthsAndNormals) {
  TriangleMesh crate = make_box({2, 2, 2}, 3), ground = make_box({10, 2, 10}, 1);
  for (Vec3d& p : crate.positions) p = p + Vec3d{0.25, 1.875, 0.125};
  Scene scene({.contacts = ContactKinds::penetration, .curves = true});
  const ObjectId a = scene.add(crate, {.solid = true}), b = scene.add(ground, {.solid = true});
  DetectResult result = scene.detect();
  ASSERT_EQ(result.curves.size(), 1u);
  const PlainObject plain_a = plain(crate), plain_b = plain(ground);
  const auto in_b = vertices_inside(plain_a, plain_b), in_a = vertices_inside(plain_b, plain_a);
  ASSERT_FALSE(in_b.empty());
  const auto faults_of = [&](const Vec3d& normal, double depth) {
    std::vector<IntersectionCurve> curves(result.curves.begin(), result.curves.end());
    curves[0].normal = normal;
    curves[0].depth = depth;
    DetectResult changed = result;
    changed.curves = curves;
    std::vector<PenetrationDifference> differences;
    verify_curves({a, b}, {{{&plain_a, in_b}, {&plain_b, in_a}}}, changed, differences);
    return differences.size();
  };
  const Vec3d up{0, 1, 0};
  EXPECT_EQ(faults_of(up, 0.125), 0u);
  EXPECT_EQ(faults_of(up, 0.125 * (1 + 0x1p-40)), 0u);
  EXPECT_EQ(faults_of(up, 0), in_b.size()) << "what is inside stays inside";
  EXPECT_EQ(faults_of(up, 0.12), in_b.size());
  EXPECT_EQ(faults_of({0, -1, 0}, 0.125), in_b.size()) << "the wrong way";
  EXPECT_EQ(faults_of({0, -1, 0}, 2), 0u) << "through the ground is longer, and a way out";
  EXPECT_EQ(faults_of({1, 0, 0}, 0.125), in_b.size()) << "sideways";
  EXPECT_EQ(faults_of({0, 1.001, 0}, 0.125), 1u);
  EXPECT_GT(faults_of(up, -0.125), 0u);
}

}  // namespace supple::verify_curves_test
