#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "octree/octree_node.hpp"
#include "supple/mesh.hpp"

namespace supple {

/// Part of an octree whose nodes are refitted together, when a query asks for them: the lane of a top node,
/// or the whole octree. Vertices being numbered by first use, those that its triangles use first are a range;
/// the others are listed, some along its border.
struct Subtree {
  std::uint32_t parent;        ///< node, or `none` of the whole octree
  std::uint32_t root;          ///< node, or `none` of a leaf
  std::uint32_t first_vertex;  ///< up to that of the next subtree
  std::uint32_t first_shared;  ///< in `shared_vertices`, likewise
  std::uint8_t lane;           ///< of the parent
  static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();
};

/// The nodes of an octree as few top nodes and subtrees of at most `triangles_of_subtree` triangles, larger
/// when they are leaves. Memory: about 1 byte a triangle.
class Subtrees {
 public:
  static constexpr std::uint32_t triangles_of_subtree = 256;

  Subtrees() = default;
  /// `triangles` in octree order, vertices numbered by first use.
  Subtrees(std::span<const OctreeNode> nodes, std::span<const Triangle> triangles);

  std::size_t size() const { return subtrees_.empty() ? 0 : subtrees_.size() - 1; }
  const Subtree& operator[](std::size_t i) const { return subtrees_[i]; }
  /// Vertices that a subtree uses and another one before it too.
  std::span<const std::uint32_t> shared_vertices(std::size_t i) const {
    return std::span<const std::uint32_t>(shared_vertices_)
        .subspan(subtrees_[i].first_shared, subtrees_[i + 1].first_shared - subtrees_[i].first_shared);
  }
  std::uint32_t vertex_begin(std::size_t i) const { return subtrees_[i].first_vertex; }
  std::uint32_t vertex_end(std::size_t i) const { return subtrees_[i + 1].first_vertex; }
  /// Nodes above the subtrees, each before its children.
  std::span<const std::uint32_t> top_nodes() const { return top_nodes_; }
  /// The subtree of which the node is the root, or `Subtree::none`.
  std::uint32_t of_root(std::uint32_t node) const {
    return node < of_root_.size() ? of_root_[node] : Subtree::none;
  }
  std::size_t bytes() const;

 private:
  std::vector<Subtree> subtrees_;  // in the order of their triangles, and one past the last
  std::vector<std::uint32_t> shared_vertices_, top_nodes_, of_root_;
};

}  // namespace supple
