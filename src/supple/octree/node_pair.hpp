#pragma once

#include <cstdint>

#include "supple/types.hpp"

namespace supple {

/// Two nodes to test: the children of a in `children_a` against the children of b in `children_b`.
struct NodePair {
  std::uint32_t a = 0, b = 0;
  std::uint8_t children_a = 0xff, children_b = 0xff;
};

/// The translation of object b relative to object a. The volumes of b move by `offset` and grow by `slop`,
/// which covers all rounding errors. Zero for objects that are not translated.
struct RelativePlacement {
  Vec3f offset;
  float slop = 0;

  bool is_identity() const { return offset == Vec3f{} && slop == 0; }
};
/// The box of an object b, moved and grown.
inline Aabb placed(Aabb box, const RelativePlacement& placement) {
  for (int axis = 0; axis < 3; ++axis) {
    box.min[axis] += placement.offset[axis] - placement.slop;
    box.max[axis] += placement.offset[axis] + placement.slop;
  }
  return box;
}

}  // namespace supple
