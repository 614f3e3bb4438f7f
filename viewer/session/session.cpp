#include "session.hpp"

#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "failure.hpp"
#include "session_implementation.hpp"
#include "supple/comparison.hpp"
#include "supple/use_manifolds.hpp"

namespace supple::viewer {
namespace {

/// How often the page gets the rows of pins of frames that are not shown.
constexpr double survey_interval = 0.25;
/// Rows of pins that wait for a page that takes no frames.
constexpr std::size_t most_survey_rows = 4096;

}  // namespace

void Session::Implementation::greet() {
  is_greeted_ = true;
  owes_scene_ = true;
  has_news_ = true;
  packer_.forget();
  pins_.set({});
  survey_.clear();
  credit_ = 0;
  replies_.clear();
  layers_ = {};
  field_.choose(nullptr);
  deferred_.clear();
  if (SimulationSource* const simulation = stage_->simulation()) simulation->release();
  if (ProgramSource* const source = stage_->program()) {
    source->program().set_pins({});
    source->program().set_page(true);
  }
}

void Session::Implementation::leave() {
  ProgramSource* const source = stage_->program();
  if (source == nullptr) return;
  look_at_present();
  source->leave();
  source->program().set_page(false);
}

double Session::Implementation::advance(double seconds) {
  if (!is_greeted_ || has_ended_) return Player::idle_seconds;
  Player::Outcome outcome;
  auto failure = failure_of([&] {
    if (RecordingSource* const recording = stage_->recording(); recording && recording->refresh())
      owes_series_ = has_news_ = true;
    outcome = player_.advance(*stage_, seconds);
    if (outcome.changed) take_state();
    if (stage_->program() != nullptr) follow_program();
  });
  if (outcome.failure) failure = Failure{*outcome.failure};
  if (failure) {
    replies_.id.reset();
    player_.pause(*stage_);
    has_news_ = true;
    if (SimulationSource* const simulation = stage_->simulation(); simulation && !failure->out_of_memory)
      simulation->release();
    fail(failure->message, failure->out_of_memory);
    return 0;
  }
  has_news_ = has_news_ || outcome.changed;
  const bool is_free = !outcome.changed && outcome.wait > 0;
  return is_free && survey_pins(seconds) ? 0 : outcome.wait;
}

/// While a recording is not read for the page, measures the pins in one of its other frames. Returns false
/// when there is nothing to do.
bool Session::Implementation::survey_pins(double seconds) {
  const RecordingSource* const recording = stage_->recording();
  if (recording == nullptr || !survey_.progress(*recording)) return false;
  survey_seconds_ += seconds;
  const bool is_full = pins_.size() >= most_survey_rows;
  if (!is_full) {
    if (const auto failure = failure_of([&] { survey_.measure_next(scene(), *recording, pins_); })) {
      survey_.stop();
      replies_.id.reset();
      fail("pins have no values of some frames: " + failure->message);
    }
  }
  if (is_full || survey_seconds_ >= survey_interval || !survey_.progress(*recording)) {
    survey_seconds_ = 0;
    has_news_ = true;
  }
  return !is_full;
}

/// Takes what a step, or a way to or from the past, has changed.
void Session::Implementation::take_state() {
  const bool is_past = stage_->past() != nullptr;
  if (is_past != is_past_) packer_.forget_positions();
  if (is_past_ && !is_past && std::exchange(has_other_options_, false)) {
    settings_ = {};  // a program has the options that it chose itself
    owes_scene_ = true;
  }
  is_past_ = is_past;
  if (is_past || stage_->simulation() == nullptr) return;
  const Source& source = stage_->source();
  packer_.add_step(source.step(), source.motion_seconds(), source.scene().result());
  pins_.measure(source.scene(), source.step(), source.time());
  stage_->keep();
}

void Session::Implementation::look_at_present() {
  if (stage_->past() == nullptr) return;
  stage_->look_at_present();
  take_state();
}

std::span<const std::byte> Session::Implementation::next_message(MessageWriter& message) {
  if (!is_greeted_) return {};
  if (owes_scene_) {
    owes_scene_ = false;
    owes_series_ = stage_->recording() != nullptr;
    has_news_ = true;
    has_sent_frame_ = false;
    player_.set_watched(false);
    packer_.forget_positions();
    ++numbers_.generation;
    fields_ = offered_fields(scene());
    field_.choose(find_field(fields_, layers_.field));
    pack_scene(*stage_, numbers_, fields_, replies_.json, message);
  } else if (owes_series_) {
    owes_series_ = false;
    pack_series(*scene().frames, message);
  } else if (!replies_.empty()) {
    replies_.take_first(message);
  } else if (!stage_->is_open()) {
    if (credit_ > 0 || !deferred_.empty()) stage_->program()->program().request();
    return {};
  } else if (has_news_ && credit_ > 0 && !has_ended_) {
    has_news_ = false;
    if (!pack_frame(message)) return next_message(message);
    has_sent_frame_ = true;
    if (ProgramSource* const source = stage_->program(); source != nullptr && !is_past_)
      source->program().take_frame();
    --credit_;
  } else {
    return {};
  }
  return message.finish();
}

/// Measures the pins in the step of the frame; a program has measured the present itself. A recording and the
/// past can be at any step, so they read where objects were in the step before.
void Session::Implementation::measure_pins() {
  const RecordingSource* const recording = is_past_ ? stage_->past() : stage_->recording();
  if (stage_->program() != nullptr && recording == nullptr) return;
  const Source& source = stage_->source();
  PinMeter::Earlier earlier;
  if (recording != nullptr) {
    earlier = [this, recording](ObjectId object) -> std::optional<PinMeter::Place> {
      if (!recording->has_path()) return std::nullopt;
      const std::uint64_t before = recording->frame() - 1;
      std::vector<Vec3d> positions(recording->positions(object.index).begin(),
                                   recording->positions(object.index).end());
      const bool moves = !scene().objects[object.index].options.is_static;
      if (moves && failure_of([&] { scene().frames->read(before, object.index, positions); }))
        return std::nullopt;
      const auto center = center_of(positions);
      if (!center) return std::nullopt;
      return PinMeter::Place{scene().frames->step(before), recording->time_of(before), *center};
    };
  }
  pins_.measure(source.scene(), source.step(), source.time(), earlier);
}

/// Returns false on failure, and then drops the optional layers.
bool Session::Implementation::pack_frame(MessageWriter& message) {
  FrameView frame{scene(),           stage_->source(), layers_,        stage_->center(),  numbers_.generation,
                  player_.playing(), player_.speed(),  player_.loop(), player_.section(), stage_->range(),
                  is_past_};
  frame.has_path = !is_past_ || stage_->past()->has_path();
  frame.is_recorded = stage_->recording() != nullptr;
  if (frame.is_recorded) frame.pin_frames = survey_.progress(*stage_->recording());
  const auto failure = failure_of([&] {
    packer_.pack(frame, message);
    field_.pack(*stage_, message);
    measure_pins();
    pins_.add_to(message);
  });
  if (!failure) return true;
  replies_.id.reset();
  packer_.forget();
  const std::vector<std::string> dropped = layer_names(layers_);
  layers_ = {};
  field_.choose(nullptr);
  has_news_ = true;
  fail(failure->message, dropped.empty(), dropped);
  return false;
}

// Replies.

/// `layers` are the layers that frames no longer contain.
void Session::Implementation::fail(const std::string& message, bool fatal,
                                   std::span<const std::string> layers) {
  has_ended_ = fatal;
  replies_.add_failure(message, fatal, layers);
}

Session::Session(SceneView show, MemoryBudget budget)
    : implementation_((use_comparison_methods(), use_manifolds(),
                       std::make_unique<Implementation>(std::move(show), budget))) {}
Session::~Session() = default;
Session::Session(Session&&) noexcept = default;
Session& Session::operator=(Session&&) noexcept = default;

void Session::greet() {
  implementation_->greet();
}
void Session::command(std::string_view json) {
  implementation_->command(json);
}
void Session::leave() {
  implementation_->leave();
}
double Session::advance(double seconds) {
  return implementation_->advance(seconds);
}
std::span<const std::byte> Session::next_message(MessageWriter& message) {
  return implementation_->next_message(message);
}
bool Session::ended() const {
  return implementation_->ended();
}

}  // namespace supple::viewer
