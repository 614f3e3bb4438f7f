#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "supple/contact.hpp"

namespace supple {

/// A contact before it enters the result. The job says which two objects it belongs to.
struct FoundContact {
  std::uint32_t triangle_a = 0, triangle_b = 0;
  std::uint32_t details = 0;  ///< index into the details of the worker that found it
  std::uint16_t worker = 0;
  IntersectionKind kind = IntersectionKind::segment;
  std::uint8_t point_count = 0;

  constexpr bool operator==(const FoundContact&) const = default;
};
static_assert(sizeof(FoundContact) == 16);

inline bool in_order_of_triangles(const FoundContact& p, const FoundContact& q) {
  return p.triangle_a != q.triangle_a ? p.triangle_a < q.triangle_a : p.triangle_b < q.triangle_b;
}

/// Sorts the contacts of one job at a time by triangle a, then by triangle b. Counts them into buckets by
/// ranges of triangle a, a few contacts in each, and sorts each bucket. Keeps its memory between jobs.
class ContactOrder {
 public:
  /// Returns the indices of the contacts in order, valid until the next call. `found` are contacts of
  /// different pairs of triangles. O(n) while no range of triangles has very many contacts, O(n log n) at
  /// worst.
  std::span<const std::uint32_t> sort(std::span<const FoundContact> found);

 private:
  class Keys;
  void sort_by_buckets(std::span<const FoundContact> found, const Keys& keys, std::span<std::uint32_t> order);

  // Keys and indices of the contacts, bucket by bucket.
  std::vector<std::int32_t> keys_;
  std::vector<std::uint32_t> numbers_, order_;
};

}  // namespace supple
