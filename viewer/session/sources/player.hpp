#pragma once

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

  void play(Stage& stage);
  void pause(Stage& stage);
  /// Pauses, then goes `count` steps or frames forward, or backward when negative.
  void step(Stage& stage, std::int64_t count);
  void set_speed(double factor);  ///< 0: as fast as possible
  void set_loop(bool on) { loop_ = on; }
  /// Goes to a frame, which must exist.
  void seek(std::uint64_t frame);
  /// Call after the stage has been replaced.
  void restart();
  /// While nobody watches, no time passes for what plays. Steps and seeks are still taken.
  void set_watched(bool on) { is_watched_ = on; }

  bool playing() const { return playing_; }
  double speed() const { return speed_; }
  bool loop() const { return loop_; }

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
  bool take_due_step(double time_step, double seconds);
  std::uint64_t due_frame(RecordingSource& recording, double seconds);
  std::uint64_t frame_in_time(RecordingSource& recording, double seconds);
  double wait_for_frame(const RecordingSource& recording) const;

  bool playing_ = false;
  bool is_watched_ = true;
  double speed_ = 1;
  bool loop_ = false;
  std::int64_t steps_ = 0;                 // requested and not yet taken
  double due_ = 0;                         // simulation: seconds behind
  std::optional<double> clock_{};          // recording that plays: its time
  std::optional<std::uint64_t> target_{};  // recording: the requested frame
};

}  // namespace supple::viewer
