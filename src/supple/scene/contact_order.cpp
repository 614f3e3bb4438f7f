#include "scene/contact_order.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <limits>

namespace supple {
namespace {

constexpr int most_bucket_bits = 12;
/// Counting ranks sorts buckets up to this size faster than `std::sort`.
constexpr std::size_t most_ranked = 16;

std::uint64_t key_of(const FoundContact& contact) {
  return std::uint64_t{contact.triangle_a} << 32 | contact.triangle_b;
}

/// The rank of a contact is the number of smaller keys. Counting has no branches that could be mispredicted.
void sort_bucket(std::span<FoundContact> bucket) {
  const std::size_t size = bucket.size();
  if (size < 2) return;
  if (size > most_ranked) {
    std::ranges::sort(bucket, {}, key_of);
    return;
  }
  std::array<FoundContact, most_ranked> contacts;
  std::array<std::uint64_t, most_ranked> keys;
  for (std::size_t i = 0; i < size; ++i) {
    contacts[i] = bucket[i];
    keys[i] = key_of(bucket[i]);
  }
  for (std::size_t i = 0; i < size; ++i) {
    std::size_t rank = 0;
    for (std::size_t j = 0; j < size; ++j) rank += keys[j] < keys[i];
    bucket[rank] = contacts[i];
  }
}

}  // namespace

std::span<const FoundContact> ContactOrder::sort(std::span<const FoundContact> found) {
  if (found.empty()) return {};
  if (sorted_.size() < found.size()) sorted_.resize(found.size());
  std::uint32_t least = std::numeric_limits<std::uint32_t>::max(), most = 0;
  for (const FoundContact& contact : found) {
    least = std::min(least, contact.triangle_a);
    most = std::max(most, contact.triangle_a);
  }
  const int bits = static_cast<int>(std::bit_width(most - least));
  const int bucket_bits = std::min({bits, most_bucket_bits, static_cast<int>(std::bit_width(found.size()))});
  const auto bucket_of = [&](const FoundContact& contact) {
    return static_cast<std::size_t>(std::uint64_t{contact.triangle_a - least} >> (bits - bucket_bits));
  };
  const auto buckets = static_cast<std::size_t>(std::uint64_t{most - least} >> (bits - bucket_bits)) + 1;
  std::array<std::uint32_t, (std::size_t{1} << most_bucket_bits) + 1> ends;
  std::fill_n(ends.begin(), buckets + 1, 0u);
  for (const FoundContact& contact : found) ++ends[bucket_of(contact) + 1];
  for (std::size_t bucket = 0; bucket < buckets; ++bucket) ends[bucket + 1] += ends[bucket];
  for (const FoundContact& contact : found) sorted_[ends[bucket_of(contact)]++] = contact;
  const std::span<FoundContact> sorted(sorted_.data(), found.size());
  std::size_t begin = 0;
  for (std::size_t bucket = 0; bucket < buckets; begin = ends[bucket++]) {
    sort_bucket(sorted.subspan(begin, ends[bucket] - begin));
  }
  return sorted;
}

}  // namespace supple
