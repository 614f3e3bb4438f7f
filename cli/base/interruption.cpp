#include "base/interruption.hpp"

#include <fmt/core.h>
#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <condition_variable>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <system_error>
#include <utility>

#include "base/run_program.hpp"

namespace supple::cli {
namespace {

// Atomics without locks are safe in signal handlers.
std::atomic<int> received = 0;
static_assert(std::atomic<int>::is_always_lock_free);

extern "C" void remember(int signal) {
  received = signal;
}

using Clock = std::chrono::steady_clock;
std::optional<Clock::time_point> time_limit_start;
std::string message_of_limit;  // complete before the signal

extern "C" void end_while_reading(int) {
  [[maybe_unused]] const ssize_t written =
      write(STDERR_FILENO, message_of_limit.data(), message_of_limit.size());
  std::_Exit(exit_unusable);
}

void set_alarm(double seconds) {
  itimerval timer{};
  timer.it_value.tv_sec = static_cast<time_t>(seconds);
  timer.it_value.tv_usec = static_cast<suseconds_t>((seconds - std::floor(seconds)) * 999999);
  setitimer(ITIMER_REAL, &timer, nullptr);
}

constexpr double most_seconds = 1e9;

}  // namespace

void start_time_limit(double seconds) {
  constexpr double grace = 0.5;
  time_limit_start = Clock::now();
  message_of_limit = fmt::format(
      "supple: the time limit of {} s ended the run while its input was read; nothing was tested\n", seconds);
  std::signal(SIGALRM, end_while_reading);
  set_alarm(std::min(seconds, most_seconds) + grace);
}

Interruption::Interruption() {
  received = 0;
  struct sigaction action {};
  action.sa_handler = remember;
  sigemptyset(&action.sa_mask);
  action.sa_flags = static_cast<int>(SA_RESETHAND | static_cast<unsigned>(SA_RESTART));
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

Interruption::Interruption(std::optional<double> seconds,
                           std::function<void(const Interruption&)> when_overdue)
    : Interruption() {
  set_alarm(0);
  if (seconds) {
    const std::chrono::duration<double> limit(std::min(*seconds, most_seconds));
    deadline_ = time_limit_start.value_or(Clock::now()) + std::chrono::duration_cast<Clock::duration>(limit);
  }
  try {
    watcher_ = std::jthread(
        [this, overdue = std::move(when_overdue)](const std::stop_token& ended) { watch(ended, overdue); });
  } catch (const std::system_error&) {  // no thread is left: the program looks between two steps
  }
}

Interruption::~Interruption() {
  std::signal(SIGINT, SIG_DFL);
  std::signal(SIGTERM, SIG_DFL);
}

void Interruption::end() {
  const auto lock = hold();
  watcher_.request_stop();
}

int Interruption::signal() const {
  return received;
}

void Interruption::set_signal(int signal) {
  received = signal;
}

bool Interruption::is_late() const {
  return deadline_ && Clock::now() >= *deadline_;
}

void Interruption::watch(const std::stop_token& ended,
                         const std::function<void(const Interruption&)>& when_overdue) {
  // A signal handler cannot wake a thread by the means of C++, so the thread looks for signals.
  constexpr auto interval = std::chrono::milliseconds(20), grace = std::chrono::milliseconds(500);
  std::mutex mutex;
  std::unique_lock sleep(mutex);
  std::condition_variable_any end;
  while (!end.wait_for(sleep, ended, interval, [this] { return is_requested(); })) {
    if (ended.stop_requested()) return;
  }
  source_.request_stop();
  end.wait_for(sleep, ended, grace, [] { return false; });
  const auto lock = hold();
  if (!ended.stop_requested()) when_overdue(*this);
}

int report_end(const Interruption& interruption, std::optional<double> seconds, const std::string& place,
               int status) {
  const int signal = interruption.signal();
  const std::string cause =
      signal != 0 ? "interrupted" : fmt::format("the time limit of {} s ended the run", seconds.value_or(0));
  fmt::print(stderr, "supple: {} after {}\n", cause, place);
  return signal != 0 ? exit_interrupted + signal : status;
}

void exit_now(int status) {
  std::fflush(nullptr);
  std::_Exit(status);
}

}  // namespace supple::cli
