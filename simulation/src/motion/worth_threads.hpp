#pragma once

#include <cstddef>

#include "supple/motion.hpp"

namespace supple {

/// Of smaller bodies an explicit step takes less than a millisecond, an implicit one a few. Whoever steps
/// many of them has threads of his own.
inline bool is_worth_threads(std::size_t vertex_count, Integrator integrator) {
  return vertex_count > (integrator == Integrator::backward_euler ? 2000 : 10000);
}

}  // namespace supple
