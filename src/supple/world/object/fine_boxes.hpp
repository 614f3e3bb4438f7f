#pragma once

#include <cstdint>
#include <vector>

#include "narrow_phase/traversal.hpp"
#include "octree/vertex_buffer.hpp"
#include "supple/queries.hpp"

namespace supple {

/// The boxes of an octree in double: for objects that are so far from their origin that the boxes in single
/// precision, which round outward, are larger than their triangles.
class FineBoxes {
 public:
  /// Whether queries need them.
  static bool are_needed(const OctreeView& view);

  /// O(n), once for each version of the positions, which is not 0.
  void update(const OctreeView& view, const VertexBuffer& positions, std::uint64_t version);
  /// Eight for each node, without the translation; those without a finite triangle are inverted. Null for
  /// another version.
  const QueryBox* of_version(std::uint64_t version) const {
    return version_ == version ? boxes_.data() : nullptr;
  }

 private:
  std::vector<QueryBox> boxes_;
  std::uint64_t version_ = 0;
};

}  // namespace supple
