#include "attach/user_fields.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "session/pins/pin_meter.hpp"
#include "session/program/program_source.hpp"
#include "supple/error.hpp"
#include "support/viewer_page.hpp"

namespace supple::viewer::user_fields_test {

constexpr std::uint32_t values_tag = 61, vectors_tag = 62;

/// A program that waits in its last step.
struct StillProgram final : Program {
  UserFields user;
  ProgramStep now;
  ProgramState status;

  void step_to(const Scene& scene) {
    now = {&scene, scene.options().contacts};
    status.last_step = scene.result().step;
    status.is_held = true;
    ++status.step_count;
  }
  void request() override {}
  const ProgramStep* enter() override { return now.scene == nullptr ? nullptr : &now; }
  void leave() override {}
  void take_frame() override {}
  void set_page(bool) override {}
  void run() override {}
  void pause() override {}
  void step(std::uint64_t) override {}
  void set_breaks(const BreakOptions&) override {}
  ProgramState state() const override { return status; }
  std::vector<StepRow> take_rows() override { return {}; }
  void set_pins(std::vector<Pin>) override {}
  std::vector<PinRow> take_pin_rows() override { return {}; }
  double time_step() const override { return 0.5; }
  std::vector<UserField> fields() const override { return user.list(); }
  std::shared_ptr<const std::vector<double>> field_values(std::string_view name,
                                                          ObjectId object) const override {
    return user.values(name, object);
  }
};

class UserFieldsTest : public testing::Test {
 protected:
  void set(ObjectId object, std::string_view name, const std::vector<double>& values, bool is_vector = false,
           std::optional<FieldElement> element = {}) {
    program_->user.set(scene_, object, name, values, is_vector, element);
  }
  std::string refusal(ObjectId object, std::string_view name, const std::vector<double>& values,
                      bool is_vector = false, std::optional<FieldElement> element = {}) {
    try {
      set(object, name, values, is_vector, element);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  }
  /// The program takes a step, and the page gets all messages.
  std::vector<ViewerMessage> take_step(TestPage& page) {
    scene_.detect();
    program_->step_to(scene_);
    page.session.advance(0);
    page.say({{"do", "credit"}, {"frames", 1}});
    return page.drain();
  }
  std::vector<std::string> labels(const ViewerMessage& scene) {
    std::vector<std::string> found;
    for (const Json& field : scene.json["fields"]) {
      if (field["key"].get<std::string>().starts_with("user:")) found.push_back(field["label"]);
    }
    return found;
  }

  Scene scene_;
  ObjectId box_ = scene_.add(make_box({1, 1, 1}, 1), {.name = "box"});  // 8 vertices, 12 triangles
  ObjectId ball_ = scene_.add(test_ball("ball", {4, 0, 0}).mesh, {.name = "ball"});
  std::shared_ptr<StillProgram> program_ = std::make_shared<StillProgram>();
};

TEST_F(UserFieldsTest, FrameHasTheValuesOfTheProgram) {
  TestPage page(view_of_program(scene_, program_, "program"));
  EXPECT_TRUE(labels(page.scene()).empty());
  std::vector<double> heat{0, 1, 2, 3, 4, 5, 6, std::numeric_limits<double>::quiet_NaN()};
  set(box_, "heat", heat);
  const std::vector<ViewerMessage> first = take_step(page);
  ASSERT_EQ(first.front().kind, ViewerMessage::scene) << "the page gets the new field";
  EXPECT_EQ(labels(first.front()), std::vector<std::string>{"heat"});
  page.say({{"do", "layers"}, {"field", "user:heat"}});
  const ViewerMessage frame = take_step(page).back();
  ASSERT_EQ(frame.kind, ViewerMessage::frame);
  const auto sent = frame.values<float>(values_tag, 0);
  ASSERT_EQ(sent.size(), 8u);
  for (std::size_t v = 0; v < 7; ++v) EXPECT_EQ(sent[v], static_cast<float>(v));
  EXPECT_TRUE(std::isnan(sent[7]));
  EXPECT_FALSE(frame.has(values_tag, 1)) << "the ball has no heat";
  heat[0] = 9;
  set(box_, "heat", heat);
  EXPECT_EQ(take_step(page).back().values<float>(values_tag, 0)[0], 9.f);
}

TEST_F(UserFieldsTest, TheCountChoosesTheElement) {
  set(box_, "of vertices", std::vector<double>(8));
  set(box_, "of triangles", std::vector<double>(12));
  set(box_, "arrows", std::vector<double>(24), true);
  const std::vector<UserField> expected{{"of vertices", FieldElement::vertex, false},
                                        {"of triangles", FieldElement::face, false},
                                        {"arrows", FieldElement::vertex, true}};
  EXPECT_EQ(program_->user.list(), expected);
  const ObjectId tetrahedron = scene_.add(TriangleMesh{
      "t", {{0, 0, 9}, {1, 0, 9}, {0, 1, 9}, {0, 0, 10}}, {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}});
  set(tetrahedron, "vertices first", std::vector<double>(4));
  EXPECT_EQ(program_->user.list().back().element, FieldElement::vertex);
  set(tetrahedron, "faces", std::vector<double>(4), false, FieldElement::face);
  EXPECT_EQ(program_->user.list().back().element, FieldElement::face);
}

TEST_F(UserFieldsTest, VectorsAreSentAsVectors) {
  std::vector<double> wind(24, 0.5);
  wind[1] = -2;
  set(box_, "wind", wind, true);
  TestPage page(view_of_program(scene_, program_, "program"));
  page.scene();
  page.say({{"do", "layers"}, {"field", "user:wind"}});
  const ViewerMessage frame = take_step(page).back();
  const auto sent = frame.values<std::array<float, 3>>(vectors_tag, 0);
  ASSERT_EQ(sent.size(), 8u);
  EXPECT_EQ(sent[0], (std::array<float, 3>{0.5f, -2, 0.5f}));
  const Json answer = page.ask({{"do", "read"}, {"object", 0}, {"vertex", 0}});
  EXPECT_EQ(answer["field"]["wind"], (Json{0.5, -2.0, 0.5}));
}

TEST_F(UserFieldsTest, WrongCountsNameTheObjectAndBothCounts) {
  EXPECT_EQ(refusal(box_, "heat", std::vector<double>(7)),
            "set_field: heat of box has 7 values, but the object has 8 vertices and 12 triangles; give one "
            "value for "
            "each");
  EXPECT_EQ(refusal(box_, "heat", std::vector<double>(8), false, FieldElement::face),
            "set_field: heat of box has 8 values, but the object has 12 triangles; give one value for each");
  EXPECT_EQ(refusal(box_, "wind", std::vector<double>(21), true),
            "set_field: wind of box has 7 values, but the object has 8 vertices and 12 triangles; give one "
            "value for "
            "each");
  EXPECT_NE(refusal(box_, "", std::vector<double>(8)), "");
  EXPECT_NE(refusal(box_, "\xff", std::vector<double>(8)), "");
  set(ball_, "heat", std::vector<double>(scene_.vertex_count(ball_)));
  EXPECT_EQ(
      refusal(box_, "heat", std::vector<double>(12)),
      "set_field: heat of box has a number for each face, but heat of ball has a number for each vertex; a "
      "field has one form, so use another name");
  EXPECT_EQ(program_->user.list().size(), 1u);
}

TEST_F(UserFieldsTest, EndsWithItsObjectsOrWithoutNumbers) {
  set(box_, "heat", std::vector<double>(8, 1));
  set(ball_, "heat", std::vector<double>(scene_.vertex_count(ball_), 2));
  TestPage page(view_of_program(scene_, program_, "program"));
  page.scene();
  page.say({{"do", "layers"}, {"field", "user:heat"}});
  EXPECT_TRUE(take_step(page).back().has(values_tag, 0));
  scene_.remove(box_);
  EXPECT_NE(refusal(box_, "heat", std::vector<double>(8)).find("the object is not in the scene"),
            std::string::npos);
  const std::vector<ViewerMessage> messages = take_step(page);
  EXPECT_EQ(messages.front().kind, ViewerMessage::scene);
  EXPECT_FALSE(messages.back().has(values_tag, 0));
  EXPECT_TRUE(messages.back().has(values_tag, 1));
  set(ball_, "heat", {});
  EXPECT_TRUE(program_->user.list().empty());
  const std::vector<ViewerMessage> last = take_step(page);
  EXPECT_TRUE(labels(last.front()).empty());
  EXPECT_FALSE(last.back().has(values_tag, 1));
}

TEST_F(UserFieldsTest, SpeedIsThatSinceTheLastStepThatThePageWasGiven) {
  TestPage page(view_of_program(scene_, program_, "program"));
  page.scene();
  page.say({{"do", "layers"}, {"field", "speed"}});
  EXPECT_FALSE(take_step(page).back().has(values_tag, 0));
  for (int i = 0; i < 2; ++i) {  // of three steps, the page sees the last one
    scene_.translate(ball_, {3, 0, 0});
    scene_.detect();
  }
  scene_.translate(ball_, {3, 0, 0});
  const ViewerMessage frame = take_step(page).back();
  EXPECT_EQ(frame.values<float>(values_tag, 0)[0], 0.f);
  EXPECT_FLOAT_EQ(frame.values<float>(values_tag, 1)[0], 6.f);  // 9 in three steps of half a second
}

}  // namespace supple::viewer::user_fields_test
