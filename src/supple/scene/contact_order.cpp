#include "scene/contact_order.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <limits>

namespace supple {
namespace {

constexpr int most_bucket_bits = 12;
constexpr std::size_t contacts_of_bucket = 3;
/// Insertion sorts buckets up to this size faster than `std::sort`.
constexpr std::size_t most_inserted = 16;

void sort_bucket(std::span<FoundContact> bucket) {
  if (bucket.size() > most_inserted) {
    std::sort(bucket.begin(), bucket.end(), in_order_of_triangles);
    return;
  }
  for (std::size_t i = 1; i < bucket.size(); ++i) {
    const FoundContact contact = bucket[i];
    std::size_t place = i;
    for (; place > 0 && in_order_of_triangles(contact, bucket[place - 1]); --place) {
      bucket[place] = bucket[place - 1];
    }
    bucket[place] = contact;
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
  const int bucket_bits =
      std::min({bits, most_bucket_bits, static_cast<int>(std::bit_width(found.size() / contacts_of_bucket))});
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
