#pragma once

#include <cstdint>

#include "supple/mesh.hpp"

namespace supple {

/// Whether two triangles have a vertex id in common. It has no branches, because they would be hard to
/// predict.
inline bool share_vertex(const Triangle& p, const Triangle& q) {
  bool shared = false;
  for (const std::uint32_t vertex : p) {
    for (const std::uint32_t other : q) shared |= vertex == other;
  }
  return shared;
}

}  // namespace supple
