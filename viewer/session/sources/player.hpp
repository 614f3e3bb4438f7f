#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "sources/stage.hpp"

namespace supple::viewer {

/// Decides whether and how fast time passes.
class Player {
 public:
  /// How long `advance` may sleep when nothing moves. Finite, because timers need a finite number.
  static constexpr double idle_seconds = 1;

  /// From the past, a simulation or a program plays its kept steps, and then goes on.
  void play(Stage& stage);
  void pause(Stage& stage);
  /// Pauses, then goes `count` steps or frames forward, or backward when negative. A simulation or a program
  /// goes backward in its kept steps.
  void step(Stage& stage, std::int64_t count);
  void set_speed(double factor);  ///< 0: as fast as possible
  /// `section`: the first and the last step to repeat; without it, everything.
  void set_loop(bool on, std::optional<std::array<std::uint64_t, 2>> section = {});
  /// Goes to a frame of a recording or of the history, which must exist.
  void seek(std::uint64_t frame);
  /// Call after the stage has been replaced.
  void restart();
  /// While nobody watches, no time passes for what plays. Steps and seeks are still taken.
  void set_watched(bool on) { is_watched_ = on; }

  bool playing() const { return playing_; }
  double speed() const { return speed_; }
  bool loop() const { return loop_; }
  const std::optional<std::array<std::uint64_t, 2>>& section() const { return section_; }
  /// Whether a frame was requested and not yet shown.
  bool has_target() const { return target_.has_value(); }

  struct Outcome {
    bool changed = false;  ///< there is a new state to show
    double wait = idle_seconds;
    std::optional<std::string> failure{};  ///< why a step failed
  };
  /// Lets time pass; takes at most one step or frame. Throws `Error` when a frame cannot be read.
  Outcome advance(Stage& stage, double seconds);

 private:
  Outcome advance_program(ProgramSource& source);
  Outcome advance_simulation(SimulationSource& simulation, double time_step, double seconds);
  Outcome advance_recording(RecordingSource& recording, double seconds);
  Outcome advance_past(Stage& stage, double seconds);
  bool take_due_step(double time_step, double seconds);
  /// The first and the last frame that play.
  struct Section {
    std::uint64_t first = 0, last = 0;
  };
  Section section_of(const RecordingSource& recording) const;
  std::uint64_t due_frame(RecordingSource& recording, double seconds);
  std::uint64_t frame_in_time(RecordingSource& recording, double seconds);
  double wait_for_frame(const RecordingSource& recording) const;

  bool playing_ = false;
  bool is_watched_ = true;
  double speed_ = 1;
  bool loop_ = false;
  std::optional<std::array<std::uint64_t, 2>> section_{};  // that loops: its first and its last step
  std::int64_t steps_ = 0;                                 // requested and not yet taken
  double due_ = 0;                                         // simulation: seconds behind
  std::optional<double> clock_{};                          // recording or past that plays: its time
  std::optional<std::uint64_t> target_{};                  // recording or history: the requested frame
};

}  // namespace supple::viewer
