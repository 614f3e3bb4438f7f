// `for_each_vertex`, data of the user, and quaternions.

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <tuple>
#include <vector>

#include "supple/error.hpp"
#include "supple/models.hpp"
#include "supple/scene.hpp"
#include "supple/verify.hpp"
#include "support/random.hpp"

namespace supple::pair_weights_test {

/// The sum of the weights and of weight times position, and the objects of the vertices.
struct Sums {
  double weight = 0;
  Vec3d way;
  std::vector<ObjectId> objects;
};

template <class Pair>
Sums sums_of(const Scene& scene, const Pair& pair) {
  Sums sums;
  scene.for_each_vertex(pair, [&](ObjectId object, std::uint32_t vertex, double weight) {
    sums.weight += weight;
    sums.way += weight * scene.position(object, vertex);
    sums.objects.push_back(object);
  });
  return sums;
}

void expect_near(const Vec3d& p, const Vec3d& q, double tolerance) {
  EXPECT_LE(norm(p - q), tolerance);
}

TEST(ForEachVertex, WeightsOfPairsGiveTheWayFromBToA) {
  Scene scene({.contacts = ContactKinds::proximity | ContactKinds::intersection});
  const TriangleMesh ball = make_icosphere(3);
  const ObjectId a = scene.add(ball, {.self_collision = true, .margin = 0.1}),
                 b = scene.add(ball, {.margin = 0.1});
  scene.translate(b, {1.85, 0.1, 0.05});
  const DetectResult& result = scene.detect();
  ASSERT_FALSE(result.proximity_pairs.empty());
  for (const ProximityPair& pair : result.proximity_pairs) {
    const Sums sums = sums_of(scene, pair);
    EXPECT_NEAR(sums.weight, 0, 1e-14);
    expect_near(sums.way, pair.point_a - pair.point_b, 1e-14);
    EXPECT_EQ(sums.objects.front(), a);
    EXPECT_EQ(sums.objects.back(), pair.object_b);
  }
  ASSERT_FALSE(result.contacts.empty());
  for (const Contact& contact : result.contacts) {
    Vec3d mean, of_a;
    for (const ContactPoint& point : result.points_of(contact))
      mean += point.position / static_cast<double>(contact.point_count);
    double weight = 0, weight_a = 0;
    std::size_t count = 0;
    scene.for_each_vertex(contact, [&](ObjectId object, std::uint32_t vertex, double w) {
      weight += w;
      if (++count <= 3) {
        EXPECT_EQ(object, contact.object_a);
        EXPECT_GE(w, 0);
        weight_a += w;
        of_a += w * scene.position(object, vertex);
      } else {
        EXPECT_EQ(object, contact.object_b);
        EXPECT_LE(w, 0);
      }
    });
    EXPECT_EQ(count, 6u);
    EXPECT_NEAR(weight_a, 1, 1e-14);
    EXPECT_NEAR(weight, 0, 1e-12);
    expect_near(of_a, mean, 1e-14);
  }
}

TEST(ForEachVertex, WeightsOfImpactsMeetAtTheTimeOfImpact) {
  Scene scene({.contacts = ContactKinds::continuous});
  const TriangleMesh ball = make_icosphere(2);
  const ObjectId a = scene.add(ball), b = scene.add(ball);
  std::vector<Vec3d> from = ball.positions, to = ball.positions;
  for (Vec3d& p : from) p += {3.03, 0.1, 0.05};
  for (Vec3d& p : to) p += {1.9, 0.2, 0};
  scene.set_motion(b, from, to);
  const DetectResult& result = scene.detect();
  ASSERT_FALSE(result.continuous_contacts.empty());
  for (const ContinuousContact& contact : result.continuous_contacts) {
    Vec3d way;
    double weight = 0;
    scene.for_each_vertex(contact, [&](ObjectId object, std::uint32_t vertex, double w) {
      weight += w;
      way += w * (object == a ? ball.positions[vertex]
                              : from[vertex] + contact.toi * (to[vertex] - from[vertex]));
    });
    EXPECT_NEAR(weight, 0, 1e-12);
    EXPECT_LE(norm(way), 1e-5);
  }
}

TEST(ForEachVertex, FlatTrianglesAndMissingPointsHaveTheCentre) {
  for (const bool with_points : {true, false}) {
    Scene scene({.contact_points = with_points});
    scene.add(std::vector<Vec3d>{{-1, 0, 0}, {1, 0, 0}, {0, 0, 0}}, std::vector<Triangle>{{0, 1, 2}});
    scene.add(std::vector<Vec3d>{{0, -1, -1}, {0, 1, -1}, {0, 0, 3}}, std::vector<Triangle>{{0, 1, 2}});
    const DetectResult& result = scene.detect();
    ASSERT_EQ(result.contacts.size(), 1u);
    std::vector<double> weights;
    scene.for_each_vertex(result.contacts[0],
                          [&](ObjectId, std::uint32_t, double weight) { weights.push_back(weight); });
    ASSERT_EQ(weights.size(), 6u);
    for (int i = 0; i < 3; ++i) EXPECT_EQ(weights[static_cast<std::size_t>(i)], 1.0 / 3);
    EXPECT_TRUE(with_points || weights[5] == -1.0 / 3);
  }
}

TEST(ForEachVertex, RefusesContactsOfAnotherResult) {
  Scene scene;
  const TriangleMesh ball = make_icosphere(2);
  const ObjectId a = scene.add(ball);
  scene.add(ball, {.name = "other"});
  scene.translate(a, {0.5, 0, 0});
  const Contact contact = scene.detect().contacts.back();
  scene.translate(a, {1.48, 0, 0});
  ASSERT_LT(scene.detect().contact_points.size(), contact.first_point);
  ASSERT_FALSE(scene.result().contact_points.empty());
  EXPECT_THROW(scene.for_each_vertex(contact, [](ObjectId, std::uint32_t, double) {}), Error);
}

TEST(UserData, StaysWithItsObject) {
  Scene scene;
  const TriangleMesh ball = make_icosphere(1);
  const ObjectId a = scene.add(ball, {.user_data = 0xfedcba9876543210u}), b = scene.add(ball);
  EXPECT_EQ(scene.options(a).user_data, 0xfedcba9876543210u);
  EXPECT_EQ(scene.options(b).user_data, 0u);
  scene.detect();
  scene.set_options(b, {.user_data = 7});
  EXPECT_EQ(scene.options(b).user_data, 7u);
  EXPECT_TRUE(verify(scene).agrees()) << "the data is no change of the scene";
  scene.remove(a);
  EXPECT_THROW(static_cast<void>(scene.options(a).user_data), Error);
  EXPECT_EQ(scene.options(scene.add(ball)).user_data, 0u);
}

TEST(Quaternion, TurnsByItsAngle) {
  const auto rotation = [](double x, double y, double z, double w) {
    return RigidTransform::from_quaternion(x, y, z, w).rotation;
  };
  using Matrix = std::array<double, 9>;
  EXPECT_EQ(rotation(0, 0, 0, 1), RigidTransform{}.rotation);
  EXPECT_EQ(rotation(0, 0, 0, -1e-300), RigidTransform{}.rotation);
  EXPECT_EQ(rotation(1, 0, 0, 1), (Matrix{1, 0, 0, 0, 0, -1, 0, 1, 0})) << "x by a quarter: y to z";
  EXPECT_EQ(rotation(0, 0x1p1000, 0, 0x1p1000), (Matrix{0, 0, 1, 0, 1, 0, -1, 0, 0}));
  EXPECT_EQ(rotation(0, 0, 5e-324, 5e-324), (Matrix{0, -1, 0, 1, 0, 0, 0, 0, 1}));
  EXPECT_EQ(rotation(1, 1, 1, 1), (Matrix{0, 0, 1, 1, 0, 0, 0, 1, 0}));
  EXPECT_EQ(RigidTransform::from_quaternion(0, 0, 0, 1, {1, 2, 3}).translation, (Vec3d{1, 2, 3}));
}

TEST(Quaternion, GivesRotationsForAnyLength) {
  RandomNumbers random(3);
  for (int round = 0; round < 2000; ++round) {
    std::array<double, 4> q{};
    for (double& number : q) number = random.uniform(-1, 1);
    const auto r = RigidTransform::from_quaternion(q[0], q[1], q[2], q[3]).rotation;
    const long double n = static_cast<long double>(q[0]) * q[0] + static_cast<long double>(q[1]) * q[1] +
                          static_cast<long double>(q[2]) * q[2] + static_cast<long double>(q[3]) * q[3];
    const auto product = [&](int i, int k) {
      return static_cast<long double>(q[static_cast<std::size_t>(i)]) * q[static_cast<std::size_t>(k)];
    };
    const std::array<long double, 9> exact{
        1 - 2 * (product(1, 1) + product(2, 2)) / n, 2 * (product(0, 1) - product(2, 3)) / n,
        2 * (product(0, 2) + product(1, 3)) / n,     2 * (product(0, 1) + product(2, 3)) / n,
        1 - 2 * (product(0, 0) + product(2, 2)) / n, 2 * (product(1, 2) - product(0, 3)) / n,
        2 * (product(0, 2) - product(1, 3)) / n,     2 * (product(1, 2) + product(0, 3)) / n,
        1 - 2 * (product(0, 0) + product(1, 1)) / n};
    for (std::size_t i = 0; i < 9; ++i) EXPECT_LE(std::fabs(static_cast<double>(r[i] - exact[i])), 0x1p-49);
    const auto scaled =
        RigidTransform::from_quaternion(0x1p900 * q[0], 0x1p900 * q[1], 0x1p900 * q[2], 0x1p900 * q[3]);
    EXPECT_EQ(scaled.rotation, r);
  }
}

TEST(Quaternion, RefusesZeroAndWhatIsNotFinite) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN(),
                   infinity = std::numeric_limits<double>::infinity();
  EXPECT_THROW(RigidTransform::from_quaternion(0, 0, 0, 0), Error);
  for (const double wrong : {nan, infinity, -infinity}) {
    EXPECT_THROW(RigidTransform::from_quaternion(wrong, 0, 0, 1), Error);
    EXPECT_THROW(RigidTransform::from_quaternion(0, 0, 0, wrong), Error);
  }
}

}  // namespace supple::pair_weights_test
