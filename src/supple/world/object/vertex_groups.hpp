#pragma once

#include <algorithm>
#include <cstdint>
#include <span>

namespace supple {

/// The groups and masks of an object's vertices, by the user's ids; empty when all bits are set.
struct VertexGroups {
  std::span<const std::uint32_t> groups, masks;

  bool empty() const { return groups.empty(); }
  std::uint32_t group(std::uint32_t vertex) const { return empty() ? ~std::uint32_t{0} : groups[vertex]; }
  std::uint32_t mask(std::uint32_t vertex) const { return empty() ? ~std::uint32_t{0} : masks[vertex]; }
};

/// Whether a vertex of one element may touch a vertex of the other.
inline bool may_touch_by_groups(const VertexGroups& a, std::span<const std::uint32_t> vertices_a,
                                const VertexGroups& b, std::span<const std::uint32_t> vertices_b) {
  return std::any_of(vertices_a.begin(), vertices_a.end(), [&](std::uint32_t v) {
    return std::any_of(vertices_b.begin(), vertices_b.end(), [&](std::uint32_t w) {
      return (a.group(v) & b.mask(w)) != 0 && (b.group(w) & a.mask(v)) != 0;
    });
  });
}

}  // namespace supple
