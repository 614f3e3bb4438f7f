#include "attach/break_finder.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "supple/models.hpp"
#include "supple/scene.hpp"

namespace supple::viewer::break_finder_test {

/// Three boxes in a row, which do not touch.
class Breaks : public testing::Test {
 protected:
  Breaks() {
    for (const char* name : {"left", "middle", "right"}) {
      ObjectOptions options;
      options.name = name;
      options.solid = true;
      boxes_.push_back(scene_.add(make_box({1, 1, 1}, 2), options));
      move(boxes_.size() - 1, 2.0 * static_cast<double>(boxes_.size()));
    }
  }

  void move(std::size_t box, double x) { scene_.set_transform(boxes_[box], {.translation = {x, 0, 0}}); }
  std::optional<Break> step(const BreakOptions& breaks) {
    scene_.detect();
    return finder_.find(scene_, breaks);
  }

  Scene scene_{{.contacts = ContactKinds::penetration}};
  std::vector<ObjectId> boxes_;
  BreakFinder finder_;
};

TEST_F(Breaks, AreFoundOnlyWhenTheyAreSet) {
  move(1, 2.5);
  EXPECT_FALSE(step({}));
}

TEST_F(Breaks, ContactThatBeginsNamesThePairAndAPlace) {
  const BreakOptions breaks{.contact_begin = true};
  EXPECT_FALSE(step(breaks));
  move(1, 2.5);
  const auto found = step(breaks);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->event, "contact_begin");
  EXPECT_EQ(found->text, "left begins to touch middle");
  EXPECT_EQ(found->step, 1u);
  EXPECT_EQ(found->objects[0], boxes_[0]);
  EXPECT_EQ(found->objects[1], boxes_[1]);
  ASSERT_TRUE(found->point);
  EXPECT_GE(found->point->x, 1.9);
  EXPECT_LE(found->point->x, 2.6);
  EXPECT_FALSE(step(breaks)) << "the contact lasts";
}

TEST_F(Breaks, ContactOfNamedObjects) {
  step({});
  move(1, 2.5);
  EXPECT_FALSE(step({.contact_begin = true, .objects = {"right", ""}}));
  move(1, 5.5);
  const auto found = step({.contact_begin = true, .objects = {"right", "middle"}});
  ASSERT_TRUE(found);
  EXPECT_EQ(found->text, "middle begins to touch right");
}

TEST_F(Breaks, ContactOfOtherObjectsThanTheNamedPair) {
  step({});
  move(1, 2.5);
  EXPECT_FALSE(step({.contact_begin = true, .objects = {"left", "right"}}));
}

TEST_F(Breaks, IntersectionIsFoundWhenItBeginsAndBeginsAgain) {
  const BreakOptions breaks{.intersection = true};
  EXPECT_FALSE(step(breaks));
  move(1, 2.5);
  ASSERT_TRUE(step(breaks));
  EXPECT_FALSE(step(breaks));
  move(1, 4);
  EXPECT_FALSE(step(breaks));
  move(1, 2.5);
  const auto found = step(breaks);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->text, "left intersects middle");
}

TEST_F(Breaks, MoreContacts) {
  const BreakOptions breaks{.contacts_above = 0};
  EXPECT_FALSE(step(breaks));
  move(1, 2.5);
  const auto found = step(breaks);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->event, "contacts_above");
  EXPECT_EQ(found->text, "there are " + std::to_string(scene_.result().stats.contacts) + " contacts");
  finder_.forget();
  EXPECT_FALSE(step({.contacts_above = scene_.result().stats.contacts}));
}

TEST_F(Breaks, Depth) {
  move(1, 2.5);  // the corners are half an edge deep
  EXPECT_FALSE(step({.depth_above = 10}));
  const auto found = step({.depth_above = 1e-9});
  ASSERT_TRUE(found);
  EXPECT_EQ(found->event, "depth_above");
  EXPECT_NE(found->text.find("deep in"), std::string::npos) << found->text;
  EXPECT_TRUE(found->point);
}

TEST_F(Breaks, VertexThatIsNotFinite) {
  const BreakOptions breaks{.not_finite = true};
  EXPECT_FALSE(step(breaks));
  std::vector<Vec3d> positions = make_box({1, 1, 1}, 2).positions;
  positions[3].y = std::numeric_limits<double>::quiet_NaN();
  scene_.set_positions(boxes_[2], positions);
  const auto found = step(breaks);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->text, "vertex 3 of right is NaN or infinite");
  EXPECT_FALSE(found->point);
}

}  // namespace supple::viewer::break_finder_test
