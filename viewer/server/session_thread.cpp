#include "session_thread.hpp"

#include <algorithm>
#include <limits>
#include <span>
#include <utility>

namespace supple::viewer {
namespace {

constexpr double for_ever = std::numeric_limits<double>::infinity();

}  // namespace

SessionThread::SessionThread(Session session, Listener listener)
    : session_(std::move(session)), listener_(std::move(listener)), thread_([this] { run(); }) {}

SessionThread::~SessionThread() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  work_.notify_one();
  thread_.join();
}

void SessionThread::page_came(PageNumber page) {
  {
    const std::lock_guard lock(mutex_);
    inbox_.page = page;
    inbox_.commands.clear();
    inbox_.bytes = 0;
    page_ = page;
    in_delivery_ = false;
    has_work_ = true;
  }
  work_.notify_one();
}

void SessionThread::page_left(PageNumber page) {
  {
    const std::lock_guard lock(mutex_);
    if (page_ != page) return;
    page_ = 0;
    inbox_.has_left = true;
    has_work_ = true;
  }
  work_.notify_one();
}

void SessionThread::wake() {
  {
    const std::lock_guard lock(mutex_);
    has_work_ = true;
  }
  work_.notify_one();
}

std::size_t SessionThread::command(PageNumber page, std::string text) {
  std::size_t waiting = 0;
  {
    const std::lock_guard lock(mutex_);
    if (page_ != page) return 0;
    inbox_.bytes += text.size();
    inbox_.commands.push_back(std::move(text));
    waiting = inbox_.bytes;
    has_work_ = true;
  }
  work_.notify_one();
  return waiting;
}

void SessionThread::message_sent(PageNumber page) {
  {
    const std::lock_guard lock(mutex_);
    if (page_ != page) return;
    in_delivery_ = false;
    has_work_ = true;
  }
  work_.notify_one();
}

void SessionThread::run() {
  try {
    run_until_stopped();
  } catch (...) {
    listener_.ended(std::current_exception());
  }
}

void SessionThread::run_until_stopped() {
  double idle_seconds = for_ever;
  while (!ended_ && wait_for_work(idle_seconds)) {
    take_commands();
    idle_seconds = let_time_pass();
    offer_message();
  }
  if (ended_) listener_.ended(nullptr);
}

/// Moves new input to `taken_`. Returns false when the thread must end.
bool SessionThread::wait_for_work(double seconds) {
  std::unique_lock lock(mutex_);
  const auto is_awake = [this] { return has_work_ || stopping_; };
  // Longer times would overflow the clock.
  if (seconds > 3600)
    work_.wait(lock, is_awake);
  else if (seconds > 0)
    work_.wait_for(lock, std::chrono::duration<double>(seconds), is_awake);
  has_work_ = false;
  taken_.page.reset();
  taken_.has_left = false;
  taken_.commands.clear();
  taken_.bytes = 0;
  std::swap(taken_, inbox_);
  return !stopping_;
}

void SessionThread::take_commands() {
  if (taken_.page) {
    greeted_ = *taken_.page;
    if (taken_.has_left) session_.leave();
    session_.greet();
    // The last message may still be in transit to the previous page, so its memory is not reused.
    message_ = std::make_shared<MessageWriter>();
    last_ = Clock::now();
  }
  for (const std::string& text : taken_.commands) session_.command(text);
  if (!taken_.commands.empty()) listener_.commands_taken();
}

/// Returns the number of seconds until the next change if no command arrives.
double SessionThread::let_time_pass() {
  const Clock::time_point now = Clock::now();
  const double seconds = std::chrono::duration<double>(now - last_).count();
  last_ = now;
  bool has_page = false;
  {
    const std::lock_guard lock(mutex_);
    has_page = page_ != 0;
  }
  if (!has_page) {
    session_.leave();
    return for_ever;
  }
  return session_.ended() ? for_ever : session_.advance(seconds);
}

void SessionThread::offer_message() {
  {
    const std::lock_guard lock(mutex_);
    // A new page must be greeted first.
    if (page_ == 0 || page_ != greeted_ || in_delivery_) return;
  }
  const std::span<const std::byte> message = session_.next_message(*message_);
  if (message.empty()) {
    ended_ = session_.ended();
    return;
  }
  {
    const std::lock_guard lock(mutex_);
    if (page_ != greeted_) return;
    in_delivery_ = true;
  }
  listener_.message(greeted_, {message, message_});
}

}  // namespace supple::viewer
