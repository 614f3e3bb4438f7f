#pragma once

#include <chrono>
#include <functional>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>

namespace supple::cli {

/// Starts the time of `--time-limit` in seconds. While the input is read, nothing can be written; half a
/// second after the limit, the program then ends with one line. `Interruption` takes over afterwards.
void start_time_limit(double seconds);

/// While this object exists, SIGINT and SIGTERM do not end the program but are remembered, so that the
/// current step can finish and files are closed. A second signal of the same kind ends the program
/// immediately.
class Interruption {
 public:
  Interruption();
  /// Also ends the work after a time in seconds, which counts from `start_time_limit`, and with `token` the
  /// call that runs then. Where a call goes on for half a second, `when_overdue` is called from another
  /// thread; it must write what there is and end the program.
  Interruption(std::optional<double> seconds, std::function<void(const Interruption&)> when_overdue);
  ~Interruption();
  Interruption(const Interruption&) = delete;
  Interruption& operator=(const Interruption&) = delete;

  /// The number of the received signal, or 0.
  int signal() const;
  /// Another process of the run has received it.
  void set_signal(int signal);
  bool is_late() const;
  bool is_requested() const { return signal() != 0 || is_late(); }
  std::stop_token token() const { return source_.get_token(); }
  /// While the result is held, `when_overdue` is not called. Hold it while writing.
  [[nodiscard]] std::unique_lock<std::mutex> hold() { return std::unique_lock(writing_); }
  /// From now on, `when_overdue` is not called. Call it before the output is completed.
  void end();

 private:
  using Clock = std::chrono::steady_clock;

  void watch(const std::stop_token& ended, const std::function<void(const Interruption&)>& when_overdue);

  std::optional<Clock::time_point> deadline_;
  std::stop_source source_;
  std::mutex writing_;
  std::jthread watcher_;  ///< the last member: it uses the others until it ends
};

/// Reports in one line that a run has ended early, and returns the exit status: that of a signal, or
/// `status`. `place` is how far it came, such as `3 of 10 frames`.
int report_end(const Interruption& interruption, std::optional<double> seconds, const std::string& place,
               int status);

/// Ends the program from another thread, with all that was written to standard output.
[[noreturn]] void exit_now(int status);

}  // namespace supple::cli
