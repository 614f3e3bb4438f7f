#pragma once

#include <cstdint>
#include <string>

#include "supple/mesh.hpp"

namespace supple {

/// Adds the polygon with the given number in its file as a fan of triangles around its first corner.
/// `next_index()` reads a corner. Fails through `source.fail_here` when there are fewer than 3 corners, or an
/// index is not below `vertices`.
template <class Source, class NextIndex>
void add_polygon(TriangleMesh& mesh, std::uint64_t vertices, std::uint64_t number, std::int64_t corners,
                 const Source& source, NextIndex&& next_index) {
  const auto fail = [&](const std::string& message) {
    source.fail_here("face " + std::to_string(number) + message);
  };
  const auto next_corner = [&] {
    const std::int64_t index = next_index();
    if (index < 0 || static_cast<std::uint64_t>(index) >= vertices) {
      fail(": vertex index " + std::to_string(index) + " is out of range; the file has " +
           std::to_string(vertices) + " vertices, counted from 0");
    }
    return static_cast<std::uint32_t>(index);
  };
  if (corners < 3) fail(" has " + std::to_string(corners) + " corners; it needs at least 3");
  const std::uint32_t first = next_corner();
  std::uint32_t previous = next_corner();
  for (std::int64_t k = 2; k < corners; ++k) {
    const std::uint32_t corner = next_corner();
    mesh.triangles.push_back({first, previous, corner});
    previous = corner;
  }
}

}  // namespace supple
