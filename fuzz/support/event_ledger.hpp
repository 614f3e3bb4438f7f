#pragma once

#include <algorithm>
#include <set>

#include "supple/result.hpp"
#include "support/check.hpp"

namespace supple::fuzz {

/// The pairs that are active according to the events so far. Checks that each pair begins, stays and ends in
/// this order.
class EventLedger {
 public:
  void apply(const PairEvents& events) {
    for (const ObjectPair& pair : events.end)
      check(active_.erase(pair) == 1, "a pair ended that had not begun");
    check(std::equal(active_.begin(), active_.end(), events.stay.begin(), events.stay.end()),
          "a pair that stays is missing or too much");
    for (const ObjectPair& pair : events.begin) check(active_.insert(pair).second, "a pair began twice");
  }

  const std::set<ObjectPair>& active() const { return active_; }

 private:
  std::set<ObjectPair> active_;
};

/// All kinds of events that `Scene::detect` reports without `ComparisonOptions`.
struct EventLedgers {
  EventLedger volumes, contacts, proximity, penetration;

  void apply(const DetectResult& result) {
    volumes.apply(result.volume_events);
    contacts.apply(result.contact_events);
    proximity.apply(result.proximity_events);
    penetration.apply(result.penetration_events);
  }
};

}  // namespace supple::fuzz
