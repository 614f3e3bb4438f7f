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

#include "session/message.hpp"
#include "session/session.hpp"

namespace supple::viewer {

/// Pages are numbered in the order in which they come.
using PageNumber = std::uint64_t;
/// What is sent, and the memory that it lies in.
struct Message {
  std::span<const std::byte> bytes;
  std::shared_ptr<const MessageWriter> memory;
};

/// Runs a session on a thread of its own, so that a simulation waits for no socket and a socket for no
/// simulation. Commands are taken between two steps; messages are handed over one at a time, each made when
/// the one before is on its way, so that a slow page gets the newest state and nothing queues. While no page
/// is there, time stands still.
class SessionThread {
 public:
  /// What becomes of the session; called on its thread.
  struct Listener {
    std::function<void(PageNumber, Message)> message;
    /// The commands of `command` have been carried out.
    std::function<void()> commands_taken;
    /// The session has failed for good and has handed over its last message, or something was thrown. It is
    /// the last call.
    std::function<void(std::exception_ptr)> ended;
  };

  SessionThread(Session session, Listener listener);
  /// Waits for the step under way.
  ~SessionThread();
  SessionThread(const SessionThread&) = delete;
  SessionThread& operator=(const SessionThread&) = delete;

  // From any thread, at once.
  void page_came(PageNumber page);
  void page_left(PageNumber page);
  /// Gives how many bytes of commands wait.
  std::size_t command(PageNumber page, std::string text);
  /// The last message handed over for this page is on its way, or lost.
  void message_sent(PageNumber page);

 private:
  using Clock = std::chrono::steady_clock;

  struct Inbox {
    std::optional<PageNumber> page;  ///< came since; the commands are of this page
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

  // Of the session's thread.
  Clock::time_point last_;
  Inbox taken_;
  PageNumber greeted_ = 0;
  bool ended_ = false;
  std::shared_ptr<MessageWriter> message_;

  std::mutex mutex_;
  std::condition_variable work_;
  // Guarded by the mutex.
  Inbox inbox_;
  PageNumber page_ = 0;  ///< the one that is there; 0 for none
  bool in_delivery_ = false;
  bool has_work_ = false;
  bool stopping_ = false;

  std::thread thread_;  ///< the last member: it uses all others
};

}  // namespace supple::viewer
