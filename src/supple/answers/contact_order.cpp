#include "answers/contact_order.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <numeric>

namespace supple {
namespace {

constexpr int most_bucket_bits = 12;
constexpr std::size_t contacts_of_bucket = 4;  // about this many on average
/// Larger buckets are sorted by `std::sort`.
constexpr std::size_t most_ranked = 128;
/// Compilers compare several keys of 32 bits at once, on every instruction set.
constexpr int key_bits = 31;
/// This many keys are ranked at a time.
constexpr std::size_t lanes = 8;

struct Extent {
  std::uint32_t least = ~std::uint32_t{0}, most = 0;

  void include(std::uint32_t number) {
    least = std::min(least, number);
    most = std::max(most, number);
  }
  int bits() const { return static_cast<int>(std::bit_width(most - least)); }
};

void sort_by_triangles(std::span<const FoundContact> found, std::span<std::uint32_t> order) {
  std::ranges::sort(order, in_order_of_triangles, [&](std::uint32_t i) { return found[i]; });
}

}  // namespace

/// The upper bits of triangle a are the bucket. The key is the rest of triangle a and then triangle b.
class ContactOrder::Keys {
 public:
  explicit Keys(std::span<const FoundContact> found) {
    for (const FoundContact& contact : found) {
      a_.include(contact.triangle_a);
      b_.include(contact.triangle_b);
    }
    const int contact_bits = static_cast<int>(std::bit_width(found.size() / contacts_of_bucket));
    shift_ = a_.bits() - std::min({a_.bits(), contact_bits, most_bucket_bits});
  }
  bool fit() const { return shift_ + b_.bits() <= key_bits; }
  std::size_t buckets() const { return ((a_.most - a_.least) >> shift_) + 1; }
  std::size_t bucket(const FoundContact& contact) const { return (contact.triangle_a - a_.least) >> shift_; }
  std::int32_t key(const FoundContact& contact) const {
    const std::uint32_t rest = (contact.triangle_a - a_.least) & ((1u << shift_) - 1);
    return static_cast<std::int32_t>(rest << b_.bits() | (contact.triangle_b - b_.least));
  }

 private:
  Extent a_, b_;
  int shift_ = 0;
};

std::span<const std::uint32_t> ContactOrder::sort(std::span<const FoundContact> found) {
  if (order_.size() < found.size()) {
    keys_.resize(found.size() + lanes);
    numbers_.resize(found.size());
    order_.resize(found.size());  // the last: its size says that all have room
  }
  const std::span<std::uint32_t> order(order_.data(), found.size());
  const Keys keys(found);
  if (found.size() > 1 && keys.fit()) {
    sort_by_buckets(found, keys, order);
  } else {
    std::iota(order.begin(), order.end(), 0u);
    sort_by_triangles(found, order);
  }
  return order;
}

void ContactOrder::sort_by_buckets(std::span<const FoundContact> found, const Keys& keys,
                                   std::span<std::uint32_t> order) {
  std::array<std::uint32_t, (std::size_t{1} << most_bucket_bits) + 1> ends;
  const std::size_t buckets = keys.buckets();
  std::fill_n(ends.begin(), buckets + 1, 0u);
  for (const FoundContact& contact : found) ++ends[keys.bucket(contact) + 1];
  for (std::size_t bucket = 0; bucket < buckets; ++bucket) ends[bucket + 1] += ends[bucket];
  for (std::uint32_t i = 0; i < found.size(); ++i) {
    const std::uint32_t place = ends[keys.bucket(found[i])]++;
    keys_[place] = keys.key(found[i]);
    numbers_[place] = i;
  }
  std::size_t begin = 0;
  for (std::size_t bucket = 0; bucket < buckets; begin = ends[bucket++]) {
    const std::size_t size = ends[bucket] - begin;
    const std::span<const std::int32_t> in_bucket = std::span(keys_).subspan(begin, size);
    const std::span<std::uint32_t> order_in_bucket = order.subspan(begin, size);
    if (size > most_ranked) {
      std::copy_n(numbers_.begin() + static_cast<std::ptrdiff_t>(begin), size, order_in_bucket.begin());
      sort_by_triangles(found, order_in_bucket);
      continue;
    }
    // The rank of a key is the number of smaller keys. Counting has no branches that could be mispredicted.
    for (std::size_t i = 0; i < size; i += lanes) {
      std::array<std::int32_t, lanes> rank{};
      for (const std::int32_t key : in_bucket) {
        for (std::size_t lane = 0; lane < lanes; ++lane) rank[lane] += key < keys_[begin + i + lane];
      }
      for (std::size_t lane = 0; lane < std::min(lanes, size - i); ++lane) {
        order_in_bucket[static_cast<std::size_t>(rank[lane])] = numbers_[begin + i + lane];
      }
    }
  }
}

}  // namespace supple
