#pragma once

#include <cstdint>
#include <vector>

#include "supple/contact.hpp"

namespace supple {

/// A contact on its way into the result; of which two objects is known elsewhere.
struct FoundContact {
  std::uint32_t triangle_a = 0, triangle_b = 0;
  std::uint32_t first_point = 0;  ///< of those of the worker that found it
  std::uint16_t worker = 0;
  IntersectionKind kind = IntersectionKind::segment;
  std::uint8_t point_count = 0;

  constexpr bool operator==(const FoundContact&) const = default;
};
static_assert(sizeof(FoundContact) == 16);

/// Puts the contacts of a job, all of different triangles, into the order of the result: by triangle a, then
/// by triangle b. O(n) while no triangle has very many contacts, O(n log n) at worst. `scratch` is any
/// vector, kept for its memory.
void sort_contacts(std::vector<FoundContact>& found, std::vector<FoundContact>& scratch);

}  // namespace supple
