#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "supple/contact.hpp"

namespace supple {

/// A contact on its way into the result; of which two objects is known elsewhere.
struct FoundContact {
  std::uint32_t triangle_a = 0, triangle_b = 0;
  std::uint32_t details = 0;  ///< index in the details of the worker that found it
  std::uint16_t worker = 0;
  IntersectionKind kind = IntersectionKind::segment;
  std::uint8_t point_count = 0;

  constexpr bool operator==(const FoundContact&) const = default;
};
static_assert(sizeof(FoundContact) == 16);

inline bool in_order_of_triangles(const FoundContact& p, const FoundContact& q) {
  return p.triangle_a != q.triangle_a ? p.triangle_a < q.triangle_a : p.triangle_b < q.triangle_b;
}

/// Puts the contacts of one job at a time into the order of the result: by triangle a, then by triangle b.
/// Keeps its memory between jobs.
///
/// Contacts are counted into buckets of a range of triangles a each, a few to a bucket. Within a
/// bucket the place of a contact is how many others come before it, which vectors of keys count without
/// branches.
class ContactOrder {
 public:
  /// `found` are of different pairs of triangles. What is returned lasts until the next call. O(n) while no
  /// range of triangles has very many contacts, O(n log n) at worst.
  std::span<const FoundContact> sort(std::span<const FoundContact> found);

 private:
  struct Keys;
  void sort_by_buckets(std::span<const FoundContact> found, const Keys& keys, std::span<FoundContact> sorted);

  // Of one bucket after the other: what tells the order within it, which contact that is of, and where that
  // belongs.
  std::vector<std::int32_t> keys_, places_;
  std::vector<std::uint32_t> numbers_;
  std::vector<FoundContact> sorted_;
};

}  // namespace supple
