#include "attach/slowdown_budget.hpp"

#include <gtest/gtest.h>

namespace supple::viewer::slowdown_budget_test {

TEST(SlowdownBudget, FirstFrameIsAtOnceAndTheNextWhenItIsEarned) {
  SlowdownBudget budget(0.25, 10);
  EXPECT_TRUE(budget.affords(10));
  budget.spend(10, 10.5);
  EXPECT_FALSE(budget.affords(10.5));
  EXPECT_FALSE(budget.affords(12.4));
  EXPECT_TRUE(budget.affords(12.5));  // 0.5 s are a quarter of 2 s
}

TEST(SlowdownBudget, FramesTakeTheirShareInTheLongRun) {
  SlowdownBudget budget(0.125, 0);
  double now = 0, spent = 0;
  int frames = 0;
  while (now < 1000) {
    now += 0.25;
    if (!budget.affords(now)) continue;
    budget.spend(now, now + 0.5);
    now += 0.5;
    spent += 0.5;
    ++frames;
  }
  EXPECT_GT(frames, 200);
  EXPECT_LE(spent, 0.125 * now + 0.5);
  EXPECT_GE(spent, 0.1 * now);
}

TEST(SlowdownBudget, SavingsAreLimited) {
  SlowdownBudget budget(0.5, 0);
  EXPECT_TRUE(budget.affords(1000));
  budget.spend(1000, 1001);  // half a second was saved
  EXPECT_FALSE(budget.affords(1001.5));
  EXPECT_TRUE(budget.affords(1002));
}

TEST(SlowdownBudget, PausesDoNotCount) {
  SlowdownBudget budget(0.5, 0);
  budget.spend(0, 1);
  budget.skip(1, 100);
  EXPECT_FALSE(budget.affords(101));
  EXPECT_TRUE(budget.affords(102));
}

TEST(SlowdownBudget, WithoutAShareOnlyTheFirstFrameIsShown) {
  SlowdownBudget budget(0, 0);
  EXPECT_TRUE(budget.affords(1));
  budget.spend(1, 1.001);
  EXPECT_FALSE(budget.affords(1e6));
}

}  // namespace supple::viewer::slowdown_budget_test
