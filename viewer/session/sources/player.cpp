#include "sources/player.hpp"

#include <algorithm>
#include <utility>

namespace supple::viewer {
namespace {

/// Limits how much time one call can add, for example after the machine slept.
constexpr double longest_pause = 0.25;

std::uint64_t last_frame(const RecordingSource& recording) {
  return std::max<std::uint64_t>(recording.frame_count(), 1) - 1;
}

}  // namespace

void Player::play(Stage& stage) {
  if (ProgramSource* const source = stage.program()) source->program().run();
  playing_ = true;
  steps_ = 0;
  due_ = 0;
  clock_.reset();
  if (RecordingSource* const recording = stage.recording();
      recording != nullptr && !target_ && recording->step() == last_frame(*recording))
    target_ = 0;
}

void Player::pause(Stage& stage) {
  if (ProgramSource* const source = stage.program()) source->program().pause();
  playing_ = false;
  steps_ = 0;
}

void Player::step(Stage& stage, std::int64_t count) {
  if (ProgramSource* const source = stage.program())
    return source->program().step(static_cast<std::uint64_t>(count));
  playing_ = false;
  steps_ += count;
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
  if (ProgramSource* const source = stage.program()) return advance_program(*source);
  if (SimulationSource* const simulation = stage.simulation())
    return advance_simulation(*simulation, stage.show().simulation.time_step, passed);
  return advance_recording(*stage.recording(), passed);
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
  Outcome outcome{frame != recording.step() || was_playing != playing_};
  // Reset first, so that a frame that cannot be read is tried only once.
  target_.reset();
  if (frame != recording.step()) recording.seek(frame);
  if (playing_ && is_watched_) outcome.wait = wait_for_frame(recording);
  return outcome;
}

std::uint64_t Player::due_frame(RecordingSource& recording, double seconds) {
  const std::uint64_t now = target_.value_or(recording.step());
  const std::uint64_t last = last_frame(recording);
  if (steps_ != 0) {
    const std::int64_t wanted = static_cast<std::int64_t>(now) + std::exchange(steps_, 0);
    return static_cast<std::uint64_t>(std::clamp(wanted, std::int64_t{0}, static_cast<std::int64_t>(last)));
  }
  if (target_ || !playing_ || !is_watched_) return now;
  if (now == last && !loop_) {
    playing_ = false;
    return now;
  }
  return frame_in_time(recording, seconds);
}

/// For a recording that plays and has not ended.
std::uint64_t Player::frame_in_time(RecordingSource& recording, double seconds) {
  const std::uint64_t now = recording.step(), last = last_frame(recording);
  if (speed_ == 0) return now == last ? 0 : now + 1;
  clock_ = clock_.value_or(recording.time()) + seconds * speed_;
  // The last frame has the duration of the frame before it.
  const double length = last > 0 ? recording.time_of(last) - recording.time_of(last - 1) : 0;
  const double end = recording.time_of(last) + length;
  if (now == last || (loop_ && *clock_ >= end)) {
    if (*clock_ < end) return now;
    clock_ = recording.time_of(0);
    return 0;
  }
  return std::max(recording.frame_at(*clock_), now);
}

double Player::wait_for_frame(const RecordingSource& recording) const {
  if (speed_ == 0) return 0;
  const std::uint64_t now = recording.step();
  if (now == last_frame(recording)) return loop_ ? 0.01 : 0;
  const double next = recording.time_of(now + 1) - clock_.value_or(recording.time());
  return std::clamp(next / speed_, 0.0, idle_seconds);
}

}  // namespace supple::viewer
