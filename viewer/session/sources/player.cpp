#include "sources/player.hpp"

#include <algorithm>
#include <utility>

namespace supple::viewer {
namespace {

/// Limits how much time one call can add, for example after the machine slept.
constexpr double longest_pause = 0.25;

}  // namespace

void Player::play(Stage& stage) {
  if (ProgramSource* const source = stage.program(); source != nullptr && stage.past() == nullptr && !target_)
    source->program().run();
  playing_ = true;
  steps_ = 0;
  due_ = 0;
  clock_.reset();
  if (RecordingSource* const recording = stage.recording(); recording != nullptr && !target_ &&
                                                            recording->frame() == recording->last_frame() &&
                                                            !recording->is_growing())
    target_ = 0;
}

void Player::pause(Stage& stage) {
  if (ProgramSource* const source = stage.program()) source->program().pause();
  playing_ = false;
  steps_ = 0;
}

void Player::step(Stage& stage, std::int64_t count) {
  const bool is_in_past = stage.past() != nullptr || (target_ && stage.recording() == nullptr);
  if (stage.recording() != nullptr || (count > 0 && !is_in_past)) {
    if (ProgramSource* const source = stage.program())
      return source->program().step(static_cast<std::uint64_t>(count));
    playing_ = false;
    steps_ += count;
    return;
  }
  if (stage.history().count() == 0) return;
  pause(stage);
  const auto last = static_cast<std::int64_t>(stage.history().count()) - 1;
  const auto shown = stage.past() != nullptr ? static_cast<std::int64_t>(stage.past()->frame()) : last;
  const std::int64_t now = target_ ? static_cast<std::int64_t>(*target_) : shown;
  seek(static_cast<std::uint64_t>(
      std::clamp(now + count, static_cast<std::int64_t>(stage.history().first()), last)));
}

void Player::set_loop(bool on, std::optional<std::array<std::uint64_t, 2>> section) {
  loop_ = on;
  section_ = section;
}

void Player::set_speed(double factor) {
  speed_ = factor;
  due_ = 0;
}

void Player::seek(std::uint64_t frame) {
  target_ = frame;
  steps_ = 0;
  clock_.reset();
}

void Player::restart() {
  steps_ = 0;
  due_ = 0;
  clock_.reset();
  target_.reset();
}

Player::Outcome Player::advance(Stage& stage, double seconds) {
  // Clocks jump. NaN counts as no time.
  const double passed = seconds > 0 ? std::min(seconds, longest_pause) : 0;
  if (RecordingSource* const recording = stage.recording()) return advance_recording(*recording, passed);
  if (stage.past() != nullptr || target_) return advance_past(stage, passed);
  if (ProgramSource* const source = stage.program()) return advance_program(*source);
  return advance_simulation(*stage.simulation(), stage.show().simulation.time_step, passed);
}

/// The program has a clock of its own.
Player::Outcome Player::advance_program(ProgramSource& source) {
  const bool changed = source.advance();
  playing_ = source.state().runs;
  return {changed, source.is_open() && !source.state().is_held ? 0 : idle_seconds};
}

Player::Outcome Player::advance_simulation(SimulationSource& simulation, double time_step, double seconds) {
  const bool moves = (playing_ && is_watched_) || simulation.needs_steps();
  if (steps_ > 0) {
    --steps_;
    auto failure = simulation.take_step();
    return {true, steps_ > 0 ? 0 : idle_seconds, std::move(failure)};
  }
  const bool is_due = moves && take_due_step(time_step, seconds);
  const bool changed = is_due || simulation.settle();
  if (!moves) return {changed};
  std::optional<std::string> failure;
  if (is_due) failure = simulation.take_step();
  return {changed, speed_ > 0 ? std::max(time_step - due_, 0.0) / speed_ : 0, std::move(failure)};
}

/// Takes a step when it is due. Drops time that the steps cannot catch up with.
bool Player::take_due_step(double time_step, double seconds) {
  if (speed_ == 0) return true;
  due_ += seconds * speed_;
  if (due_ < time_step) return false;
  due_ = std::min(due_ - time_step, time_step);
  return true;
}

Player::Outcome Player::advance_recording(RecordingSource& recording, double seconds) {
  const bool was_playing = playing_;
  const std::uint64_t frame = due_frame(recording, seconds);
  Outcome outcome{frame != recording.frame() || was_playing != playing_};
  // Reset first, so that a frame that cannot be read is tried only once.
  target_.reset();
  if (frame != recording.frame()) recording.seek(frame);
  if (playing_ && is_watched_) outcome.wait = wait_for_frame(recording);
  return outcome;
}

/// The last kept step is the present, except in a loop.
Player::Outcome Player::advance_past(Stage& stage, double seconds) {
  RecordingSource* const past = stage.past();
  const std::uint64_t last = std::max<std::uint64_t>(stage.history().count(), 1) - 1;
  const std::uint64_t frame = past != nullptr ? due_frame(*past, seconds) : target_.value_or(last);
  target_.reset();
  if (frame == last && !(loop_ && playing_)) {
    stage.look_at_present();
    due_ = 0;
    if (playing_ && stage.program() != nullptr) stage.program()->program().run();
    return {true, 0};
  }
  Outcome outcome{past == nullptr || frame != past->frame()};
  if (outcome.changed) stage.look_back(frame);
  if (playing_ && is_watched_) outcome.wait = wait_for_frame(*stage.past());
  return outcome;
}

Player::Section Player::section_of(const RecordingSource& recording) const {
  if (!loop_ || !section_) return {0, recording.last_frame()};
  return {recording.frame_of((*section_)[0]), recording.frame_of((*section_)[1])};
}

std::uint64_t Player::due_frame(RecordingSource& recording, double seconds) {
  const std::uint64_t now = target_.value_or(recording.frame());
  const std::uint64_t last = recording.last_frame();
  if (steps_ != 0) {
    const std::int64_t wanted = static_cast<std::int64_t>(now) + std::exchange(steps_, 0);
    return static_cast<std::uint64_t>(std::clamp(wanted, std::int64_t{0}, static_cast<std::int64_t>(last)));
  }
  if (target_ || !playing_ || !is_watched_) return now;
  if (now == last && !loop_ && !recording.is_growing()) {
    playing_ = false;
    return now;
  }
  return frame_in_time(recording, seconds);
}

/// For a recording that plays and has not ended.
std::uint64_t Player::frame_in_time(RecordingSource& recording, double seconds) {
  const std::uint64_t now = recording.frame();
  const auto [first, last] = section_of(recording);
  if (speed_ == 0) return now < last ? now + 1 : loop_ ? first : now;
  clock_ = clock_.value_or(recording.time()) + seconds * speed_;
  // The last frame has the duration of the frame before it.
  const double length = last > 0 ? recording.time_of(last) - recording.time_of(last - 1) : 0;
  const double end = recording.time_of(last) + length;
  if (now >= last || (loop_ && *clock_ >= end)) {
    if (now <= last && *clock_ < end) return now;
    clock_ = recording.time_of(loop_ ? first : now);
    return loop_ ? first : now;
  }
  return std::clamp(recording.frame_at(*clock_), now, last);
}

double Player::wait_for_frame(const RecordingSource& recording) const {
  if (speed_ == 0 && !recording.is_growing()) return 0;
  const std::uint64_t now = recording.frame(), last = section_of(recording).last;
  if (now >= last) return loop_ ? 0.01 : recording.is_growing() ? idle_seconds : 0;
  if (speed_ == 0) return 0;
  const double next = recording.time_of(now + 1) - clock_.value_or(recording.time());
  return std::clamp(next / speed_, 0.0, idle_seconds);
}

}  // namespace supple::viewer
