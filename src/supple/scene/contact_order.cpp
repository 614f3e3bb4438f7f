#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "scene/contact_order.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <utility>

#include "scene/contact_order.hpp"

HWY_BEFORE_NAMESPACE();
namespace supple::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

/// Where each key belongs among those of its bucket. Bucket k ends at `ends[k]`, where the next one starts;
/// in those of more than `most` keys they stay where they are. Reads and writes past the last bucket, by less
/// than a vector.
void place_in_buckets(const std::int32_t* keys, const std::uint32_t* ends, std::size_t buckets,
                      std::size_t most, std::int32_t* places) {
  const hn::CappedTag<std::int32_t, 16> tag;
  const std::size_t lanes = hn::Lanes(tag);
  const auto one = hn::Set(tag, 1);
  std::size_t begin = 0;
  for (std::size_t bucket = 0; bucket < buckets; ++bucket) {
    const std::size_t end = ends[bucket];
    const bool is_ranked = end - begin <= most;
    for (std::size_t i = begin; i < end; i += lanes) {
      const auto mine = hn::LoadU(tag, keys + i);
      auto place = is_ranked ? hn::Set(tag, static_cast<std::int32_t>(begin))
                             : hn::Iota(tag, static_cast<std::int32_t>(i));
      for (std::size_t k = begin; is_ranked && k < end; ++k) {
        place = hn::IfThenElse(hn::Lt(hn::Set(tag, keys[k]), mine), hn::Add(place, one), place);
      }
      hn::StoreU(place, tag, places + i);
    }
    begin = end;
  }
}

}  // namespace
}  // namespace supple::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace supple {

HWY_EXPORT(place_in_buckets);

namespace {

constexpr int most_bucket_bits = 12;
constexpr std::size_t contacts_of_bucket = 3;
/// Larger buckets are sorted by comparing.
constexpr std::size_t most_ranked = 256;
constexpr int key_bits = 31;
constexpr std::size_t padding = 16;

struct Bounds {
  std::uint32_t least = ~std::uint32_t{0}, most = 0;

  void extend(std::uint32_t number) {
    least = std::min(least, number);
    most = std::max(most, number);
  }
  std::uint32_t extent() const { return most - least; }
  int bits() const { return std::bit_width(extent()); }
};

}  // namespace

/// Upper bits of triangle a tell the bucket. What is left of it and triangle b are the key, where they fit.
struct ContactOrder::Keys {
  Bounds a, b;
  int shift, bits_b;

  explicit Keys(std::span<const FoundContact> found) {
    for (const FoundContact& contact : found) {
      a.extend(contact.triangle_a);
      b.extend(contact.triangle_b);
    }
    bits_b = b.bits();
    const int wanted = std::max(static_cast<int>(std::bit_width(found.size() / contacts_of_bucket)),
                                a.bits() + bits_b - key_bits);
    shift = a.bits() - std::min({wanted, a.bits(), most_bucket_bits});
  }
  bool fit() const { return shift + bits_b <= key_bits; }
  std::size_t buckets() const { return (a.extent() >> shift) + 1; }
  std::size_t bucket(const FoundContact& contact) const { return (contact.triangle_a - a.least) >> shift; }
  std::int32_t key(const FoundContact& contact) const {
    const std::uint32_t left = (contact.triangle_a - a.least) & ((1u << shift) - 1);
    return static_cast<std::int32_t>(left << bits_b | (contact.triangle_b - b.least));
  }
};

std::span<const FoundContact> ContactOrder::sort(std::span<const FoundContact> found) {
  if (sorted_.size() < found.size()) {
    sorted_.resize(found.size());
    numbers_.resize(found.size());
    keys_.resize(found.size() + padding);
    places_.resize(found.size() + padding);
  }
  const std::span<FoundContact> sorted(sorted_.data(), found.size());
  const Keys keys(found);
  if (found.size() > 1 && keys.fit()) {
    sort_by_buckets(found, keys, sorted);
  } else {
    std::copy(found.begin(), found.end(), sorted.begin());
    std::sort(sorted.begin(), sorted.end(), in_order_of_triangles);
  }
  return sorted;
}

void ContactOrder::sort_by_buckets(std::span<const FoundContact> found, const Keys& keys,
                                   std::span<FoundContact> sorted) {
  std::array<std::uint32_t, std::size_t{1} << most_bucket_bits> ends;
  const std::size_t buckets = keys.buckets();
  std::fill_n(ends.begin(), buckets, 0u);
  for (const FoundContact& contact : found) ++ends[keys.bucket(contact)];
  std::uint32_t total = 0, largest = 0;
  for (std::size_t bucket = 0; bucket < buckets; ++bucket) {
    largest = std::max(largest, ends[bucket]);
    total += std::exchange(ends[bucket], total);
  }
  for (std::uint32_t i = 0; i < found.size(); ++i) {
    const std::uint32_t place = ends[keys.bucket(found[i])]++;
    keys_[place] = keys.key(found[i]);
    numbers_[place] = i;
  }
  HWY_DYNAMIC_DISPATCH(place_in_buckets)(keys_.data(), ends.data(), buckets, most_ranked, places_.data());
  for (std::size_t i = 0; i < found.size(); ++i)
    sorted[static_cast<std::size_t>(places_[i])] = found[numbers_[i]];
  if (largest <= most_ranked) return;
  for (std::size_t bucket = 0, begin = 0; bucket < buckets; begin = ends[bucket++]) {
    const auto in_bucket = sorted.subspan(begin, ends[bucket] - begin);
    if (in_bucket.size() > most_ranked) std::sort(in_bucket.begin(), in_bucket.end(), in_order_of_triangles);
  }
}

}  // namespace supple
#endif
