#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "session/messages/message.hpp"
#include "session/session.hpp"

namespace supple::viewer {

/// Pages are numbered in the order of connection.
using PageNumber = std::uint64_t;
/// A message and the memory that holds it.
struct Message {
  std::span<const std::byte> bytes;
  std::shared_ptr<const void> memory;
};

/// Runs a session on its own thread, so that the simulation does not wait for sockets nor sockets for the
/// simulation. It executes commands between two steps and passes on one message at a time. It makes a message
/// when the previous message has been sent. So a slow page gets the newest state, and nothing queues. Time
/// does not pass while no page is connected.
class SessionThread {
 public:
  /// Callbacks on the session thread.
  struct Listener {
    std::function<void(PageNumber, Message)> message;
    /// All commands passed to `command` have been executed.
    std::function<void()> commands_taken;
    /// The session failed permanently and its last message was handed over, or an exception was thrown. This
    /// is the last callback.
    std::function<void(std::exception_ptr)> ended;
  };

  SessionThread(Session session, Listener listener);
  /// Waits for the current step to end.
  ~SessionThread();
  SessionThread(const SessionThread&) = delete;
  SessionThread& operator=(const SessionThread&) = delete;

  // Callable from any thread; these functions do not block.
  void page_came(PageNumber page);
  void page_left(PageNumber page);
  /// Returns how many bytes of commands wait.
  std::size_t command(PageNumber page, std::string text);
  /// The session has something to do.
  void wake();
  /// The last message for this page has been sent or lost.
  void message_sent(PageNumber page);

 private:
  using Clock = std::chrono::steady_clock;

  struct Inbox {
    std::optional<PageNumber> page;  ///< connected since the last take; the commands are from this page
    bool has_left = false;           ///< the page before it, since the last take
    std::vector<std::string> commands;
    std::size_t bytes = 0;
  };

  void run();
  void run_until_stopped();
  bool wait_for_work(double seconds);
  void take_commands();
  double let_time_pass();
  void offer_message();

  Session session_;
  Listener listener_;

  // Used by the session thread only.
  Clock::time_point last_;
  Inbox taken_;
  PageNumber greeted_ = 0;
  bool ended_ = false;
  std::shared_ptr<MessageWriter> message_;

  std::mutex mutex_;
  std::condition_variable work_;
  // Guarded by the mutex.
  Inbox inbox_;
  PageNumber page_ = 0;  ///< the connected page; 0 for none
  bool in_delivery_ = false;
  bool has_work_ = false;
  bool stopping_ = false;

  std::thread thread_;  ///< last member: it uses all others
};

}  // namespace supple::viewer
