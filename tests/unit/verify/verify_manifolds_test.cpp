// Verification finds each kind of wrong manifold.

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <vector>

#include "supple/models.hpp"
#include "supple/scene.hpp"
#include "supple/verify.hpp"
#include "verify/brute_force.hpp"

namespace supple::verify_manifolds_test {

TEST(VerifyManifolds, FindsEachFault) {
  using Fault = std::function<void(Manifold&, std::vector<ManifoldPoint>&)>;
  const std::vector<Fault> faults{
      [](Manifold& m, auto&) { m.normal = -m.normal; },
      [](Manifold& m, auto&) { m.normal = 2 * m.normal; },
      [](Manifold& m, auto&) { m.depth += 0.001; },
      [](Manifold&, auto& points) { points[0].position.x += 0.001; },
      [](Manifold&, auto& points) { points[1].depth += 0.001; },
      [](Manifold& m, auto& points) {
        // The deepest point is missing.
        std::ranges::sort(points, std::ranges::greater{}, &ManifoldPoint::depth);
        ++m.first_point;
        --m.point_count;
      },
  };
  for (const ContactKinds kinds : {ContactKinds::penetration, ContactKinds::proximity}) {
    Scene scene({.contacts = kinds, .manifolds = true});
    const TriangleMesh box = make_box({2, 2, 2}, 3);
    scene.add(box, {.margin = 0.25, .solid = true});
    const ObjectId upper = scene.add(make_icosphere(4), {.margin = 0.25, .solid = true});
    scene.set_transform(
        upper, RigidTransform::from_quaternion(0.1, 0.2, 0.3, 1,
                                               {0, kinds == ContactKinds::proximity ? 2.125 : 1.75, 0}));
    DetectResult result = scene.detect();
    ASSERT_EQ(result.manifolds.size(), 1u);
    EXPECT_TRUE(verify(scene).agrees());
    PlainObject a, b;
    a.triangles = box.triangles;
    b.triangles = make_icosphere(4).triangles;
    for (std::uint32_t v = 0; v < box.positions.size(); ++v)
      a.end.push_back(scene.position(result.manifolds[0].a, v));
    for (std::uint32_t v = 0; v < make_icosphere(4).positions.size(); ++v)
      b.end.push_back(scene.position(upper, v));
    const Manifold right = result.manifolds[0];
    const std::vector<ManifoldPoint> right_points(result.manifold_points.begin(),
                                                  result.manifold_points.end());
    const auto difference_count = [&](const Manifold& manifold, const std::vector<ManifoldPoint>& points) {
      const std::vector<Manifold> manifolds(1, manifold);
      result.manifolds = manifolds;
      result.manifold_points = points;
      VerifyReport report;
      verify_manifolds({right.a, right.b}, {&a, &b}, result, report);
      return report.difference_count();
    };
    EXPECT_EQ(difference_count(right, right_points), 0u);
    for (std::size_t i = 0; i < faults.size(); ++i) {
      Manifold manifold = right;
      std::vector<ManifoldPoint> points = right_points;
      faults[i](manifold, points);
      EXPECT_EQ(difference_count(manifold, points), 1u) << i;
    }
  }
}

}  // namespace supple::verify_manifolds_test
