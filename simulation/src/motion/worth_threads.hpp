#pragma once

#include <cstddef>

#include "supple/motion.hpp"

namespace supple {

/// For smaller bodies an explicit step takes less than a millisecond and an implicit step a few
/// milliseconds. A caller with many small bodies runs them in parallel instead.
inline bool is_worth_threads(std::size_t vertex_count, Integrator integrator) {
  return vertex_count > (integrator == Integrator::backward_euler ? 2000 : 10000);
}

}  // namespace supple
