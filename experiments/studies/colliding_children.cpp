#include "studies/shape_pair.hpp"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

namespace supple::experiments {
namespace {

/// Level and number of a node; unique in an octree.
using Name = std::pair<std::uint32_t, std::uint64_t>;

/// A child that collides, and the two nodes that collide above.
struct Collision {
  Name parent, other;
  std::uint64_t child;
  constexpr auto operator<=>(const Collision&) const = default;
};

/// The node from which a cell of a level of the list came: the node above or, for a leaf that waits while the
/// other side descends, the leaf itself.
Name origin_of(const OctreeCell& cell, std::uint32_t level, std::uint32_t arity) {
  if (cell.level < level) return {cell.level, *cell.number};
  return {level - 1, (*cell.number - 1) / arity};
}

}  // namespace

CollidingChildren& CollidingChildren::operator+=(const CollidingChildren& other) {
  nodes += other.nodes;
  children += other.children;
  above += other.above;
  most = std::max(most, other.most);
  return *this;
}

CollidingChildren colliding_children(const NodePairList& list, std::uint32_t arity) {
  CollidingChildren sum;
  for (std::uint32_t level = 1; level < list.level_count(); ++level) {
    std::array<std::vector<Collision>, 2> sides;
    for (const NodePairList::Pair& pair : list.pairs_of(level)) {
      const OctreeCell &a = list.nodes_a[pair.a], &b = list.nodes_b[pair.b];
      if (!a.number || !b.number) continue;  // too deep for a number
      const Name from_a = origin_of(a, level, arity), from_b = origin_of(b, level, arity);
      if (a.level == level) sides[0].push_back({from_a, from_b, *a.number});
      if (b.level == level) sides[1].push_back({from_b, from_a, *b.number});
    }
    for (auto& side : sides) {
      std::sort(side.begin(), side.end());
      side.erase(std::unique(side.begin(), side.end()), side.end());
      for (auto begin = side.begin(), end = begin; begin != side.end(); begin = end) {
        end = std::find_if(begin, side.end(), [&](const Collision& c) {
          return c.parent != begin->parent || c.other != begin->other;
        });
        const auto count = static_cast<std::uint32_t>(end - begin);
        sum += {1, count, count > arity / 2 ? 1u : 0u, count};
      }
    }
  }
  return sum;
}

}  // namespace supple::experiments
