#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <string_view>
#include <vector>

#include "break_finder.hpp"
#include "session/pins/pin_meter.hpp"
#include "session/program/program.hpp"
#include "slowdown_budget.hpp"
#include "supple/call_limits.hpp"
#include "supple/viewer.hpp"
#include "user_fields.hpp"

namespace supple::viewer {

/// Where a program and its session meet: the program passes the gate at the end of each step. It waits there
/// while the session reads the scene, and while it is paused.
class Gate final : public Program {
 public:
  struct Surroundings {
    std::function<double()> seconds;  ///< the time of a clock that never goes back
    /// The session has something to do. Called by the thread of the program.
    std::function<void()> wake;
    /// A program that is not paused goes on when the session is busy for longer.
    std::chrono::milliseconds patience{20};
  };
  Gate(const AttachOptions& options, Surroundings surroundings);

  /// The observer of the scene.
  void pass(const Scene& scene, const DetectRequest& request);
  /// Pauses the program after its last step, also without a page, until the page continues it.
  void wait(const Scene& scene, const CallLimits& limits);
  /// The program never waits again.
  void close();

  std::uint64_t frame_count() const;
  double seconds_in_steps() const;
  UserFields& user_fields() { return fields_; }

  void request() override;
  const ProgramStep* enter() override;
  void leave() override;
  void take_frame() override;
  void set_page(bool is_connected) override;
  void run() override;
  void pause() override;
  void step(std::uint64_t count) override;
  void set_breaks(const BreakOptions& breaks) override;
  std::vector<StepRow> take_rows() override;
  void set_pins(std::vector<Pin> pins) override;
  std::vector<PinRow> take_pin_rows() override;
  ProgramState state() const override;
  double time_step() const override { return time_step_; }
  std::vector<UserField> fields() const override { return fields_.list(); }
  std::shared_ptr<const std::vector<double>> field_values(std::string_view name,
                                                          ObjectId object) const override {
    return fields_.values(name, object);
  }

 private:
  using Lock = std::unique_lock<std::mutex>;
  bool is_halted() const;
  void remember(const Scene& scene);
  void show(Lock& lock);
  template <class Limits>
  void hold(Lock& lock, const Limits& limits);

  const double time_step_;
  const bool waits_for_page_;
  const Surroundings surroundings_;
  UserFields fields_;

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  // Guarded by the mutex.
  SlowdownBudget budget_;
  BreakFinder finder_;
  ProgramState state_;
  ProgramStep step_;
  PinMeter pins_;
  std::vector<StepRow> rows_;  // that the session has not taken
  std::vector<PinRow> pin_rows_;
  double passed_at_ = 0;
  double shown_at_ = 0;      // the last step that waited for a frame, or before all when a page came
  std::uint64_t steps_ = 0;  // to take before the pause
  std::uint64_t frame_count_ = 0;
  double seconds_in_steps_ = 0;
  bool is_requested_ = false;
  bool is_waiting_ = false;  // the program, so that the session may enter
  bool is_inside_ = false;   // the session
  bool is_at_end_ = false;   // the program is in `wait`
  bool has_page_ = false;
  bool is_closed_ = false;
};

}  // namespace supple::viewer
