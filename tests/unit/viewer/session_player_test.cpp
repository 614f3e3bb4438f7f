#include <gtest/gtest.h>

#include "../../support/viewer_page.hpp"
#include "session/sources/player.hpp"

namespace supple::viewer::session_player_test {

TEST(ViewerPlayer, KeepsUpWithTimeAndGivesUpWhatItCannotCatchUpWith) {
  TestPage page(three_balls());
  page.scene();
  Session& session = page.session;
  page.frame();
  EXPECT_NEAR(session.advance(0.004), 0.006, 1e-12);
  page.ask({{"do", "layers"}});  // makes the session send a frame
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

TEST(ViewerPlayer, WaitsUntilThePageHasDrawnTheFirstFrame) {
  for (const Json& start :
       {Json{{"do", "play"}}, Json{{"do", "reset"}}, Json{{"do", "set"}, {"objects", 2}}}) {
    TestPage page(three_balls());
    Session& session = page.session;
    page.say(start);
    page.drain();
    EXPECT_EQ(session.advance(0.01), Player::idle_seconds) << start;
    page.say({{"do", "credit"}, {"frames", 2}});
    EXPECT_EQ(page.only(ViewerMessage::frame).json["step"], 0) << start;
    for (int i = 0; i < 5; ++i) session.advance(0.01);
    EXPECT_TRUE(page.drain().empty()) << "the page still draws" << start;
    page.say({{"do", "credit"}, {"frames", 1}});
    session.advance(0.01);
    const ViewerMessage frame = page.only(ViewerMessage::frame);
    EXPECT_EQ(frame.json["step"], 1) << start;
    EXPECT_EQ(frame.json["playing"], true);
  }
}

TEST(ViewerPlayer, StepsNeedNoDrawnFrame) {
  TestPage page(three_balls());
  page.scene();
  EXPECT_EQ(page.frame_after_steps(3).json["step"], 3);
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
  EXPECT_GT(count_of(frame, "contacts"), 0u);
}

}  // namespace supple::viewer::session_player_test
