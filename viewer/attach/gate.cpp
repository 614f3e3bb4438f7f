#include "gate.hpp"

#include <chrono>
#include <iterator>
#include <limits>
#include <utility>

#include "session/pins/pin_rows.hpp"

namespace supple::viewer {
namespace {

using namespace std::chrono_literals;

/// Steps whose statistics wait for the session.
constexpr std::ptrdiff_t most_rows = 4096;
/// The part of the budget in which the program waits. The rest is for what nobody waits for: the threads of
/// the session and of the network take cores and caches from the program, about as much as it waits where it
/// uses all cores (benchmarks/attached.cpp).
constexpr double waiting_part = 0.5;
/// A page that waits for a frame gets one after so many seconds, whatever the budget says: short steps on a
/// busy machine can cost more than their share without any frame, and the page would stay empty.
constexpr double longest_wait = 2;
/// How often a pause looks for a requested stop. A signal handler may request it, so no callback can.
constexpr auto between_looks = 50ms;

}  // namespace

Gate::Gate(const AttachOptions& options, Surroundings surroundings)
    : time_step_(options.time_step),
      waits_for_page_(options.wait_for_page),
      surroundings_(std::move(surroundings)),
      budget_(options.max_slowdown * waiting_part, surroundings_.seconds()) {
  state_.breaks = options.breaks;
}

void Gate::pass(const Scene& scene, const DetectRequest& request) {
  const double begin = surroundings_.seconds();
  Lock lock(mutex_);
  if (is_closed_) return;
  ++state_.step_count;
  state_.last_step = scene.result().step;
  passed_at_ = begin;
  step_ = {&scene, request.contacts.value_or(scene.options().contacts)};
  if (has_page_) remember(scene);
  if (steps_ > 0) --steps_;
  auto found = finder_.find(scene, state_.breaks);
  if (found && (has_page_ || waits_for_page_)) {
    state_.runs = false;
    state_.reason = std::move(found);
    steps_ = 0;
  }
  if (!is_halted() && is_requested_ && (budget_.affords(begin) || begin - shown_at_ > longest_wait)) {
    shown_at_ = begin;
    show(lock);
  }
  const double end = surroundings_.seconds();
  budget_.spend(begin, end);
  seconds_in_steps_ += end - begin;
  if (!is_halted()) return;
  hold(lock, request);
  budget_.skip(end, surroundings_.seconds());
}

void Gate::remember(const Scene& scene) {
  const DetectResult& result = scene.result();
  if (std::ssize(rows_) >= most_rows) rows_.erase(rows_.begin(), rows_.begin() + most_rows / 2);
  const auto copy = [](const PairEvents& events) {
    return StepRow::Events{{events.begin.begin(), events.begin.end()},
                           {events.end.begin(), events.end.end()}};
  };
  rows_.push_back({result.step, result.stats, copy(result.contact_events), copy(result.volume_events)});
  pins_.measure(scene, result.step, static_cast<double>(result.step) * time_step_, pin_rows_);
  limit_rows(pin_rows_);
}

void Gate::wait(const Scene& scene, const CallLimits& limits) {
  const double begin = surroundings_.seconds();
  Lock lock(mutex_);
  if (is_closed_ || state_.step_count == 0) return;
  step_.scene = &scene;
  state_.runs = false;
  steps_ = 0;
  is_at_end_ = true;
  hold(lock, limits);
  is_at_end_ = false;
  budget_.skip(begin, surroundings_.seconds());
}

/// Whether the program must wait now.
bool Gate::is_halted() const {
  if (is_closed_) return false;
  if (waits_for_page_ && frame_count_ == 0) return true;
  return !state_.runs && steps_ == 0 && (has_page_ || waits_for_page_ || is_at_end_);
}

/// Lets the session in once.
void Gate::show(Lock& lock) {
  is_requested_ = false;
  is_waiting_ = true;
  surroundings_.wake();
  changed_.wait_for(lock, surroundings_.patience, [&] { return is_inside_ || is_closed_; });
  changed_.wait(lock, [&] { return !is_inside_; });
  is_waiting_ = false;
}

template <class Limits>
void Gate::hold(Lock& lock, const Limits& limits) {
  const auto is_stopped = [&] {
#ifdef __cpp_lib_jthread
    return limits.stop.stop_requested();
#else
    return false;
#endif
  };
  is_waiting_ = true;
  surroundings_.wake();
  while (is_halted() && !is_stopped()) changed_.wait_for(lock, between_looks);
  is_waiting_ = false;
  if (is_inside_) surroundings_.wake();
  changed_.wait(lock, [&] { return !is_inside_; });
  state_.reason.reset();
}

void Gate::close() {
  const std::lock_guard lock(mutex_);
  is_closed_ = true;
  changed_.notify_all();
  if (is_inside_) surroundings_.wake();
}

std::uint64_t Gate::frame_count() const {
  const std::lock_guard lock(mutex_);
  return frame_count_;
}

double Gate::seconds_in_steps() const {
  const std::lock_guard lock(mutex_);
  return seconds_in_steps_;
}

// The thread of the session calls these functions.

void Gate::request() {
  const std::lock_guard lock(mutex_);
  is_requested_ = true;
}

const ProgramStep* Gate::enter() {
  const std::lock_guard lock(mutex_);
  is_inside_ = is_waiting_ && !is_closed_;
  changed_.notify_all();
  return is_inside_ ? &step_ : nullptr;
}

void Gate::leave() {
  const std::lock_guard lock(mutex_);
  is_inside_ = false;
  changed_.notify_all();
}

void Gate::take_frame() {
  const std::lock_guard lock(mutex_);
  ++frame_count_;
  changed_.notify_all();
}

void Gate::set_page(bool is_connected) {
  const std::lock_guard lock(mutex_);
  has_page_ = is_connected;
  is_requested_ = false;
  shown_at_ = -std::numeric_limits<double>::infinity();
  if (!is_connected && !waits_for_page_ && !is_at_end_) {
    state_.runs = true;
    steps_ = 0;
  }
  changed_.notify_all();
}

void Gate::run() {
  const std::lock_guard lock(mutex_);
  state_.runs = true;
  steps_ = 0;
  changed_.notify_all();
}

void Gate::pause() {
  const std::lock_guard lock(mutex_);
  state_.runs = false;
  steps_ = 0;
}

void Gate::step(std::uint64_t count) {
  const std::lock_guard lock(mutex_);
  state_.runs = false;
  steps_ += count;
  changed_.notify_all();
}

void Gate::set_breaks(const BreakOptions& breaks) {
  const std::lock_guard lock(mutex_);
  if (state_.step_count > 0) check(breaks, step_.contacts);
  state_.breaks = breaks;
  finder_.forget();
}

std::vector<StepRow> Gate::take_rows() {
  const std::lock_guard lock(mutex_);
  return std::exchange(rows_, {});
}

void Gate::set_pins(std::vector<Pin> pins) {
  const std::lock_guard lock(mutex_);
  pins_.set(std::move(pins));
}

std::vector<PinRow> Gate::take_pin_rows() {
  const std::lock_guard lock(mutex_);
  return std::exchange(pin_rows_, {});
}

ProgramState Gate::state() const {
  const std::lock_guard lock(mutex_);
  ProgramState state = state_;
  state.is_held = is_halted();
  if (!is_waiting_ && state.step_count > 0) state.seconds_since_step = surroundings_.seconds() - passed_at_;
  return state;
}

}  // namespace supple::viewer
