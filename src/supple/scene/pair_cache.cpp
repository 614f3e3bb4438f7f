#include "scene/pair_cache.hpp"

#include <algorithm>
#include <cassert>

namespace supple {

void PairCache::prepare(std::span<const ObjectPair> now) {
  last_begin_.reserve(now.size());
  last_stay_.reserve(now.size());
  end_.reserve(begin_.size() + stay_.size());
}

void PairCache::update(std::span<const ObjectPair> now) {
  assert(std::is_sorted(now.begin(), now.end()) && std::adjacent_find(now.begin(), now.end()) == now.end());
  begin_.swap(last_begin_);
  stay_.swap(last_stay_);
  begin_.clear();
  stay_.clear();
  end_.clear();
  std::span<const ObjectPair> begun = last_begin_, stayed = last_stay_;
  const auto has_old = [&] { return !begun.empty() || !stayed.empty(); };
  const auto list_of_old = [&]() -> std::span<const ObjectPair>& {
    return stayed.empty() || (!begun.empty() && begun.front() < stayed.front()) ? begun : stayed;
  };
  const auto old = [&] { return list_of_old().front(); };
  const auto take_old = [&] {
    const ObjectPair pair = old();
    list_of_old() = list_of_old().subspan(1);
    return pair;
  };
  for (const ObjectPair& pair : now) {
    while (has_old() && old() < pair) end_.push_back(take_old());
    const bool known = has_old() && old() == pair;
    if (known) take_old();
    if (known && !is_released(pair)) {
      stay_.push_back(pair);
    } else {
      if (known) end_.push_back(pair);
      begin_.push_back(pair);
    }
  }
  while (has_old()) end_.push_back(take_old());
  released_.clear();
}

void PairCache::release(ObjectId object) {
  const auto place = std::lower_bound(released_.begin(), released_.end(), object);
  if (place == released_.end() || *place != object) released_.insert(place, object);
}

void PairCache::prepare_release() {
  if (released_.size() == released_.capacity()) released_.reserve(2 * released_.size() + 8);
}

bool PairCache::is_released(const ObjectPair& pair) const {
  return !released_.empty() && (std::binary_search(released_.begin(), released_.end(), pair.a) ||
                                std::binary_search(released_.begin(), released_.end(), pair.b));
}

}  // namespace supple
