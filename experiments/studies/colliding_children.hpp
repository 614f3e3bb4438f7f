#pragma once

#include <cstdint>

#include "supple/inspection.hpp"

namespace supple::experiments {

/// The children of nodes that overlap some child of the other node, over the colliding pairs of nodes of a
/// descent. A pair counts once for each side that has children.
struct CollidingChildren {
  std::uint64_t nodes = 0;     ///< counted
  std::uint64_t children = 0;  ///< sum over these
  std::uint64_t above = 0;     ///< nodes with more than half of the arity
  std::uint32_t most = 0;      ///< of one node

  CollidingChildren& operator+=(const CollidingChildren& other);
};

/// Counts the colliding children in the descent into two octrees of this arity.
CollidingChildren colliding_children(const NodePairList& list, std::uint32_t arity);

}  // namespace supple::experiments
