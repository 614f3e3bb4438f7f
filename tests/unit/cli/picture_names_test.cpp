#include "render/picture_names.hpp"

#include <gtest/gtest.h>

#include "supple/error.hpp"

namespace supple::cli::picture_names_test {

TEST(PictureNames, HaveTheNumberOfTheFrame) {
  const PictureNames padded("a/out_%04d.png");
  EXPECT_TRUE(padded.has_number());
  EXPECT_EQ(padded.of(7), "a/out_0007.png");
  EXPECT_EQ(padded.of(123456), "a/out_123456.png");
  EXPECT_EQ(PictureNames("%d.svg").of(0), "0.svg");
  EXPECT_EQ(PictureNames("100%%_%03d.png").of(5), "100%_005.png");
  EXPECT_FALSE(PictureNames("figure.png").has_number());
  EXPECT_EQ(PictureNames("figure{}.png").of(9), "figure{}.png");
}

TEST(PictureNames, RefuseOtherUsesOfThePercentSign) {
  for (const char* pattern :
       {"%", "a%s.png", "%d%d.png", "%4d.png", "%0.png", "%004d.png", "%-4d.png", "%04"})
    EXPECT_THROW(PictureNames{pattern}, Error) << pattern;
}

}  // namespace supple::cli::picture_names_test
