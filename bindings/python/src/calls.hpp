#pragma once

#include <nanobind/nanobind.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <mutex>
#include <optional>
#include <shared_mutex>
#include <stop_token>
#include <string>
#include <thread>
#include <utility>

#include "supple/error.hpp"

// Calls of a scene from Python: without the GIL, one at a time, and Ctrl-C stops them.

namespace supple::python {

namespace nb = nanobind;

/// Stops calls from another thread.
struct Stop {
  std::stop_source source;
};

/// The GIL is released while it lives. A thread that wants the GIL back when the interpreter has ended would
/// be terminated, so `end_calls` waits for all of them before.
class WithoutGil {
 public:
  WithoutGil() {
    if (is_ending_) throw Error("the interpreter is ending");
    ++running_;
    release_.emplace();
  }
  ~WithoutGil() {
    release_.reset();
    --running_;
  }
  WithoutGil(const WithoutGil&) = delete;

  /// Stops all calls that can be stopped, and waits for all. Python calls it at its exit.
  static void end_calls() {
    is_ending_ = true;
    ending_.request_stop();
    nb::gil_scoped_release release;
    while (running_ > 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  /// In a process made by fork, the calls of other threads do not exist.
  static void forget_calls() { running_ = 0; }
  static std::stop_token ending() { return ending_.get_token(); }

 private:
  std::optional<nb::gil_scoped_release> release_;
  static inline std::atomic<int> running_ = 0;
  static inline std::atomic<bool> is_ending_ = false;
  static inline std::stop_source ending_;
};

/// Who may call an object: calls that change it run alone. It belongs to the process that made it, because a
/// process made by fork has none of the threads of its parent.
class CallGuard {
 public:
  /// While it lives, this thread runs a function that the scene calls. That need not be the thread that
  /// called the scene: while a program waits, the viewer reads its scene.
  class Callback {
   public:
    Callback() : outer_(std::exchange(is_active_, true)) {}
    ~Callback() { is_active_ = outer_; }
    Callback(const Callback&) = delete;
    static bool is_active() { return is_active_; }

   private:
    const bool outer_;
    static inline thread_local bool is_active_ = false;
  };
  /// Waits without the GIL for other calls of the object. Throws `Error` in a process made by fork, and when
  /// a function of the user calls the object that is calling it.
  class Alone {
   public:
    explicit Alone(CallGuard& guard) : guard_(guard) {
      guard.check();
      if (!guard.mutex_.try_lock()) {
        const WithoutGil without_gil;
        guard.mutex_.lock();
      }
      guard.caller_ = std::this_thread::get_id();
    }
    ~Alone() {
      guard_.caller_ = std::thread::id();
      guard_.mutex_.unlock();
    }
    Alone(const Alone&) = delete;

   private:
    CallGuard& guard_;
  };
  /// The same for calls that change nothing, several at the same time.
  class Together {
   public:
    explicit Together(CallGuard& guard) : Together(guard, false) {}
    ~Together() {
      if (locked_) guard_.mutex_.unlock_shared();
    }
    Together(const Together&) = delete;

   protected:
    Together(CallGuard& guard, bool is_own_call) : guard_(guard), locked_(!is_own_call) {
      if (is_own_call) return;
      guard.check();
      if (!guard.mutex_.try_lock_shared()) {
        const WithoutGil without_gil;
        guard.mutex_.lock_shared();
      }
    }

   private:
    CallGuard& guard_;
    const bool locked_;
  };
  /// The same for names and counts, which functions that the object calls may read.
  class Reading : public Together {
   public:
    explicit Reading(CallGuard& guard) : Together(guard, guard.is_own_call()) {}
  };

 private:
  bool is_own_call() const { return caller_ == std::this_thread::get_id() || Callback::is_active(); }
  void check() const {
    if (getpid() != process_)
      throw Error(
          "the scene was made before fork, and its threads are not in this process; make scenes in the "
          "new process, or use multiprocessing with the start method 'spawn'");
    if (is_own_call())
      throw Error("a function that the scene calls cannot call the scene; collect what it needs before");
  }

  const pid_t process_ = getpid();
  std::shared_mutex mutex_;
  std::atomic<std::thread::id> caller_{};
};

/// While it lives on the main thread, Ctrl-C requests a stop of the call. Python's handler runs, too.
class StoppableCall {
 public:
  explicit StoppableCall(const Stop* stop)
      : stop_(stop == nullptr ? std::stop_token() : stop->source.get_token(), Request{source_}),
        ending_(WithoutGil::ending(), Request{source_}) {
    if (gettid() != getpid() || sigaction(SIGINT, nullptr, &before_) != 0) return;
    // A process that ignores Ctrl-C, such as a job in the background, ignores it here, too.
    if (before_.sa_handler == SIG_IGN || before_.sa_handler == SIG_DFL) return;
    outer_ = std::exchange(current_, this);
    struct sigaction action {};
    action.sa_handler = [](int signal) {
      // Any thread may get the signal; the calls of the main thread end there.
      if (gettid() != getpid()) {
        syscall(SYS_tgkill, getpid(), getpid(), signal);
        return;
      }
      if (current_ == nullptr) return;
      current_->interrupted_ = true;
      current_->source_.request_stop();
      current_->before_.sa_handler(signal);
    };
    is_main_ = sigaction(SIGINT, &action, &before_) == 0;
  }
  ~StoppableCall() {
    if (!is_main_) return;
    sigaction(SIGINT, &before_, nullptr);
    current_ = outer_;
  }
  StoppableCall(const StoppableCall&) = delete;

  std::stop_token token() const { return source_.get_token(); }
  bool was_interrupted() const { return interrupted_; }

 private:
  struct Request {
    std::stop_source source;
    void operator()() { source.request_stop(); }
  };
  std::stop_source source_;
  std::stop_callback<Request> stop_, ending_;
  struct sigaction before_ {};
  StoppableCall* outer_ = nullptr;
  bool is_main_ = false;
  std::atomic<bool> interrupted_ = false;
  static inline StoppableCall* current_ = nullptr;  // of the main thread
};

/// Runs `call(token)` without the GIL. Ctrl-C and `stop` stop it. When Python's handler of Ctrl-C raises
/// nothing, the call is repeated, if it can be.
template <class Call>
auto run_stoppable(const Stop* stop, const Call& call, bool can_repeat = true) {
  while (true) {
    const StoppableCall stoppable(stop);
    auto result = [&] {
      try {
        const WithoutGil without_gil;
        return call(stoppable.token());
      } catch (const Error&) {
        // Calls of several ranks end with an error when they are stopped.
        if (stoppable.was_interrupted() && PyErr_CheckSignals() != 0) throw nb::python_error();
        throw;
      }
    }();
    if (!stoppable.was_interrupted()) return result;
    if (PyErr_CheckSignals() != 0) throw nb::python_error();
    if (!can_repeat || (stop != nullptr && stop->source.stop_requested())) return result;
  }
}

/// The same for a call whose stopped answer would look like an answer: a stop is an error.
template <class Call>
auto run_or_fail(const Stop* stop, const char* name, const Call& call, bool can_repeat = true) {
  auto result = run_stoppable(stop, call, can_repeat);
  if (stop != nullptr && stop->source.stop_requested())
    throw Error(std::string(name) +
                ": it was stopped, so there is no answer; a Stop stays requested, make a new one");
  return result;
}

}  // namespace supple::python
