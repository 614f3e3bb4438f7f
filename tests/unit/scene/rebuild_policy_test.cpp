#include "world/object/rebuild_policy.hpp"

#include <gtest/gtest.h>

namespace supple::rebuild_policy_test {

/// The number of steps, with one query each, until the policy requests a rebuild.
int steps_until_rebuild(RebuildPolicy& policy) {
  int steps = 1;
  while (!policy.count_queries(1)) ++steps;
  return steps;
}

TEST(RebuildPolicy, RebuildsWhenTheExtraCostHasPaidForIt) {
  RebuildPolicy policy(true);
  policy.set_cost_when_built(10);
  EXPECT_FALSE(policy.is_degraded());
  EXPECT_EQ(policy.degradation(10), 1);
  policy.set_cost(12);
  EXPECT_FALSE(policy.is_degraded()) << "the expected gain is too small";
  policy.set_cost(20);
  EXPECT_TRUE(policy.is_degraded());
  EXPECT_EQ(policy.degradation(20), 2);
  const int steps = steps_until_rebuild(policy);
  // The cost ratio is 3 instead of 2, so the extra cost per step doubles.
  RebuildPolicy worse(true);
  worse.set_cost_when_built(10);
  worse.set_cost(30);
  EXPECT_EQ(steps_until_rebuild(worse), steps / 2);
}

TEST(RebuildPolicy, MeasuresEachRefitOnlyWhileDegraded) {
  RebuildPolicy policy(true);
  policy.set_cost_when_built(10);
  const auto refits_until_measured = [&] {
    int refits = 1;
    while (!policy.should_measure()) ++refits;
    return refits;
  };
  EXPECT_EQ(refits_until_measured(), 1);
  EXPECT_EQ(refits_until_measured(), 7);
  policy.set_cost(20);
  EXPECT_EQ(refits_until_measured(), 1);
  EXPECT_EQ(refits_until_measured(), 1);
  policy.set_cost(10);
  EXPECT_EQ(refits_until_measured(), 7);
}

TEST(RebuildPolicy, WaitsLongerAfterAFailureAndLessAfterASuccess) {
  RebuildPolicy policy(true);
  policy.set_cost_when_built(10);
  policy.set_cost(20);
  const int steps = steps_until_rebuild(policy);
  EXPECT_FALSE(policy.accept(15)) << "the new tree is not much better";
  EXPECT_FALSE(policy.is_degraded()) << "the cost at the attempt is the new reference";
  policy.set_cost(40);
  EXPECT_EQ(steps_until_rebuild(policy), 2 * steps);
  EXPECT_TRUE(policy.accept(10));
  EXPECT_FALSE(policy.is_degraded());
  policy.set_cost(20);
  EXPECT_EQ(steps_until_rebuild(policy), steps);
}

TEST(RebuildPolicy, DoesNothingWhenDisabledOrUnknown) {
  RebuildPolicy disabled(false);
  disabled.set_cost_when_built(10);
  disabled.set_cost(100);
  EXPECT_EQ(disabled.degradation(100), 10);
  EXPECT_FALSE(disabled.is_degraded());
  EXPECT_FALSE(disabled.should_measure());
  RebuildPolicy policy(true);
  policy.set_cost_when_built(10);
  policy.set_cost(0);
  EXPECT_EQ(policy.degradation(0), 1);
  EXPECT_FALSE(policy.is_degraded());
  // The tree was built when all triangles coincided.
  policy.set_cost_when_built(0);
  policy.set_cost(500);
  EXPECT_TRUE(policy.is_degraded());
}

}  // namespace supple::rebuild_policy_test
