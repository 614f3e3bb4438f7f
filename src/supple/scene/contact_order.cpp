#include "scene/contact_order.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <utility>

namespace supple {
namespace {

/// Fewer than this are sorted by comparing.
constexpr std::size_t few = 24;

bool precedes(const FoundContact& p, const FoundContact& q) {
  return p.triangle_a != q.triangle_a ? p.triangle_a < q.triangle_a : p.triangle_b < q.triangle_b;
}

/// One run of equal a. Most are shorter than a handful.
void sort_run(FoundContact* begin, FoundContact* end) {
  if (end - begin > static_cast<std::ptrdiff_t>(few)) {
    std::sort(begin, end, precedes);
    return;
  }
  for (FoundContact* i = begin + 1; i < end; ++i) {
    const FoundContact contact = *i;
    FoundContact* hole = i;
    for (; hole != begin && contact.triangle_b < hole[-1].triangle_b; --hole) *hole = hole[-1];
    *hole = contact;
  }
}

/// Counting sorts by triangle a, a digit each, the lowest first.
class DigitSort {
 public:
  explicit DigitSort(const std::vector<FoundContact>& found) {
    std::uint32_t largest = 0;
    for (const FoundContact& contact : found) {
      least_ = std::min(least_, contact.triangle_a);
      largest = std::max(largest, contact.triangle_a);
    }
    const int bits = std::bit_width(largest - least_);
    digits_ = (bits + most_bits - 1) / most_bits;
    if (digits_ > 0) digit_bits_ = (bits + digits_ - 1) / digits_;
  }
  int digits() const { return digits_; }

  void sort_by(int digit, const std::vector<FoundContact>& from, std::vector<FoundContact>& to) const {
    std::array<std::uint32_t, std::size_t{1} << most_bits> place;
    const std::size_t values = std::size_t{1} << digit_bits_;
    const int shift = digit * digit_bits_;
    const auto value_of = [&](const FoundContact& contact) {
      return (contact.triangle_a - least_) >> shift & (values - 1);
    };
    std::fill_n(place.begin(), values, 0u);
    for (const FoundContact& contact : from) ++place[value_of(contact)];
    std::uint32_t total = 0;
    for (std::size_t value = 0; value < values; ++value) total += std::exchange(place[value], total);
    for (const FoundContact& contact : from) to[place[value_of(contact)]++] = contact;
  }

 private:
  static constexpr int most_bits = 9;
  std::uint32_t least_ = ~std::uint32_t{0};
  int digits_ = 0, digit_bits_ = 0;
};

}  // namespace

void sort_contacts(std::vector<FoundContact>& found, std::vector<FoundContact>& scratch) {
  if (found.size() < few) {
    std::sort(found.begin(), found.end(), precedes);
    return;
  }
  const DigitSort by_a(found);
  scratch.resize(found.size());
  for (int digit = 0; digit < by_a.digits(); ++digit) {
    by_a.sort_by(digit, found, scratch);
    found.swap(scratch);
  }
  FoundContact* const end = found.data() + found.size();
  for (FoundContact *first = found.data(), *last; first != end; first = last) {
    last = first + 1;
    while (last != end && last->triangle_a == first->triangle_a) ++last;
    if (last - first > 1) sort_run(first, last);
  }
}

}  // namespace supple
