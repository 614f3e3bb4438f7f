#include "scene/pair_cache.hpp"

#include <algorithm>
#include <cassert>

namespace supple {

void PairCache::prepare(std::span<const ObjectPair> now) {
  pairs_.reserve(now.size());
  begin_.reserve(now.size());
  stay_.reserve(now.size());
  end_.reserve(pairs_.size());
}

void PairCache::update(std::span<const ObjectPair> now) {
  assert(std::is_sorted(now.begin(), now.end()) && std::adjacent_find(now.begin(), now.end()) == now.end());
  begin_.clear();
  stay_.clear();
  end_.clear();
  auto old = pairs_.begin();
  for (const ObjectPair& pair : now) {
    for (; old != pairs_.end() && *old < pair; ++old) end_.push_back(*old);
    const bool known = old != pairs_.end() && *old == pair;
    if (known) ++old;
    if (known && !is_released(pair)) {
      stay_.push_back(pair);
    } else {
      if (known) end_.push_back(pair);
      begin_.push_back(pair);
    }
  }
  end_.insert(end_.end(), old, pairs_.end());
  pairs_.assign(now.begin(), now.end());
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
