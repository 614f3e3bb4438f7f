#include "octree/connected_parts.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

#include "mesh/vertex_sets.hpp"

namespace supple {

ConnectedParts connected_parts(std::span<const Triangle> triangles, std::size_t vertex_count) {
  VertexSets sets(vertex_count);
  for (const Triangle& triangle : triangles) {
    sets.join(triangle[0], triangle[1]);
    sets.join(triangle[1], triangle[2]);
  }
  // Most objects hang together.
  const bool is_one = std::all_of(triangles.begin(), triangles.end(), [&](const Triangle& triangle) {
    return sets.root(triangle[0]) == sets.root(triangles[0][0]);
  });
  if (is_one && !triangles.empty()) {
    ConnectedParts whole{{}, {0, static_cast<std::uint32_t>(triangles.size())}};
    whole.triangles.resize(triangles.size());
    std::iota(whole.triangles.begin(), whole.triangles.end(), 0u);
    return whole;
  }
  constexpr std::uint32_t unknown = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> part_of_root(vertex_count, unknown), part_of_triangle;
  part_of_triangle.reserve(triangles.size());
  ConnectedParts parts;
  parts.first.push_back(0);
  for (const Triangle& triangle : triangles) {
    std::uint32_t& part = part_of_root[sets.root(triangle[0])];
    if (part == unknown) {
      part = static_cast<std::uint32_t>(parts.count());
      parts.first.push_back(0);
    }
    part_of_triangle.push_back(part);
    ++parts.first[part + 1];
  }
  for (std::size_t part = 0; part < parts.count(); ++part) parts.first[part + 1] += parts.first[part];
  std::vector<std::uint32_t> next(parts.first.begin(), parts.first.end() - 1);
  parts.triangles.resize(triangles.size());
  for (std::uint32_t t = 0; t < triangles.size(); ++t) parts.triangles[next[part_of_triangle[t]]++] = t;
  return parts;
}

}  // namespace supple
