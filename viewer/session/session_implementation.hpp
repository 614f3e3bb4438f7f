#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "arguments.hpp"
#include "fields/field_maker.hpp"
#include "layers.hpp"
#include "messages/frame_message.hpp"
#include "messages/json_value.hpp"
#include "messages/message.hpp"
#include "messages/scene_message.hpp"
#include "pins/pin_rows.hpp"
#include "pins/pin_survey.hpp"
#include "replies.hpp"
#include "session.hpp"
#include "settings.hpp"
#include "sources/player.hpp"
#include "sources/stage.hpp"

namespace supple::viewer {

/// The state of a session. Its commands are in `session_commands.cpp`.
class Session::Implementation {
 public:
  Implementation(SceneView show, MemoryBudget budget)
      : show_(std::move(show)),
        most_memory_(estimated_memory(show_, settings_) + budget.bytes),
        history_bytes_(budget.history_bytes),
        stage_(make_stage(settings_)) {
    take_state();
    if (stage_->simulation() != nullptr && stage_->has_motion()) player_.play(*stage_);
    if (RecordingSource* const recording = stage_->recording(); recording && recording->is_growing()) {
      player_.seek(recording->last_frame());
      player_.play(*stage_);
    }
  }

  void greet();
  void leave();
  void command(std::string_view json);
  double advance(double seconds);
  std::span<const std::byte> next_message(MessageWriter& message);
  bool ended() const { return has_ended_; }

 private:
  using Handler = void (Implementation::*)(Arguments&);
  struct Command {
    const char* name;
    Handler handle;
    bool has_answer = false;  // the command has an answer, so it needs an id
  };
  static const Command commands_[];

  void obey(const JsonValue& command);
  void run(const Command& command, const JsonValue& text);
  void catch_up();

  void credit(Arguments& arguments);
  void play(Arguments& arguments);
  void pause(Arguments& arguments);
  void step(Arguments& arguments);
  void speed(Arguments& arguments);
  void loop(Arguments& arguments);
  void seek(Arguments& arguments);
  void layers(Arguments& arguments);
  void reset(Arguments& arguments);
  void set(Arguments& arguments);
  void grab(Arguments& arguments);
  void drag(Arguments& arguments);
  void release(Arguments& arguments);
  void explain(Arguments& arguments);
  void measure(Arguments& arguments);
  void read(Arguments& arguments);
  void node_pairs(Arguments& arguments);
  void set_breaks(Arguments& arguments);
  void pins(Arguments& arguments);
  void program(Arguments& arguments);

  const SceneView& scene() const { return stage_->show(); }
  std::unique_ptr<Stage> make_stage(const Settings& settings, std::uint64_t frame = 0) const {
    return std::make_unique<Stage>(show_, settings, history_bytes_, frame);
  }
  void replace_stage(std::unique_ptr<Stage> stage);
  void take_state();
  void look_at_present();
  void restart(const Settings& settings);
  void change(const Settings& settings);
  void follow_program();
  bool has_frames(Arguments& arguments) const;
  bool is_of_simulation(Arguments& arguments) const;
  bool is_of_program(Arguments& arguments) const;

  void fail(const std::string& message, bool fatal = false, std::span<const std::string> layers = {});
  bool pack_frame(MessageWriter& message);
  void measure_pins();
  bool survey_pins(double seconds);

  SceneView show_;
  Settings settings_;
  double most_memory_, history_bytes_;
  std::unique_ptr<Stage> stage_;
  Player player_;
  Layers layers_;

  bool is_greeted_ = false;
  bool has_ended_ = false;
  SceneNumbers numbers_;
  bool owes_scene_ = false, owes_series_ = false, has_news_ = false;
  bool has_sent_frame_ = false;     // of this scene message
  bool is_past_ = false;            // what the page has is of the past
  bool has_other_options_ = false;  // the past of a program, than the program
  std::int64_t credit_ = 0;
  Replies replies_;
  std::vector<JsonValue> deferred_;  // commands that wait until the scene of the program can be read
  FramePacker packer_;
  std::vector<FieldForm> fields_;  // that the last scene message offered
  FieldMaker field_;
  PinRows pins_;
  PinSurvey survey_;           // of a recording
  double survey_seconds_ = 0;  // since its rows were sent
};

}  // namespace supple::viewer
