#pragma once

#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "supple/triangle_intersection.hpp"
#include "support/random.hpp"

namespace supple::testing {

struct TrianglePair3d {
  TrianglePoints a, b;
};

/// A way to draw pairs that stresses one kind of trouble.
struct PairFamily {
  std::string name;
  TrianglePair3d (*draw)(RandomNumbers&);
};
/// Found by GoogleTest, and so in the names of ctest.
inline void PrintTo(const PairFamily& family, std::ostream* out) {
  *out << family.name;
}

/// All of them; the same on every machine.
const std::vector<PairFamily>& pair_families();

std::string describe(const TrianglePair3d& pair);

/// Debug and sanitizer builds are some twenty times slower.
inline int scaled_count(int count_in_debug) {
#ifdef NDEBUG
  return count_in_debug * 10;
#else
  return count_in_debug;
#endif
}

}  // namespace supple::testing
