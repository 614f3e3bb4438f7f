// Two solids of convex pieces: the properties of the depths and normals of their curves, by rationals.

#include <string>

#include "support/byte_reader.hpp"
#include "support/check.hpp"
#include "support/depth_properties.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace supple;
  fuzz::ByteReader bytes(data, size);
  const solids::SolidPair pair = solids::random_pair(bytes);
  const std::string fault = solids::PairChecker(pair).fault();
  fuzz::check(fault.empty() || solids::is_of_directions(fault),
              pair.a.kind + " and " + pair.b.kind + ": " + fault);
  return 0;
}
