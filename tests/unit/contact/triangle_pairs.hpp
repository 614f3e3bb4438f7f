#pragma once

#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "supple/triangle_intersection.hpp"
#include "support/random.hpp"

namespace supple::truth {

struct TrianglePair3d {
  TrianglePoints a, b;
};

/// Draws random pairs that stress one kind of difficulty.
struct PairFamily {
  std::string name;
  TrianglePair3d (*draw)(RandomNumbers&);
};
/// GoogleTest calls this function; ctest shows the name.
inline void PrintTo(const PairFamily& family, std::ostream* out) {
  *out << family.name;
}

/// All families, the same on every machine.
const std::vector<PairFamily>& pair_families();

std::string describe(const TrianglePair3d& pair);

/// The count is reduced because debug and sanitizer builds are about twenty times slower.
inline int scaled_count(int count_in_debug) {
#ifdef NDEBUG
  return count_in_debug * 10;
#else
  return count_in_debug;
#endif
}

}  // namespace supple::truth
