// Pins of a recording: the session measures them in all frames, also in those that were not shown.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "supple/error.hpp"
#include "support/viewer_page.hpp"

namespace supple::viewer::session_pin_survey_test {

constexpr std::uint32_t pin_rows = 63;

/// A ball that flies through another one, by a tenth in each frame. Notes which frames are read.
class Flight : public Frames {
 public:
  explicit Flight(std::uint64_t count) : count_(count) {}

  std::uint64_t count() const override { return count_; }
  void read(std::uint64_t frame, std::size_t object, std::span<Vec3d> positions) const override {
    if (frame == broken) throw Error("frame 7 is damaged");
    if (object == 0) reads.push_back(frame);
    const std::vector<Vec3d> ball = test_ball("", {}).mesh.positions;
    const Vec3d at{object == 0 ? 0.1 * static_cast<double>(frame) - 3 : 0, 0, 0};
    for (std::size_t v = 0; v < positions.size(); ++v) positions[v] = ball[v] + at;
  }
  const Series& series() const override { return series_; }
  bool is_growing() const override { return grows; }
  bool refresh() override { return std::exchange(has_grown_, false); }
  void grow(std::uint64_t count) {
    count_ = count;
    has_grown_ = true;
  }

  mutable std::vector<std::uint64_t> reads;
  std::uint64_t broken = ~std::uint64_t{0};
  bool grows = false;

 private:
  std::uint64_t count_;
  bool has_grown_ = false;
  Series series_;
};

/// A page that shows a frame of a recording, and keeps the rows of pins by step.
class SurveyedPage {
 public:
  explicit SurveyedPage(std::uint64_t frames = 60) : flight(std::make_shared<Flight>(frames)) {
    SceneView show;
    show.objects = {test_ball("flies", {}), test_ball("rests", {})};
    show.objects[1].options.is_static = true;
    show.frames = flight;
    page.emplace(std::move(show));
    page->drain();
    give_credit();
    turn();
    flight->reads.clear();
  }

  using Rows = std::map<double, std::vector<double>>;

  void give_credit() { page->say({{"do", "credit"}, {"frames", 8}}); }
  void pin(const Json& pins) { page->say({{"do", "pins"}, {"pins", pins}}); }
  /// The session works once. Returns the seconds until it works again.
  double turn(double seconds = 0) {
    const double wait = page->session.advance(seconds);
    take();
    return wait;
  }
  void take() {
    for (const ViewerMessage& message : page->drain()) {
      if (message.kind == ViewerMessage::failure) failures.push_back(message.json["message"]);
      if (message.kind != ViewerMessage::frame) continue;
      progress.push_back(message.json["pin_frames"]);
      for (const std::uint32_t number : {1u, 2u}) {
        if (!message.has(pin_rows, number)) continue;
        const auto values = message.values<double>(pin_rows, number);
        for (std::size_t at = 0; at + 13 <= values.size(); at += 13)
          rows[number][values[at]] = {values.begin() + static_cast<std::ptrdiff_t>(at),
                                      values.begin() + static_cast<std::ptrdiff_t>(at + 13)};
      }
    }
  }
  void finish() {
    while (turn() == 0) give_credit();
  }

  std::shared_ptr<Flight> flight;
  std::optional<TestPage> page;
  std::map<std::uint32_t, Rows> rows;
  std::vector<Json> progress;
  std::vector<std::string> failures;
};

const Json both = {{{"pin", 1}, {"objects", {0, 1}}}, {{"pin", 2}, {"objects", {0}}}};

/// Rows with the same bits, except where neither has a number.
void expect_same(const SurveyedPage::Rows& some, const SurveyedPage::Rows& others) {
  ASSERT_EQ(some.size(), others.size());
  for (const auto& [step, row] : some) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      const double other = others.at(step).at(i);
      EXPECT_TRUE(row[i] == other || (row[i] != row[i] && other != other)) << step << ", value " << i;
    }
  }
}

TEST(ViewerPinSurvey, HasTheValuesOfAllFramesAsIfTheyWereShown) {
  SurveyedPage survey;
  survey.pin(both);
  survey.finish();
  EXPECT_EQ(survey.rows[1].size(), 60u);
  EXPECT_EQ(survey.progress.back(), nullptr);

  SurveyedPage shown;
  shown.page->say({{"do", "seek"}, {"frame", 58}});
  shown.turn();
  shown.pin(both);
  for (std::uint64_t frame = 0; frame < 60; ++frame) {
    shown.page->say({{"do", "seek"}, {"frame", frame}});
    shown.give_credit();
    shown.turn();  // shows it, and has no time for another
  }
  expect_same(survey.rows[1], shown.rows[1]);
  expect_same(survey.rows[2], shown.rows[2]);
  const auto touches =
      std::ranges::count_if(survey.rows[1], [](const auto& row) { return row.second[2] > 0; });
  EXPECT_GT(touches, 10) << "the balls meet";
  EXPECT_LT(touches, 50);
}

TEST(ViewerPinSurvey, ReadsOneFrameInEachTurnAndSaysHowManyItHas) {
  SurveyedPage survey;
  survey.pin(both);
  survey.turn();
  for (std::size_t turns = 2; turns <= 20; ++turns) {
    survey.give_credit();
    EXPECT_EQ(survey.turn(0.3), 0) << "there is more to do";
    EXPECT_EQ(survey.flight->reads.size(), turns);
    EXPECT_EQ(survey.progress.back(), Json({turns, 60}));
    EXPECT_EQ(survey.rows[2].size(), turns);
  }
}

TEST(ViewerPinSurvey, EndsWithItsPin) {
  SurveyedPage survey;
  survey.pin(Json::array({both[0]}));
  for (int i = 0; i < 5; ++i) survey.turn();
  survey.pin(Json::array());
  survey.give_credit();
  EXPECT_GT(survey.turn(), 0) << "nothing to do";
  EXPECT_EQ(survey.flight->reads.size(), 5u);
  EXPECT_EQ(survey.progress.back(), nullptr);
}

TEST(ViewerPinSurvey, MeasuresOnlyPinsThatLackFrames) {
  SurveyedPage survey;
  survey.pin(Json::array({both[0]}));
  survey.finish();
  survey.rows.clear();
  survey.pin(both);
  survey.finish();
  EXPECT_EQ(survey.rows[1].size(), 1u) << "the frame that is shown";
  EXPECT_EQ(survey.rows[2].size(), 60u);
}

TEST(ViewerPinSurvey, WaitsForAPageThatTakesNothing) {
  SurveyedPage survey(10'000);
  survey.pin(both);
  while (survey.turn(1) == 0) {  // uses the credit that is left
  }
  EXPECT_EQ(survey.flight->reads.size() - survey.rows[1].size(), 2048u) << "of 4096 rows, two in each turn";
  survey.give_credit();
  survey.turn();
  EXPECT_EQ(survey.rows[1].size(), survey.flight->reads.size());
  EXPECT_EQ(survey.turn(), 0) << "it goes on";
}

TEST(ViewerPinSurvey, FollowsARecordingThatGrows) {
  SurveyedPage survey(5);
  survey.flight->grows = true;
  survey.pin(both);
  survey.finish();
  EXPECT_EQ(survey.rows[2].size(), 5u);
  survey.flight->grow(9);
  survey.finish();
  EXPECT_EQ(survey.rows[2].size(), 9u);
}

TEST(ViewerPinSurvey, OtherOptionsMeasureAgain) {
  SurveyedPage survey;
  survey.pin(both);
  survey.finish();
  survey.page->say({{"do", "set"}, {"contacts", "none"}});
  survey.turn();
  survey.pin(both);
  survey.finish();
  EXPECT_EQ(survey.rows[1].size(), 60u);
  for (const auto& [step, row] : survey.rows[1]) EXPECT_EQ(row[2], 0) << "contacts in step " << step;
}

TEST(ViewerPinSurvey, SaysWhichFrameItCannotRead) {
  SurveyedPage survey;
  survey.flight->broken = 7;
  survey.pin(both);
  survey.finish();
  ASSERT_EQ(survey.failures.size(), 1u);
  EXPECT_EQ(survey.failures[0], "pins have no values of some frames: frame 7 is damaged");
  EXPECT_EQ(survey.rows[1].size(), 7u);
}

}  // namespace supple::viewer::session_pin_survey_test
