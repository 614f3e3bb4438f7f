#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "supple/result.hpp"
#include "supple/types.hpp"

namespace supple {

/// The place of the events of a kind of contacts among those of all kinds. Intersections and continuous
/// contacts have the same events.
constexpr std::size_t place_of_events(const ContactKindInfo& kind) {
  std::size_t place = 0;
  for (const ContactKindInfo* of = contact_kinds.data(); of->events != kind.events; ++of)
    place += of->events != of[1].events ? 1 : 0;
  return place;
}
inline constexpr std::size_t events_of_kinds =
    place_of_events(std::ranges::max(contact_kinds, {}, place_of_events)) + 1;

/// The overlapping pairs of the last step and how they changed: pairs are kept while they overlap and
/// released when they separate (the paper's section 5.2). A pair that begins ends exactly once.
class PairCache {
 public:
  /// Takes memory for an `update` with these pairs, so that it cannot fail; only when there are more pairs
  /// than ever before.
  void prepare(std::span<const ObjectPair> now);
  /// Takes the pairs of this step, ascending, each once. O(old + new).
  void update(std::span<const ObjectPair> now);

  /// The object was removed: its pairs end at the next `update`. A pair that this `update` contains again
  /// ends and begins. Objects with the same index and another generation are different objects.
  void release(ObjectId object);
  /// Takes memory for a `release`, so that it cannot fail.
  void prepare_release();

  /// Changes made by the last `update`, each list ascending. Valid until the next one.
  PairEvents events() const { return {begin_, stay_, end_}; }
  /// Calls `visit(list)` for each list of `events`.
  template <class Visit>
  void visit_lists(const Visit& visit) {
    visit(begin_);
    visit(stay_);
    visit(end_);
  }

 private:
  bool is_released(const ObjectPair& pair) const;

  std::vector<ObjectPair> begin_, stay_, end_;
  std::vector<ObjectPair> last_begin_, last_stay_;  // of the `update` before: scratch memory
  std::vector<ObjectId> released_;                  // since the last update, ascending
};

}  // namespace supple
