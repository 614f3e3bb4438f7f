#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "stage.hpp"

namespace supple::viewer {

/// Whether time passes on the stage, and how fast.
class Player {
 public:
  /// How long there is nothing to do when nothing moves. Not for ever, as timers do not know that.
  static constexpr double idle_seconds = 1;

  void play(Stage& stage);
  void pause();
  /// Pauses, and goes on by so many steps, or frames, which may be less than 0.
  void step(std::int64_t count);
  void set_speed(double factor);  ///< 0: as fast as can be
  void set_loop(bool on) { loop_ = on; }
  /// To this frame, which exists.
  void seek(std::uint64_t frame);
  /// The stage was set anew.
  void restart();

  bool playing() const { return playing_; }
  double speed() const { return speed_; }
  bool loop() const { return loop_; }

  struct Outcome {
    bool changed = false;  ///< there is something new to see
    double wait = idle_seconds;
    std::optional<std::string> failure{};  ///< why a step could not be taken
  };
  /// Lets time pass: one step or frame at most. Throws `Error` when a frame cannot be read.
  Outcome advance(Stage& stage, double seconds);

 private:
  Outcome advance_simulation(SimulationSource& simulation, double time_step, double seconds);
  Outcome advance_recording(RecordingSource& recording, double seconds);
  bool take_due_step(double time_step, double seconds);
  std::uint64_t due_frame(RecordingSource& recording, double seconds);
  std::uint64_t frame_in_time(RecordingSource& recording, double seconds);
  double wait_for_frame(const RecordingSource& recording) const;

  bool playing_ = false;
  double speed_ = 1;
  bool loop_ = false;
  std::int64_t steps_ = 0;                 // that were asked for
  double due_ = 0;                         // of a simulation, seconds it is behind
  std::optional<double> clock_{};          // of a recording while it plays, its time
  std::optional<std::uint64_t> target_{};  // of a recording, the frame that was asked for
};

}  // namespace supple::viewer
