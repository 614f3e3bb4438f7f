#include "octree/surface_elements.hpp"
#include "octree/object_octree.hpp"

#include <algorithm>
#include <limits>
#include <tuple>

#include "core/bucket_sort.hpp"

namespace supple {
namespace {

/// A side of a triangle. Each triangle has three, in octree order.
struct Side {
  Edge edge;
  std::uint32_t place;
};

std::vector<Side> sorted_sides(std::span<const Triangle> triangles) {
  std::vector<Side> sides;
  BucketSort().sort(
      [&](const auto& visit) {
        for (std::uint32_t t = 0; t < triangles.size(); ++t) {
          for (std::uint32_t corner = 0; corner < 3; ++corner) {
            const auto [p, q] = std::minmax(triangles[t][corner], triangles[t][(corner + 1) % 3]);
            visit(Side{{p, q}, 3 * t + corner});
          }
        }
      },
      [](const Side& side) {
        return SortKey{0, side.edge[0]};
      },
      [](const Side& p, const Side& q) { return std::tie(p.edge, p.place) < std::tie(q.edge, q.place); },
      Parallel(1), sides);
  return sides;
}

}  // namespace

void SurfaceElements::number_by_first_use(const ObjectOctree& octree) {
  constexpr std::uint32_t without_number = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> numbers(octree.vertex_count(), without_number);
  vertex_ids_.reserve(octree.vertex_count());
  const auto number = [&](std::uint32_t vertex) {
    if (numbers[vertex] == without_number) {
      numbers[vertex] = static_cast<std::uint32_t>(vertex_ids_.size());
      vertex_ids_.push_back(vertex);
    }
    return numbers[vertex];
  };
  faces_.assign(octree.triangles().begin(), octree.triangles().end());
  for (Triangle& face : faces_) {
    for (std::uint32_t& vertex : face) vertex = number(vertex);
  }
  for (std::uint32_t vertex = 0; vertex < octree.vertex_count(); ++vertex) number(vertex);
}

SurfaceElements::SurfaceElements(const ObjectOctree& octree) {
  number_by_first_use(octree);
  const std::span<const Triangle> triangles = faces_;
  first_vertex_.reserve(triangles.size() + 1);
  for (const Triangle& triangle : triangles) {
    first_vertex_.push_back(
        std::max({first_vertex_.back(), triangle[0] + 1, triangle[1] + 1, triangle[2] + 1}));
  }
  const std::vector<Side> sides = sorted_sides(triangles);
  std::vector<std::uint8_t> is_first(sides.size(), 0);
  std::uint32_t count = 0;
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const Edge& edge = sides[i].edge;
    if (edge[0] == edge[1] || (i > 0 && sides[i - 1].edge == edge)) continue;
    is_first[sides[i].place] = 1;
    ++count;
  }
  edges_.reserve(count);
  first_edge_.reserve(triangles.size() + 1);
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    for (std::uint32_t corner = 0; corner < 3; ++corner) {
      if (is_first[3 * t + corner] == 0) continue;
      const auto [p, q] = std::minmax(triangles[t][corner], triangles[t][(corner + 1) % 3]);
      edges_.push_back({p, q});
    }
    first_edge_.push_back(static_cast<std::uint32_t>(edges_.size()));
  }
}

}  // namespace supple
