#pragma once

#include <cstdint>

namespace supple {

enum class VertexKind : std::uint8_t {
  free,
  fixed,  ///< infinite mass: it keeps its velocity
  inert,  ///< not finite at rest: it has no velocity, no mass and no springs
};

}  // namespace supple
