#include "core/bucket_sort.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <compare>
#include <cstdint>
#include <functional>
#include <vector>

#include "support/random.hpp"

namespace supple::bucket_sort_test {

struct Item {
  std::uint32_t group = 0, id = 0, rest = 0;

  auto operator<=>(const Item&) const = default;
};

void expect_sorted(const std::vector<Item>& items, BucketSort& order) {
  std::vector<Item> expected = items;
  std::ranges::sort(expected);
  for (const std::uint32_t threads : {1u, 3u}) {
    std::vector<Item> sorted;
    order.sort([&](const auto& visit) { std::ranges::for_each(items, visit); },
               [](const Item& item) {
                 return SortKey{item.group, item.id};
               },
               std::less<>(), Parallel(threads), sorted);
    EXPECT_EQ(sorted, expected);
  }
}

TEST(BucketSort, OfAnyNumberGroupsAndSpread) {
  RandomNumbers random(17);
  BucketSort order;  // reused, so it holds the memory of the list before
  for (const std::size_t count : {0u, 1u, 2u, 12u, 25u, 100u, 3000u}) {
    for (const std::uint32_t groups : {1u, 2u, 9u}) {
      for (const std::uint32_t spread : {1u, 2u, 60u, 511u, 512u, 70000u, 0xffffffffu}) {
        const std::uint32_t least = spread < 0x7fffffff ? random.below(0x7fffffff) : 0;
        std::vector<Item> items;
        for (std::size_t i = 0; i < count; ++i)
          items.push_back({random.below(groups), least + random.below(spread), random.below(5000)});
        expect_sorted(items, order);
      }
    }
  }
}

TEST(BucketSort, OfTheSmallestAndTheLargestKeys) {
  BucketSort order;
  constexpr std::uint32_t last = ~std::uint32_t{0};
  expect_sorted({{8, last, 1}, {0, 0, last}, {8, 0, 3}, {0, last, 0}, {8, last, 0}, {3, 7, 7}}, order);
  expect_sorted({{8, last, 1}}, order);
}

TEST(BucketSort, OfOneKeyWithVeryMany) {
  RandomNumbers random(18);
  BucketSort order;
  std::vector<Item> items;
  for (std::uint32_t i = 0; i < 2000; ++i) items.push_back({0, 7, i * 3});
  for (std::uint32_t i = 0; i < 2000; ++i) items.push_back({0, i * 5, 9});
  random.shuffle(items);
  expect_sorted(items, order);
}

}  // namespace supple::bucket_sort_test
