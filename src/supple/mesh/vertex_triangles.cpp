#include "mesh/vertex_triangles.hpp"

#include <algorithm>
#include <utility>

#include "mesh/vertex_sets.hpp"
#include "supple/topology.hpp"

namespace supple {
namespace {

/// Calls `visit` with the different corners of the triangle.
template <class Visit>
void for_each_corner(const Triangle& triangle, const Visit& visit) {
  for (std::size_t i = 0; i < 3; ++i) {
    if (std::find(triangle.begin(), triangle.begin() + static_cast<std::ptrdiff_t>(i), triangle[i]) ==
        triangle.begin() + static_cast<std::ptrdiff_t>(i))
      visit(triangle[i]);
  }
}

}  // namespace

VertexTriangles::VertexTriangles(std::span<const Triangle> triangles, std::span<const std::uint8_t> inert,
                                 std::size_t vertex_count)
    : first_(vertex_count + 1, 0), part_(vertex_count, no_part) {
  const auto is_inert = [&](std::size_t t) { return !inert.empty() && inert[t] != 0; };
  VertexSets sets(vertex_count);
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    if (is_inert(t)) continue;
    for_each_corner(triangles[t], [&](std::uint32_t vertex) { ++first_[vertex + 1]; });
    sets.join(triangles[t][0], triangles[t][1]);
    sets.join(triangles[t][0], triangles[t][2]);
  }
  for (std::size_t v = 0; v < vertex_count; ++v) first_[v + 1] += first_[v];
  triangles_.resize(first_.back());
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    if (is_inert(t)) continue;
    for_each_corner(triangles[t], [&](std::uint32_t vertex) {
      triangles_[next[vertex]++] = static_cast<std::uint32_t>(t);
    });
  }
  for (std::uint32_t v = 0; v < vertex_count; ++v) {
    if (around(v).empty()) continue;
    const std::uint32_t root = sets.root(v);  // the smallest vertex of the part
    if (root == v) {
      part_[v] = static_cast<std::uint32_t>(parts_.size());
      parts_.push_back({v, 0});
    }
    part_[v] = part_[root];
    ++parts_[part_[v]].vertex_count;
  }
}

std::string fault_of_solid(const TriangleMesh& mesh) {
  struct Use {
    std::uint32_t first, last;
    int direction;
  };
  std::vector<Use> uses;
  uses.reserve(3 * mesh.triangles.size());
  for (const Triangle& triangle : mesh.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t from = triangle[i], to = triangle[(i + 1) % 3];
      if (from != to) uses.push_back({std::min(from, to), std::max(from, to), from < to ? 1 : -1});
    }
  }
  std::sort(uses.begin(), uses.end(), [](const Use& p, const Use& q) {
    return std::pair(p.first, p.last) < std::pair(q.first, q.last);
  });
  constexpr std::size_t most_named = 3;
  std::size_t open = 0, turned = 0;
  std::string open_edges, turned_edges;
  const auto name = [](const Use& use, std::size_t number, std::string& names) {
    if (number > most_named) return;
    if (!names.empty()) names += ", ";
    names += std::to_string(use.first) + "-" + std::to_string(use.last);
  };
  for (std::size_t begin = 0, end = 0; begin < uses.size(); begin = end) {
    int sum = 0;
    for (; end < uses.size() && uses[end].first == uses[begin].first && uses[end].last == uses[begin].last;
         ++end)
      sum += uses[end].direction;
    if (sum == 0) continue;
    if ((end - begin) % 2 != 0)
      name(uses[begin], ++open, open_edges);
    else
      name(uses[begin], ++turned, turned_edges);
  }
  const auto edges = [](std::size_t count) {
    return std::to_string(count) + (count == 1 ? " edge" : " edges");
  };
  const auto more = [](std::size_t count) { return count > most_named ? ", ..." : ""; };
  if (open > 0)
    return "the surface is open at " + edges(open) + " (vertices " + open_edges + more(open) + "); " +
           advice_for_open_surface(mesh);
  if (turned > 0)
    return "neighbouring triangles turn against each other at " + edges(turned) + " (vertices " +
           turned_edges + more(turned) + "); orient all triangles alike";
  return "";
}

}  // namespace supple
