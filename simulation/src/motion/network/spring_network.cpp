#include "motion/network/spring_network.hpp"

#include <algorithm>
#include <cmath>

#include "geometry/vector.hpp"
#include "motion/network/mesh_pieces.hpp"

namespace supple {
namespace {

using Ends = std::array<std::uint32_t, 2>;

struct Side {
  Ends ends;
  std::uint32_t triangle, opposite;

  auto operator<=>(const Side&) const = default;
};

/// The sides of all triangles with three different vertices, sorted by ends; equal sides keep the order of
/// their triangles.
std::vector<Side> sorted_sides(std::span<const Triangle> triangles) {
  std::vector<Side> sides;
  sides.reserve(3 * triangles.size());
  for (std::uint32_t i = 0; i < triangles.size(); ++i) {
    const Triangle& t = triangles[i];
    for (int corner = 0; corner < 3; ++corner) {
      const std::uint32_t p = t[corner], q = t[(corner + 1) % 3], r = t[(corner + 2) % 3];
      if (p != q) sides.push_back({{std::min(p, q), std::max(p, q)}, i, r});
    }
  }
  std::sort(sides.begin(), sides.end());
  return sides;
}

std::vector<Ends> distinct_edges(std::span<const Side> sides) {
  std::vector<Ends> edges;
  for (const Side& side : sides) {
    if (edges.empty() || edges.back() != side.ends) edges.push_back(side.ends);
  }
  return edges;
}

std::vector<Ends> pairs_across_edges(std::span<const Side> sides, std::span<const Ends> edges) {
  std::vector<Ends> pairs;
  for (std::size_t i = 1; i < sides.size(); ++i) {
    const std::uint32_t p = sides[i - 1].opposite, q = sides[i].opposite;
    if (sides[i].ends != sides[i - 1].ends || p == q) continue;
    // For a triangle with a repeated id, the opposite vertex is one of the side's own ends.
    const auto is_end = [&](std::uint32_t v) { return v == sides[i].ends[0] || v == sides[i].ends[1]; };
    if (!is_end(p) && !is_end(q)) pairs.push_back({std::min(p, q), std::max(p, q)});
  }
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  std::erase_if(pairs,
                [&](const Ends& pair) { return std::binary_search(edges.begin(), edges.end(), pair); });
  return pairs;
}

std::vector<SpringElement> springs_between(std::span<const Ends> pairs, std::span<const Vec3d> positions,
                                           double length_factor) {
  std::vector<SpringElement> springs;
  springs.reserve(pairs.size());
  for (const auto& [a, b] : pairs) {
    const double rest_length = length_factor * norm(positions[b] - positions[a]);
    if (std::isfinite(rest_length)) springs.push_back({a, b, rest_length});
  }
  return springs;
}

std::vector<AreaElement> areas_of(const TriangleMesh& mesh, double length_factor) {
  std::vector<AreaElement> areas;
  const auto& p = mesh.positions;
  for (const Triangle& t : mesh.triangles) {
    const double area = triangle_area(p[t[0]], p[t[1]], p[t[2]]);
    double longest_squared = 0;
    for (int corner = 0; corner < 3; ++corner) {
      const Vec3d side = p[t[(corner + 1) % 3]] - p[t[corner]];
      longest_squared = std::max(longest_squared, dot(side, side));
    }
    const double inverse_scale = 4 / (std::sqrt(3.0) * longest_squared);
    const double rest_area = length_factor * length_factor * area;
    if (area > 0 && std::isfinite(longest_squared) && std::isfinite(inverse_scale) &&
        std::isfinite(rest_area)) {
      areas.push_back({t, rest_area, inverse_scale});
    }
  }
  return areas;
}

template <class Element>
bool crosses(const Element& element) {
  const auto vertices = element.vertices();
  return std::any_of(vertices.begin(), vertices.end(), [&](std::uint32_t v) {
    return v / vertex_block_size != vertices[0] / vertex_block_size;
  });
}

template <class Element>
ElementBlocks<Element> in_blocks(const std::vector<Element>& elements, std::uint32_t block_count) {
  // Two groups per block; elements keep their order within a group.
  const auto group_of = [](const Element& e) {
    return 2 * std::size_t{e.vertices()[0] / vertex_block_size} + (crosses(e) ? 1 : 0);
  };
  std::vector<std::uint32_t> first(2 * std::size_t{block_count} + 1);
  for (const Element& e : elements) ++first[group_of(e) + 1];
  for (std::size_t group = 1; group < first.size(); ++group) first[group] += first[group - 1];

  ElementBlocks<Element> blocks;
  std::uint32_t slots = 0;
  for (std::uint32_t block = 0; block < block_count; ++block) {
    blocks.first.push_back(first[2 * block]);
    blocks.first_crossing.push_back(first[2 * block + 1]);
    blocks.first_slot.push_back(slots);
    slots += (first[2 * block + 2] - first[2 * block + 1]) *
             static_cast<std::uint32_t>(Element{}.vertices().size());
  }
  blocks.first.push_back(first.back());
  blocks.slots.resize(slots);
  blocks.elements.resize(elements.size());
  for (const Element& e : elements) blocks.elements[first[group_of(e)]++] = e;
  return blocks;
}

/// Calls `visit(vertex, slot)` for each vertex of each crossing element, in order.
template <class Element, class Visit>
void for_each_slot(ElementBlocks<Element>& blocks, Visit visit) {
  std::size_t slot = 0;
  for (std::size_t block = 0; block < blocks.first_crossing.size(); ++block) {
    for (std::uint32_t i = blocks.first_crossing[block]; i < blocks.first[block + 1]; ++i) {
      for (const std::uint32_t vertex : blocks.elements[i].vertices()) visit(vertex, blocks.slots[slot++]);
    }
  }
}

std::vector<VolumeRun> runs_of(const ElementBlocks<VolumeElement>& volumes) {
  std::vector<VolumeRun> runs;
  for (std::size_t block = 0; block + 1 < volumes.first.size(); ++block) {
    for (std::uint32_t i = volumes.first[block]; i < volumes.first[block + 1]; ++i) {
      const std::uint32_t part = volumes.elements[i].part;
      if (i == volumes.first[block] || runs.back().part != part) runs.push_back({i, i, part});
      ++runs.back().last;
    }
  }
  return runs;
}

void number_slots(SpringNetwork& network) {
  const auto for_all = [&](auto visit) {
    for_each_slot(network.edges, visit);
    for_each_slot(network.bending, visit);
    for_each_slot(network.areas, visit);
    for_each_slot(network.volumes, visit);
  };
  network.first_slot.assign(std::size_t{network.vertex_count} + 1, 0);
  for_all([&](std::uint32_t vertex, std::uint32_t&) { ++network.first_slot[vertex + 1]; });
  for (std::uint32_t v = 0; v < network.vertex_count; ++v) network.first_slot[v + 1] += network.first_slot[v];
  std::vector<std::uint32_t> next(network.first_slot.begin(), network.first_slot.end() - 1);
  for_all([&](std::uint32_t vertex, std::uint32_t& slot) { slot = next[vertex]++; });
}

}  // namespace

SpringNetwork build_spring_network(const TriangleMesh& mesh, const MassSpringOptions& options,
                                   const ClosedParts& closed) {
  SpringNetwork network;
  network.vertex_count = static_cast<std::uint32_t>(mesh.positions.size());
  const std::uint32_t block_count = network.block_count();
  const std::vector<Side> sides = sorted_sides(mesh.triangles);
  std::vector<Ends> edges = distinct_edges(sides);
  std::vector<Ends> across;
  if (options.bending_stiffness > 0) across = pairs_across_edges(sides, edges);
  if (options.connect_pieces) {
    const std::vector<Ends> connections = connections_of_pieces(mesh);
    edges.insert(edges.end(), connections.begin(), connections.end());
    std::sort(edges.begin(), edges.end());
  }
  network.edges = in_blocks(springs_between(edges, mesh.positions, options.rest_length), block_count);
  network.bending = in_blocks(springs_between(across, mesh.positions, options.rest_length), block_count);
  std::vector<AreaElement> areas;
  if (options.area_stiffness > 0) areas = areas_of(mesh, options.rest_length);
  network.areas = in_blocks(areas, block_count);
  network.volumes = in_blocks(closed.elements, block_count);
  network.parts = closed.parts;
  network.runs = runs_of(network.volumes);
  number_slots(network);
  return network;
}

double triangle_area(Vec3d a, Vec3d b, Vec3d c) {
  return 0.5 * norm(cross(b - a, c - a));
}

}  // namespace supple
