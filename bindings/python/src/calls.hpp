#pragma once

#include <nanobind/nanobind.h>
#include <unistd.h>

#include <atomic>
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

/// Who may call an object: calls that change it run alone. It belongs to the process that made it, because a
/// process made by fork has none of the threads of its parent.
class CallGuard {
 public:
  /// Waits without the GIL for other calls of the object. Throws `Error` in a process made by fork, and when
  /// a function of the user calls the object that is calling it.
  class Alone {
   public:
    explicit Alone(CallGuard& guard) : guard_(guard) {
      guard.check();
      if (!guard.mutex_.try_lock()) {
        nb::gil_scoped_release release;
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
        nb::gil_scoped_release release;
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
    explicit Reading(CallGuard& guard) : Together(guard, guard.caller_ == std::this_thread::get_id()) {}
  };

 private:
  void check() const {
    if (getpid() != process_)
      throw Error(
          "the scene was made before fork, and its threads are not in this process; make scenes in the "
          "new process, or use multiprocessing with the start method 'spawn'");
    if (caller_ == std::this_thread::get_id())
      throw Error("a function that the scene calls cannot call the scene; collect what it needs before");
  }

  const pid_t process_ = getpid();
  std::shared_mutex mutex_;
  std::atomic<std::thread::id> caller_{};
};

/// While it lives on the main thread, Ctrl-C requests a stop of the call. Python's handler runs, too, so that
/// `check` raises what it raises, usually KeyboardInterrupt.
class StoppableCall {
 public:
  explicit StoppableCall(Stop* stop) {
    if (stop != nullptr) source_ = stop->source;
    if (gettid() != getpid()) return;
    interrupted_ = false;
    outer_ = std::exchange(current_, this);
    struct sigaction action {};
    action.sa_handler = [](int signal) {
      interrupted_ = true;
      if (current_ != nullptr) current_->source_.request_stop();
      if (current_ != nullptr && current_->before_.sa_handler != SIG_IGN &&
          current_->before_.sa_handler != SIG_DFL)
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
  /// Call it with the GIL after the call.
  void check() const {
    if (is_main_ && interrupted_ && PyErr_CheckSignals() != 0) throw nb::python_error();
  }

 private:
  std::stop_source source_;
  struct sigaction before_ {};
  StoppableCall* outer_ = nullptr;
  bool is_main_ = false;
  static inline std::atomic<bool> interrupted_ = false;
  static inline StoppableCall* current_ = nullptr;  // of the main thread
};

/// Runs `call(token)` without the GIL. Ctrl-C and `stop` stop it.
template <class Call>
auto run_stoppable(Stop* stop, const Call& call) {
  const StoppableCall stoppable(stop);
  auto result = [&] {
    nb::gil_scoped_release release;
    return call(stoppable.token());
  }();
  stoppable.check();
  return result;
}

}  // namespace supple::python
