#include <gtest/gtest.h>

#include "../../support/viewer_page.hpp"

namespace supple::viewer {
namespace {

TEST(ViewerPlayer, KeepsUpWithTimeAndGivesUpWhatItCannotCatchUpWith) {
  TestPage page(three_balls());
  page.scene();
  Session& session = page.session;
  EXPECT_NEAR(session.advance(0.004), 0.006, 1e-12);
  EXPECT_EQ(page.frame().json["step"], 0);
  EXPECT_NEAR(session.advance(0.006), 0.01, 1e-12);
  EXPECT_EQ(page.frame().json["step"], 1);
  // Ten steps late: two steps run without delay, then the normal pace resumes.
  EXPECT_EQ(session.advance(0.1), 0);
  EXPECT_EQ(session.advance(0), 0.01);
  EXPECT_NEAR(session.advance(0), 0.01, 1e-12);
  EXPECT_EQ(page.frame().json["step"], 3);
  page.ask({{"do", "speed"}, {"factor", 0.5}});
  EXPECT_NEAR(session.advance(0), 0.02, 1e-12);
  page.ask({{"do", "speed"}, {"factor", 0}});
  EXPECT_EQ(session.advance(0), 0);
  EXPECT_EQ(session.advance(0), 0);
  EXPECT_EQ(page.frame().json["step"], 5);
  page.ask({{"do", "pause"}});
  EXPECT_GT(session.advance(0.1), 0.1);
  EXPECT_EQ(page.frame().json["playing"], false);
  EXPECT_GT(session.advance(0.1), 0.1);
  page.say({{"do", "credit"}, {"frames", 1}});
  EXPECT_TRUE(page.drain().empty());
  page.ask({{"do", "step"}, {"count", 3}});
  EXPECT_EQ(session.advance(0), 0);
  EXPECT_EQ(session.advance(0), 0);
  EXPECT_GT(session.advance(0), 0);
  EXPECT_GT(session.advance(0), 0);
  EXPECT_EQ(page.frame().json["step"], 8);
  page.ask({{"do", "step"}, {"count", 3}});
  session.advance(0);
  page.ask({{"do", "pause"}});  // cancels the remaining steps
  session.advance(0);
  EXPECT_EQ(page.frame().json["step"], 9);
}

TEST(ViewerPlayer, ObjectsWithoutMotionArePaused) {
  SceneView show;
  show.objects = {test_ball("a", {}), test_ball("b", {1.5, 0, 0})};
  TestPage page(show);
  page.scene();
  page.session.advance(1);
  const ViewerMessage frame = page.frame();
  EXPECT_EQ(frame.json["playing"], false);
  EXPECT_EQ(frame.json["step"], 0);
  EXPECT_GT(frame.section(34).count, 0u);
}

}  // namespace
}  // namespace supple::viewer
