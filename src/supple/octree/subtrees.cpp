#include "octree/subtrees.hpp"

#include <algorithm>

namespace supple {
namespace {

/// A subtree on its way, by its triangles.
struct Part {
  std::uint32_t begin, end;
  Subtree subtree;
};

std::vector<Part> split(std::span<const OctreeNode> nodes, std::vector<std::uint32_t>& top_nodes) {
  constexpr std::uint32_t most = Subtrees::triangles_of_subtree, none = Subtree::none;
  std::vector<Part> parts;
  if (nodes.empty()) return parts;
  if (nodes[0].size() <= most) {
    parts.push_back({0, nodes[0].size(), {none, 0, 0, 0, 0}});
    return parts;
  }
  top_nodes.push_back(0);
  for (std::size_t i = 0; i < top_nodes.size(); ++i) {
    const std::uint32_t n = top_nodes[i];
    const OctreeNode& node = nodes[n];
    for (int lane = 0; lane < node.lane_count; ++lane) {
      if (node.is_inner(lane) && node.size(lane) > most) {
        top_nodes.push_back(node.child(lane));
      } else {
        parts.push_back(
            {node.first_triangle[lane],
             node.first_triangle[lane + 1],
             {n, node.is_inner(lane) ? node.child(lane) : none, 0, 0, static_cast<std::uint8_t>(lane)}});
      }
    }
  }
  std::sort(parts.begin(), parts.end(), [](const Part& p, const Part& q) { return p.begin < q.begin; });
  return parts;
}

}  // namespace

Subtrees::Subtrees(std::span<const OctreeNode> nodes, std::span<const Triangle> triangles) {
  std::uint32_t vertex_count = 0;
  for (const Part& part : split(nodes, top_nodes_)) {
    const std::uint32_t first_vertex = vertex_count;
    const std::size_t first_shared = shared_vertices_.size();
    for (std::uint32_t t = part.begin; t < part.end; ++t) {
      for (const std::uint32_t vertex : triangles[t]) {
        vertex_count = std::max(vertex_count, vertex + 1);
        if (vertex < first_vertex) shared_vertices_.push_back(vertex);
      }
    }
    const auto shared = shared_vertices_.begin() + static_cast<std::ptrdiff_t>(first_shared);
    std::sort(shared, shared_vertices_.end());
    shared_vertices_.erase(std::unique(shared, shared_vertices_.end()), shared_vertices_.end());

    const std::uint32_t root = part.subtree.root;
    if (root != Subtree::none) {
      of_root_.resize(std::max<std::size_t>(of_root_.size(), root + std::size_t{1}), Subtree::none);
      of_root_[root] = static_cast<std::uint32_t>(subtrees_.size());
    }
    subtrees_.push_back(part.subtree);
    subtrees_.back().first_vertex = first_vertex;
    subtrees_.back().first_shared = static_cast<std::uint32_t>(first_shared);
  }
  subtrees_.push_back(
      {Subtree::none, Subtree::none, vertex_count, static_cast<std::uint32_t>(shared_vertices_.size()), 0});
  subtrees_.shrink_to_fit();
  shared_vertices_.shrink_to_fit();
  top_nodes_.shrink_to_fit();
  of_root_.shrink_to_fit();
}

std::size_t Subtrees::bytes() const {
  return subtrees_.capacity() * sizeof(Subtree) +
         (shared_vertices_.capacity() + top_nodes_.capacity() + of_root_.capacity()) * sizeof(std::uint32_t);
}

}  // namespace supple
