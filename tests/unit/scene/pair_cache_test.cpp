#include "scene/pair_cache.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <vector>

#include "unit/broad_phase/volume_scenes.hpp"

namespace supple::pair_cache_test {

using Pairs = std::vector<ObjectPair>;

ObjectPair pair_of(std::uint32_t a, std::uint32_t b, std::uint32_t generation_a = 0,
                   std::uint32_t generation_b = 0) {
  return {{a, generation_a}, {b, generation_b}};
}

Pairs list(std::span<const ObjectPair> pairs) {
  return {pairs.begin(), pairs.end()};
}

TEST(PairCache, TellsWhatBeginsStaysAndEnds) {
  PairCache cache;
  EXPECT_TRUE(cache.events().begin.empty() && cache.events().stay.empty() && cache.events().end.empty());
  cache.update(Pairs{pair_of(0, 1), pair_of(0, 3), pair_of(2, 3)});
  EXPECT_EQ(list(cache.events().begin), (Pairs{pair_of(0, 1), pair_of(0, 3), pair_of(2, 3)}));
  EXPECT_TRUE(cache.events().stay.empty() && cache.events().end.empty());

  cache.update(Pairs{pair_of(0, 2), pair_of(0, 3), pair_of(4, 5)});
  EXPECT_EQ(list(cache.events().begin), (Pairs{pair_of(0, 2), pair_of(4, 5)}));
  EXPECT_EQ(list(cache.events().stay), (Pairs{pair_of(0, 3)}));
  EXPECT_EQ(list(cache.events().end), (Pairs{pair_of(0, 1), pair_of(2, 3)}));

  cache.update({});
  EXPECT_EQ(list(cache.events().end), (Pairs{pair_of(0, 2), pair_of(0, 3), pair_of(4, 5)}));
  cache.update({});
  EXPECT_TRUE(cache.events().end.empty());
}

TEST(PairCache, EndsThePairsOfARemovedObjectOnce) {
  PairCache cache;
  cache.update(Pairs{pair_of(0, 1), pair_of(1, 2), pair_of(3, 4)});
  cache.release({1, 0});
  cache.update(Pairs{pair_of(3, 4)});
  EXPECT_EQ(list(cache.events().end), (Pairs{pair_of(0, 1), pair_of(1, 2)}));
  EXPECT_EQ(list(cache.events().stay), (Pairs{pair_of(3, 4)}));
  cache.update(Pairs{pair_of(3, 4)});
  EXPECT_TRUE(cache.events().end.empty());
}

TEST(PairCache, TellsANewObjectInAnOldSlotFromTheOneBefore) {
  PairCache cache;
  cache.update(Pairs{pair_of(0, 1), pair_of(1, 2)});
  cache.release({1, 0});
  cache.update(Pairs{pair_of(0, 1, 0, 1), pair_of(1, 2, 1, 0)});
  EXPECT_EQ(list(cache.events().begin), (Pairs{pair_of(0, 1, 0, 1), pair_of(1, 2, 1, 0)}));
  EXPECT_EQ(list(cache.events().end), (Pairs{pair_of(0, 1), pair_of(1, 2)}));
  EXPECT_TRUE(cache.events().stay.empty());
}

TEST(PairCache, ReleasedPairsThatComeAgainEndAndBegin) {
  PairCache cache;
  cache.update(Pairs{pair_of(0, 1), pair_of(2, 3)});
  cache.release({3, 0});
  cache.release({3, 0});
  cache.release({9, 9});
  cache.update(Pairs{pair_of(0, 1), pair_of(2, 3)});
  EXPECT_EQ(list(cache.events().begin), (Pairs{pair_of(2, 3)}));
  EXPECT_EQ(list(cache.events().end), (Pairs{pair_of(2, 3)}));
  EXPECT_EQ(list(cache.events().stay), (Pairs{pair_of(0, 1)}));
  cache.update(Pairs{pair_of(0, 1), pair_of(2, 3)});
  EXPECT_EQ(cache.events().stay.size(), 2u) << "a release affects only one update";
}

TEST(PairCache, EveryBeginHasOneEnd) {
  test::Random random(1);
  PairCache cache;
  std::set<ObjectPair> open;
  std::vector<std::uint32_t> generations(12, 0);
  for (int step = 0; step < 300; ++step) {
    if (random.below(3) == 0) {
      const std::uint32_t slot = random.below(12);
      cache.release({slot, generations[slot]++});
    }
    std::set<ObjectPair> now;
    if (step != 299) {
      for (int i = 0; i < 15; ++i) {
        const std::uint32_t a = random.below(11), b = a + 1 + random.below(11 - a);
        now.insert(pair_of(a, b, generations[a], generations[b]));
      }
    }
    cache.update(Pairs(now.begin(), now.end()));
    const PairEvents events = cache.events();
    for (const auto& part : {events.begin, events.stay, events.end})
      ASSERT_TRUE(std::is_sorted(part.begin(), part.end()));
    for (const ObjectPair& pair : events.end) ASSERT_EQ(open.erase(pair), 1u);
    for (const ObjectPair& pair : events.stay) ASSERT_TRUE(open.contains(pair));
    for (const ObjectPair& pair : events.begin) ASSERT_TRUE(open.insert(pair).second);
    ASSERT_EQ(open, now);
  }
  EXPECT_TRUE(open.empty());
}

}  // namespace supple::pair_cache_test
