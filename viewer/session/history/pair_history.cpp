#include "history/pair_history.hpp"

#include <algorithm>
#include <iterator>

namespace supple::viewer {
namespace {

/// The events that are kept, of each kind, when there are very many in a step.
constexpr std::size_t most_events = 400'000;
/// Room for events from the start, so that most runs allocate it once.
constexpr std::size_t first_events = 4'096;

}  // namespace

void PairHistory::Side::add(std::uint64_t step, std::pair<std::uint32_t, std::uint32_t> pair) {
  if (events.size() == most_events) {
    constexpr std::size_t surplus = most_events / 4;  // many at once, so that the cost per event is small
    events.erase(events.begin(), events.begin() + surplus);
    sent -= std::min(sent, surplus);
  }
  if (events.empty()) events.reserve(first_events);
  events.push_back({static_cast<std::uint32_t>(step), pair.first, pair.second});
}

void PairHistory::restart() {
  pairs_.clear();
  for (Side& side : sides_) {
    side.events.clear();
    side.sent = 0;
  }
}

void PairHistory::forget_sent() {
  for (Side& side : sides_) side.sent = 0;
}

void PairHistory::set(std::uint64_t step, ObjectPairs& pairs) {
  const auto add_missing = [&](Side& side, const ObjectPairs& all, const ObjectPairs& from) {
    changed_.clear();
    std::set_difference(all.begin(), all.end(), from.begin(), from.end(), std::back_inserter(changed_));
    for (const auto& pair : changed_) side.add(step, pair);
  };
  add_missing(sides_[0], pairs, pairs_);
  add_missing(sides_[1], pairs_, pairs);
  pairs_.swap(pairs);
}

void PairHistory::change(std::uint64_t step, std::span<const ObjectPair> begin,
                         std::span<const ObjectPair> end) {
  const auto place = [&](std::pair<std::uint32_t, std::uint32_t> pair) {
    return std::lower_bound(pairs_.begin(), pairs_.end(), pair);
  };
  for (const ObjectPair& p : begin) {
    const std::pair pair{p.a.index, p.b.index};
    const auto at = place(pair);
    if (at != pairs_.end() && *at == pair) continue;
    pairs_.insert(at, pair);
    sides_[0].add(step, pair);
  }
  for (const ObjectPair& p : end) {
    const std::pair pair{p.a.index, p.b.index};
    const auto at = place(pair);
    if (at == pairs_.end() || *at != pair) continue;
    pairs_.erase(at);
    sides_[1].add(step, pair);
  }
}

void PairHistory::drop_before(std::uint64_t step) {
  for (auto& [tag, events, sent] : sides_) {
    const auto kept = std::find_if(events.begin(), events.end(), [&](const auto& event) {
      return event[0] >= static_cast<std::uint32_t>(step);
    });
    sent -= std::min(sent, static_cast<std::size_t>(kept - events.begin()));
    events.erase(events.begin(), kept);
  }
}

void PairHistory::send(MessageWriter& message) {
  for (auto& [tag, events, sent] : sides_) {
    const auto rows = message.add<std::array<std::uint32_t, 3>>(tag, events.size() - sent);
    std::copy(events.begin() + static_cast<std::ptrdiff_t>(sent), events.end(), rows.begin());
    sent = events.size();
  }
}

}  // namespace supple::viewer
