// The brute force of `verify` notices wrong penetrations.

#include "verify/brute_force.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "supple/models.hpp"
#include "supple/scene.hpp"
#include "supple/verify.hpp"

namespace supple::brute_force_penetrations_test {

class WrongPenetrations : public testing::Test {
 protected:
  using Fault = PenetrationDifference::Fault;

  WrongPenetrations() {
    const TriangleMesh ball = make_icosphere(3);
    inner_ = {ball.positions, ball.positions, ball.triangles};
    outer_ = inner_;
    for (Vec3d& p : inner_.end) p = 0.5 * p + Vec3d{0.05, 0.03, 0.01};
    Scene scene({.contacts = ContactKinds::penetration});
    const ObjectId a = scene.add(ball), b = scene.add(ball, {.solid = true});
    scene.set_positions(a, inner_.end);
    const DetectResult& result = scene.detect();
    inside_.assign(result.penetrations.begin(), result.penetrations.end());
    parts_.assign(result.contained_parts.begin(), result.contained_parts.end());
    pair_ = {a, b};
    truth_ = find_penetrations_by_brute_force(inner_, outer_, {}, Parallel(1));
  }

  std::vector<PenetrationDifference> differences() const {
    std::vector<PenetrationDifference> found;
    compare_penetrations(pair_, inside_, on_surface_, parts_, truth_, found);
    return found;
  }
  void expect_one(std::uint32_t vertex, Fault fault) const {
    EXPECT_EQ(differences(), (std::vector<PenetrationDifference>{{pair_.a, pair_.b, vertex, fault}}));
  }

  PlainObject inner_, outer_;
  ObjectPair pair_;
  std::vector<Penetration> inside_;
  std::vector<std::uint32_t> on_surface_;
  std::vector<ContainedPart> parts_;
  BruteForcePenetrations truth_;
};

TEST_F(WrongPenetrations, NoneIsReportedForTheRightOnes) {
  EXPECT_EQ(inside_.size(), inner_.end.size());
  EXPECT_TRUE(differences().empty());
}

TEST_F(WrongPenetrations, AMissingVertexIsNoticed) {
  inside_.erase(inside_.begin() + 5);
  expect_one(5, Fault::missed);
}

TEST_F(WrongPenetrations, AnAddedVertexIsNoticed) {
  truth_.vertices.erase(truth_.vertices.begin() + 7);
  expect_one(7, Fault::added);
}

TEST_F(WrongPenetrations, AnotherTriangleIsNoticed) {
  inside_[3].triangle = (inside_[3].triangle + 1) % static_cast<std::uint32_t>(outer_.triangles.size());
  expect_one(3, Fault::inexact);
}

TEST_F(WrongPenetrations, AnInaccurateDepthIsNoticed) {
  inside_[3].depth *= 1 + 0x1p-48;
  expect_one(3, Fault::inexact);
}

TEST_F(WrongPenetrations, AVertexInTheWrongListIsNoticed) {
  inside_.erase(inside_.begin() + 9);
  on_surface_.push_back(9);
  expect_one(9, Fault::missed);
}

TEST_F(WrongPenetrations, AVertexThatIsNotOnTheSurfaceIsNoticed) {
  on_surface_.push_back(1000);
  expect_one(1000, Fault::added);
}

TEST_F(WrongPenetrations, PartsAreCompared) {
  ASSERT_EQ(parts_.size(), 1u);
  parts_[0].is_whole = false;
  EXPECT_EQ(differences().size(), 2u);
  parts_.clear();
  expect_one(0, Fault::missed);
}

}  // namespace supple::brute_force_penetrations_test
