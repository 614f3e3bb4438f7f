#include "octree/volumes/moving_boxes.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "support/instruction_sets.hpp"
#include "support/moving_objects.hpp"

namespace supple::moving_boxes_test {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double inf = std::numeric_limits<double>::infinity();

TEST(MovingBoxes, OfNothing) {
  for (const bool floats : {true, false}) {
    const MovingObject object({}, {}, {}, floats);
    EXPECT_EQ(object.validate(), "");
    EXPECT_TRUE(object.boxes.swept_box().empty());
  }
}

TEST(MovingBoxes, EncloseEveryElement) {
  for (const bool floats : {true, false}) {
    for (const std::uint32_t leaf_size : {1u, 5u, 20u, 1000u}) {
      for (const std::uint32_t count : {1u, 3u, 40u, 3000u}) {
        const TriangleMesh soup = random_soup(count, 1, 0.1, count);
        EXPECT_EQ(MovingObject(soup, displaced(soup, 0.2, 7), {.leaf_size = leaf_size}, floats).validate(),
                  "");
        EXPECT_EQ(MovingObject(soup, {}, {.leaf_size = leaf_size}, floats).validate(), "");
      }
      const TriangleMesh sheet = crumpled_sheet(40, 30, 0.02, 9);
      EXPECT_EQ(MovingObject(sheet, displaced(sheet, 0.2, 7), {.leaf_size = leaf_size}, floats, 3).validate(),
                "");
    }
  }
}

TEST(MovingBoxes, OfTheObject) {
  const TriangleMesh mesh{"", {{0, 1, 2}, {3, -1, 0}, {1, 1, 1}, {9, 9, 9}}, {{0, 1, 2}}};
  const MovingObject object(mesh, {{10, 1, 2}, {11, 0, 0}, {12, 1, 1}, {90, 0, 0}});
  EXPECT_EQ(object.boxes.start_box(), (Aabb{{0, -1, 0}, {3, 1, 2}}));
  EXPECT_EQ(object.boxes.end_box(), (Aabb{{10, 0, 0}, {12, 1, 2}}));
  EXPECT_EQ(object.boxes.swept_box(), (Aabb{{0, -1, 0}, {12, 1, 2}}));
  EXPECT_FALSE(object.boxes.at_rest());
}

TEST(MovingBoxes, InertElementsHaveNone) {
  for (const bool floats : {true, false}) {
    for (const double bad : {nan, inf, -inf}) {
      for (const bool at_end : {false, true}) {
        TriangleMesh sheet = crumpled_sheet(12, 9, 0.02, 9);
        std::vector<Vec3d> end = displaced(sheet, 0.2, 7);
        for (const std::uint32_t vertex : {0u, 17u, 60u}) (at_end ? end : sheet.positions)[vertex].y = bad;
        const MovingObject object(sheet, end, {.leaf_size = 3}, floats);
        EXPECT_EQ(object.validate(), "");
        EXPECT_FALSE(object.boxes.swept_box().empty());
      }
    }
  }
  const TriangleMesh lost{"", {{nan, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {{0, 1, 2}}};
  const MovingObject object(lost, {});
  EXPECT_EQ(object.validate(), "");
  // The two other vertices and their edge remain active.
  EXPECT_EQ(object.boxes.start_box(), (Aabb{{1, 0, 0}, {2, 0, 0}}));
}

TEST(MovingBoxes, RecoverWhenAllIsFiniteAgain) {
  TriangleMesh sheet = crumpled_sheet(12, 9, 0.02, 9);
  const std::vector<Vec3d> good = sheet.positions;
  sheet.positions[5].x = nan;
  MovingObject object(sheet, {});
  const Parallel parallel(1);
  object.assign(object.start, good, false, parallel);
  object.boxes.refit(object.octree, object.elements, object.start, object.start, parallel);
  EXPECT_EQ(object.validate(), "");
}

TEST(MovingBoxes, StayWithinTheRangeOfFloat) {
  const double huge = 1e300;
  const TriangleMesh mesh{
      "", {{huge, -huge, 0}, {1, 0, 0}, {2, 0, 1e-320}, {huge, huge, huge}}, {{0, 1, 2}, {3, 3, 3}}};
  const MovingObject object(mesh, {}, {.leaf_size = 1}, false);
  EXPECT_EQ(object.validate(), "");
  constexpr float most = std::numeric_limits<float>::max();
  EXPECT_EQ(object.boxes.start_box().max, (Vec3f{most, most, most}));
  EXPECT_EQ(object.boxes.start_box().min.y, -most);
}

TEST(MovingBoxes, FindTheSameOnEveryInstructionSet) {
  const TriangleMesh sheet = crumpled_sheet(30, 21, 0.02, 9);
  for_each_target([&](const char* name) {
    for (const bool floats : {true, false}) {
      EXPECT_EQ(MovingObject(sheet, displaced(sheet, 0.3, 4), {}, floats).validate(), "") << name;
    }
  });
}

TEST(MovingBoxes, ValidationFindsBoxesOfOtherPositions) {
  const TriangleMesh sheet = crumpled_sheet(12, 9, 0.02, 9);
  MovingObject object(sheet, displaced(sheet, 0.3, 4));
  EXPECT_EQ(object.validate(), "");
  object.assign(object.end, sheet.positions, false, Parallel(1));
  EXPECT_NE(object.validate(), "");
}

}  // namespace supple::moving_boxes_test
