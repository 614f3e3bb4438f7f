#include "answers/contact_order.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

#include "support/random.hpp"

namespace supple {
namespace {

/// Contacts with distinct triangles. The other members identify each contact.
std::vector<FoundContact> contacts_of(const std::set<std::pair<std::uint32_t, std::uint32_t>>& triangles,
                                      RandomNumbers& random) {
  std::vector<FoundContact> found;
  for (const auto& [a, b] : triangles) {
    const auto i = static_cast<std::uint32_t>(found.size());
    found.push_back({a, b, i, static_cast<std::uint16_t>(i % 5), static_cast<IntersectionKind>(i % 3),
                     static_cast<std::uint8_t>(i % 7)});
  }
  random.shuffle(found);
  return found;
}

void expect_sorted(const std::vector<FoundContact>& found, ContactOrder& order) {
  std::vector<FoundContact> expected = found;
  std::sort(expected.begin(), expected.end(), [](const FoundContact& p, const FoundContact& q) {
    return std::tie(p.triangle_a, p.triangle_b) < std::tie(q.triangle_a, q.triangle_b);
  });
  std::vector<FoundContact> sorted;
  for (const std::uint32_t i : order.sort(found)) sorted.push_back(found[i]);
  EXPECT_EQ(sorted, expected);
}

TEST(ContactOrder, RandomContactsOfAnyNumberAndSpread) {
  RandomNumbers random(17);
  ContactOrder order;  // reused, so it holds the memory of the previous sort
  for (const std::size_t count : {0u, 1u, 2u, 12u, 25u, 100u, 3000u}) {
    for (const std::uint32_t spread : {1u, 2u, 60u, 511u, 512u, 70000u, 0xffffffffu}) {
      std::set<std::pair<std::uint32_t, std::uint32_t>> triangles;
      const std::uint32_t least = spread < 0x7fffffff ? random.below(0x7fffffff) : 0;
      while (triangles.size() < count) {
        triangles.insert({least + random.below(spread), random.below(5000)});
      }
      expect_sorted(contacts_of(triangles, random), order);
    }
  }
}

TEST(ContactOrder, NumbersOfAnyWidth) {
  RandomNumbers random(19);
  ContactOrder order;
  for (const int bits_a : {1, 15, 21, 22, 31}) {
    for (const int bits_b : {1, 16, 21, 22, 30, 31, 32}) {
      std::set<std::pair<std::uint32_t, std::uint32_t>> triangles{{0, 0}};
      const auto most = [](int bits) { return ~std::uint32_t{0} >> (32 - bits); };
      triangles.insert({most(bits_a), most(bits_b)});
      for (int i = 0; i < 200; ++i)
        triangles.insert({static_cast<std::uint32_t>(random.bits()) & most(bits_a),
                          static_cast<std::uint32_t>(random.bits()) & most(bits_b)});
      expect_sorted(contacts_of(triangles, random), order);
    }
  }
}

TEST(ContactOrder, OneTriangleAgainstVeryMany) {
  RandomNumbers random(18);
  ContactOrder order;
  std::set<std::pair<std::uint32_t, std::uint32_t>> triangles;
  for (std::uint32_t b = 0; b < 2000; ++b) triangles.insert({7, b * 3});
  for (std::uint32_t a = 0; a < 2000; ++a) triangles.insert({a * 5, 9});
  for (const std::uint32_t end : {0u, 0xffffffffu}) triangles.insert({end, end});
  expect_sorted(contacts_of(triangles, random), order);
}

}  // namespace
}  // namespace supple
