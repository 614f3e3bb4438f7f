#include "scene/contact_order.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

namespace supple {
namespace {

/// Contacts of different triangles, whose other members tell them apart.
std::vector<FoundContact> contacts_of(const std::set<std::pair<std::uint32_t, std::uint32_t>>& triangles,
                                      std::mt19937& random) {
  std::vector<FoundContact> found;
  for (const auto& [a, b] : triangles) {
    const auto i = static_cast<std::uint32_t>(found.size());
    found.push_back({a, b, i, static_cast<std::uint16_t>(i % 5), static_cast<IntersectionKind>(i % 3),
                     static_cast<std::uint8_t>(i % 7)});
  }
  std::shuffle(found.begin(), found.end(), random);
  return found;
}

void expect_sorted(std::vector<FoundContact> found, std::vector<FoundContact>& scratch) {
  std::vector<FoundContact> expected = found;
  std::sort(expected.begin(), expected.end(), [](const FoundContact& p, const FoundContact& q) {
    return std::tie(p.triangle_a, p.triangle_b) < std::tie(q.triangle_a, q.triangle_b);
  });
  sort_contacts(found, scratch);
  EXPECT_EQ(found, expected);
}

TEST(ContactOrder, RandomContactsOfAnyNumberAndSpread) {
  std::mt19937 random(17);
  std::vector<FoundContact> scratch;  // of the sort before
  for (const std::size_t count : {0u, 1u, 2u, 23u, 24u, 25u, 100u, 3000u}) {
    for (const std::uint32_t spread : {1u, 2u, 60u, 511u, 512u, 70000u, 0xffffffffu}) {
      std::set<std::pair<std::uint32_t, std::uint32_t>> triangles;
      const std::uint32_t least = spread < 0x7fffffff ? static_cast<std::uint32_t>(random() % 0x7fffffff) : 0;
      while (triangles.size() < count) {
        triangles.insert({least + static_cast<std::uint32_t>(random()) % spread,
                          static_cast<std::uint32_t>(random()) % 5000});
      }
      expect_sorted(contacts_of(triangles, random), scratch);
    }
  }
}

TEST(ContactOrder, OneTriangleAgainstVeryMany) {
  std::mt19937 random(18);
  std::vector<FoundContact> scratch;
  std::set<std::pair<std::uint32_t, std::uint32_t>> triangles;
  for (std::uint32_t b = 0; b < 2000; ++b) triangles.insert({7, b * 3});
  for (std::uint32_t a = 0; a < 2000; ++a) triangles.insert({a * 5, 9});
  for (const std::uint32_t end : {0u, 0xffffffffu}) triangles.insert({end, end});
  expect_sorted(contacts_of(triangles, random), scratch);
}

}  // namespace
}  // namespace supple
