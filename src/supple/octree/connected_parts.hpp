#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "supple/mesh.hpp"

namespace supple {

/// Which triangles hang together, by vertices that they share.
struct ConnectedParts {
  std::vector<std::uint32_t> triangles;  ///< part by part, ascending within each
  std::vector<std::uint32_t> first;      ///< of each part in `triangles`, then their number

  std::size_t count() const { return first.size() - 1; }
  std::uint32_t size(std::uint32_t part) const { return first[part + 1] - first[part]; }
  std::span<const std::uint32_t> of(std::uint32_t part) const {
    return std::span(triangles).subspan(first[part], size(part));
  }
};

/// Parts come by their first triangles. O(vertices), and O(triangles) nearly.
ConnectedParts connected_parts(std::span<const Triangle> triangles, std::size_t vertex_count);

}  // namespace supple
