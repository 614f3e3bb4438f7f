#include <gtest/gtest.h>

#include "supple/comparison.hpp"
#include "supple/use_manifolds.hpp"

/// Runs the chosen tests. Returns 77, which CTest reports as skipped, when one was skipped and none failed.
int main(int count, char** arguments) {
  supple::use_comparison_methods();
  supple::use_manifolds();
  ::testing::InitGoogleTest(&count, arguments);
  const int status = RUN_ALL_TESTS();
  return status == 0 && ::testing::UnitTest::GetInstance()->skipped_test_count() > 0 ? 77 : status;
}
